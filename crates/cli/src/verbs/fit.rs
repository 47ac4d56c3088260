//! `hertzchain fit`: times of flight to parameters.

mod more;
mod pictures;
mod pulses;
mod report;
mod results;
mod uncertainty;

use crate::arguments::infer::Fit as Arguments;
use crate::failure::Failure;
use crate::folder::Folder;
use crate::inference::{self, user};
use crate::print;
use hertzchain_infer::{
    Covariance, CurveProblem, Fit, FittedCurve, Fitting, Goodness, Identifiability, Loss,
    Parameter, Problem, Speeds, fit,
};
use more::{More, Rivals};

/// Residuals beyond so many standard errors count by their size when outliers are expected.
const OUTLIER: f64 = 1.345;

/// What any fit tells.
pub struct Inferred {
    /// The free parameters.
    pub parameters: Vec<Parameter>,
    /// The best fit.
    pub fit: Fit,
    /// Its covariance.
    pub covariance: Covariance,
    /// How well it describes the data.
    pub goodness: Goodness,
    /// What the data determine.
    pub identifiability: Identifiability,
    /// Uncertainty beyond the covariance.
    pub more: More,
}

/// Everything about a fit of a curve.
pub struct Fitted {
    /// What was fitted.
    pub problem: CurveProblem,
    /// What came of it.
    pub inferred: Inferred,
    /// The model at the best fit.
    pub curve: FittedCurve,
    /// Largest relative error of the model's times of flight there.
    pub accuracy: f64,
    /// Other models of the same data.
    pub rivals: Option<Rivals>,
}

/// Runs the verb.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let table = match &arguments.data[..] {
        [one] if inference::is_table(one)? => one,
        _ => return pulses::run(arguments),
    };
    let data = inference::data(table, &arguments.measured)?;
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

/// The best fit, as asked.
fn best(problem: &dyn Problem, arguments: &Arguments) -> Result<Fit, Failure> {
    let how = Fitting {
        loss: match arguments.robust {
            true => Loss::Huber { scale: OUTLIER },
            false => Loss::Squares,
        },
        starts: arguments.starts,
        seed: arguments.seed,
        ..Fitting::default()
    };
    fit(problem, &how).map_err(user)
}

fn fitted(problem: CurveProblem, arguments: &Arguments) -> Result<Fitted, Failure> {
    let fit = best(&problem, arguments)?;
    let covariance = Covariance::new(problem.parameters(), &fit);
    let speeds = Speeds::of_rows(&problem.data().speeds_m_s());
    let accuracy = problem.model().accuracy_reached(&fit.point, &speeds);
    let label = |at: usize| problem.residual_label(at);
    Ok(Fitted {
        rivals: more::rivals(&problem, &fit, arguments)?,
        curve: problem.fitted_curve(&fit, &covariance).map_err(user)?,
        accuracy: accuracy.map_err(user)?,
        inferred: Inferred {
            parameters: problem.parameters().to_vec(),
            identifiability: Identifiability::new(problem.parameters(), &fit, label),
            goodness: Goodness::new(problem.parameters(), &fit),
            more: more::more(&problem, &fit, &covariance, arguments)?,
            covariance,
            fit,
        },
        problem,
    })
}

fn write(mut folder: Folder, fitted: &Fitted, all: &serde_json::Value) -> Result<(), Failure> {
    folder.write("fit.csv", results::rows_csv(fitted).as_bytes())?;
    folder.figure("fit", &pictures::fit(fitted))?;
    write_inferred(&mut folder, &fitted.inferred, all)?;
    eprint!("Written:\n{}", folder.list());
    Ok(())
}

/// Files that any fit has.
fn write_inferred(
    folder: &mut Folder,
    fitted: &Inferred,
    all: &serde_json::Value,
) -> Result<(), Failure> {
    folder.write("fit.json", format!("{all:#}\n").as_bytes())?;
    folder.write("parameters.csv", results::parameters_csv(fitted).as_bytes())?;
    folder.figure("singular-values", &uncertainty::singular_values(fitted))?;
    match &fitted.more {
        More::Nothing => {}
        More::Profiles(profiles) => {
            let table = results::profiles_csv(fitted, profiles);
            folder.write("profiles.csv", table.as_bytes())?;
            folder.figure("profiles", &uncertainty::profiles(fitted, profiles))?;
        }
        More::Sampled(sampled) => {
            folder.write(more::CHAIN, &more::saved(&sampled.chain)?)?;
            if let Ok(posterior) = &sampled.posterior {
                folder.figure("corner", &uncertainty::corner(fitted, posterior))?;
            }
        }
    }
    Ok(())
}
