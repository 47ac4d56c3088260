//! `fit`: times of flight to parameters.

mod heeded;
mod limits;
mod more;
mod partial;
pub mod pulses;
mod results;
mod rivals;
mod tables;
mod words;

pub use limits::{Limit, Limits};
pub use more::{CHAIN, Curves, More, Sampled, leave, saved};
pub use partial::{PARTIAL, begun, finished};
pub use results::{inferred, joined, json, rows_json};
pub use rivals::{Lost, Rival, Rivals};
pub use tables::{Table, of_any as tables_of_any, tables};

use crate::arguments::infer::Fit as Arguments;
use crate::failure::Failure;
use crate::inference::{user, wanted};
use hertzchain_infer::{
    Advice, Covariance, CurveProblem, Fit, FittedCurve, Fitting, Goodness, Identifiability, Loss,
    Parameter, Problem, Speeds, fit,
};
use partial::Remembered;

/// Residuals beyond so many standard errors count by their size when outliers are expected.
const OUTLIER: f64 = 1.345;

/// Share of a normal distribution within one standard error of its mean.
pub(crate) const SHARE_OF_A_STANDARD_ERROR: f64 = 0.682_689_5;

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
    /// Of parameters at bounds.
    pub limits: Limits,
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
    /// What would settle what the data leave open, if they leave anything open.
    pub advice: Option<Advice>,
    /// Other models of the same data.
    pub rivals: Option<Rivals>,
    /// The unit that speeds seem to be in, where the model does not follow and they seem not
    /// to be in m/s.
    pub unit_of_speed: Option<&'static str>,
}

impl Inferred {
    /// Standard error of a parameter by the covariance; infinite where the data leave
    /// the parameter open, however finite a linear analysis may be.
    #[must_use]
    pub fn standard_error(&self, at: usize) -> f64 {
        let sd = self.covariance.sd[at];
        match self.identifiability.leaves_open(at, sd) {
            true => f64::INFINITY,
            false => sd,
        }
    }

    /// How far from its bound a parameter may be, if it lies there.
    #[must_use]
    pub fn limit(&self, at: usize) -> Option<&Limit> {
        let limits = self.limits.as_ref().ok()?;
        limits.iter().find(|limit| limit.parameter == at)
    }
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
    let found = fit(problem, &how);
    wanted()?;
    found.map_err(user)
}

/// Fits a curve, tells the uncertainty as the method asks, and compares with
/// other models.
///
/// # Errors
/// What is in the way of a fit.
pub fn fitted(problem: CurveProblem, arguments: &Arguments) -> Result<Fitted, Failure> {
    heeded::of_table(arguments)?;
    let kept = Remembered::new(&problem, || problem.fingerprint(), arguments)?;
    let fit = best(&kept, arguments)?;
    let covariance = Covariance::new(problem.parameters(), &fit);
    let more = more::more((&problem, &kept), (&fit, &covariance), arguments)?;
    let found = judged((&problem, &kept), (fit, covariance, more), arguments)?;
    kept.sound()?;
    told(problem, found)
}

/// The same where `computed` has the problem's residuals from elsewhere, such as
/// [`Spread`](hertzchain_infer::Spread): every curve of a posterior is computed, as
/// with `--direct`.
///
/// # Errors
/// As [`fitted`].
pub fn fitted_elsewhere(
    problem: CurveProblem,
    computed: &dyn Problem,
    arguments: &Arguments,
) -> Result<Fitted, Failure> {
    heeded::of_table(arguments)?;
    let kept = Remembered::new(computed, || problem.fingerprint(), arguments)?;
    let fit = best(&kept, arguments)?;
    let covariance = Covariance::new(computed.parameters(), &fit);
    let more = more::more_of(
        (computed, &kept),
        (&fit, &covariance),
        Curves::Computed(None),
        arguments,
    )?;
    let found = judged((&problem, &kept), (fit, covariance, more), arguments)?;
    kept.sound()?;
    told(problem, found)
}

/// What else takes many curves: limits at bounds, and other models.
fn judged(
    (problem, kept): (&CurveProblem, &Remembered<'_>),
    (fit, covariance, more): (Fit, Covariance, More),
    arguments: &Arguments,
) -> Result<(Inferred, Option<Rivals>), Failure> {
    let label = |at: usize| problem.residual_label(at);
    let identifiability = Identifiability::new(problem.parameters(), &fit, label);
    let limits = limits::limits(kept, (&fit, &covariance), &identifiability, &more)?;
    let rivals = rivals::rivals((problem, kept), &fit, arguments)?;
    let inferred = Inferred {
        parameters: problem.parameters().to_vec(),
        goodness: Goodness::new(problem.parameters(), &fit),
        identifiability,
        more,
        limits,
        covariance,
        fit,
    };
    Ok((inferred, rivals))
}

fn told(
    problem: CurveProblem,
    (inferred, rivals): (Inferred, Option<Rivals>),
) -> Result<Fitted, Failure> {
    let (fit, covariance) = (&inferred.fit, &inferred.covariance);
    let speeds = Speeds::of_rows(&problem.data().speeds_m_s());
    let accuracy = problem.model().accuracy_reached(&fit.point, &speeds);
    let open = !inferred.identifiability.confused.is_empty() && fit.ending.converged();
    let rejected = inferred.goodness.is_rejected();
    Ok(Fitted {
        unit_of_speed: rejected.then(|| problem.other_unit_of_speed()).flatten(),
        advice: open.then(|| problem.would_separate(fit)),
        curve: problem.fitted_curve(fit, covariance).map_err(user)?,
        accuracy: accuracy.map_err(user)?,
        rivals,
        inferred,
        problem,
    })
}
