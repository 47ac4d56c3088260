//! `hertzchain fit`: times of flight to parameters.

mod more;
mod pictures;
mod report;
mod results;
mod uncertainty;

use crate::arguments::infer::Fit as Arguments;
use crate::failure::Failure;
use crate::folder::Folder;
use crate::inference::{self, user};
use crate::print;
use hertzchain_infer::{
    Covariance, CurveProblem, Fit, FittedCurve, Fitting, Goodness, Identifiability, Loss, Problem,
    Speeds, fit,
};
use more::{More, Rivals};

/// Residuals beyond so many standard errors count by their size when outliers are expected.
const OUTLIER: f64 = 1.345;

/// Everything about a fit.
pub struct Fitted {
    /// What was fitted.
    pub problem: CurveProblem,
    /// The best fit.
    pub fit: Fit,
    /// Its covariance.
    pub covariance: Covariance,
    /// How well it describes the data.
    pub goodness: Goodness,
    /// The model at the best fit.
    pub curve: FittedCurve,
    /// Largest relative error of the model's times of flight there.
    pub accuracy: f64,
    /// What the data determine.
    pub identifiability: Identifiability,
    /// Uncertainty beyond the covariance.
    pub more: More,
    /// Other models of the same data.
    pub rivals: Option<Rivals>,
}

/// Runs the verb.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let data = inference::data(&arguments.data, &arguments.measured)?;
    let experiment = inference::experiment(&arguments.modelled, Some(&data.case))?;
    let model = inference::model(&experiment, &arguments.modelled, &arguments.freed)?;
    let problem = inference::problem(model, data, &arguments.freed)?;
    let folder = arguments.out.as_deref().map(Folder::open).transpose()?;
    let pool = inference::pool(arguments.modelled.threads)?;
    let fitted = pool.install(|| fitted(problem, arguments))?;
    let all = results::json(&fitted, arguments);
    match arguments.json {
        true => print::print_json(&all)?,
        false => print::print(&report::text(&fitted))?,
    }
    folder.map_or(Ok(()), |folder| write(folder, &fitted, &all))
}

fn fitted(problem: CurveProblem, arguments: &Arguments) -> Result<Fitted, Failure> {
    let how = Fitting {
        loss: match arguments.robust {
            true => Loss::Huber { scale: OUTLIER },
            false => Loss::Squares,
        },
        starts: arguments.starts,
        seed: arguments.seed,
        ..Fitting::default()
    };
    let fit = fit(&problem, &how).map_err(user)?;
    let covariance = Covariance::new(problem.parameters(), &fit);
    let goodness = Goodness::new(problem.parameters(), &fit);
    let speeds = Speeds::of_rows(&problem.data().speeds_m_s());
    let accuracy = problem.model().accuracy_reached(&fit.point, &speeds);
    let label = |at: usize| problem.residual_label(at);
    Ok(Fitted {
        identifiability: Identifiability::new(problem.parameters(), &fit, label),
        more: more::more(&problem, &fit, &covariance, arguments)?,
        rivals: more::rivals(&problem, &fit, arguments)?,
        goodness,
        curve: problem.fitted_curve(&fit, &covariance).map_err(user)?,
        accuracy: accuracy.map_err(user)?,
        covariance,
        fit,
        problem,
    })
}

fn write(mut folder: Folder, fitted: &Fitted, all: &serde_json::Value) -> Result<(), Failure> {
    folder.write("fit.json", format!("{all:#}\n").as_bytes())?;
    folder.write("fit.csv", results::rows_csv(fitted).as_bytes())?;
    folder.write("parameters.csv", results::parameters_csv(fitted).as_bytes())?;
    folder.figure("fit", &pictures::fit(fitted))?;
    folder.figure("singular-values", &uncertainty::singular_values(fitted))?;
    match &fitted.more {
        More::Nothing => {}
        More::Profiles(profiles) => {
            folder.write(
                "profiles.csv",
                results::profiles_csv(fitted, profiles).as_bytes(),
            )?;
            folder.figure("profiles", &uncertainty::profiles(fitted, profiles))?;
        }
        More::Sampled(sampled) => {
            folder.write(more::CHAIN, &more::saved(&sampled.chain)?)?;
            if let Ok(posterior) = &sampled.posterior {
                folder.figure("corner", &uncertainty::corner(fitted, posterior))?;
            }
        }
    }
    eprint!("Written:\n{}", folder.list());
    Ok(())
}
