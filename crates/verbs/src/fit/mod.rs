//! `fit`: times of flight to parameters.

mod more;
mod results;

pub use more::{CHAIN, More, Rival, Rivals, Sampled};
pub use results::{json, parameters_csv, profiles_csv, rows_csv, rows_json};

use crate::arguments::infer::Fit as Arguments;
use crate::failure::Failure;
use crate::inference::user;
use hertzchain_infer::{
    Covariance, CurveProblem, Fit, FittedCurve, Fitting, Goodness, Identifiability, Loss, Problem,
    Speeds, fit,
};

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

/// Fits a problem, tells the uncertainty as the method asks, and compares with
/// other models.
///
/// # Errors
/// What is in the way of a fit.
pub fn fitted(problem: CurveProblem, arguments: &Arguments) -> Result<Fitted, Failure> {
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
