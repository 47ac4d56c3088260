//! Free parameters, their priors, and the residuals that a fit minimises.

use crate::InferError;
use hertzchain_sim::{Fingerprint, count_done};
use serde::Serialize;
use std::fmt;
use std::sync::OnceLock;

/// A free parameter of a [`Problem`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// Name, as messages and tables show it.
    pub name: String,
    /// Unit of all its numbers; empty if it has none.
    pub unit: String,
    /// Where a fit starts.
    pub start: f64,
    /// Least value; −∞ without a bound.
    pub lower: f64,
    /// Largest value; +∞ without a bound.
    pub upper: f64,
    /// Size of a change that matters, positive: derivatives are taken over a small part of it,
    /// and identifiability is measured in it.
    pub scale: f64,
    /// Prior distribution.
    pub prior: Prior,
}

/// What is known of a parameter apart from the data.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize)]
#[serde(untagged)]
pub enum Prior {
    /// Flat within the bounds.
    #[default]
    Flat,
    /// Normal.
    Normal {
        /// Mean, in the parameter's unit.
        mean: f64,
        /// Standard deviation, in the parameter's unit, positive.
        sd: f64,
    },
    /// ln θ is normal around ln `median`.
    LogNormal {
        /// Median, in the parameter's unit, positive.
        median: f64,
        /// Standard deviation of ln θ, positive.
        ln_sd: f64,
    },
}

impl fmt::Display for Prior {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Flat => write!(f, "no prior"),
            Self::Normal { mean, sd } => write!(f, "a prior {} ± {}", short(mean), short(sd)),
            Self::LogNormal { median, ln_sd } => {
                let factor = short(ln_sd.exp());
                write!(f, "a prior {} times or over {factor}", short(median))
            }
        }
    }
}

/// A number without the last digits that conversions of units and logarithms leave.
pub(crate) fn short(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}

/// Distance from the middle of a prior, in standard deviations, at which it excludes a start.
const EXCLUDED_SD: f64 = 6.0;

impl Prior {
    /// (θ − mean)/sd, of the logarithm for a log-normal prior: what a fit adds to its residuals.
    /// `None` of a flat prior; infinite where impossible.
    pub(crate) fn residual(&self, value: f64) -> Option<f64> {
        match *self {
            Self::Flat => None,
            Self::Normal { mean, sd } => Some((value - mean) / sd),
            Self::LogNormal { .. } if value <= 0.0 => Some(f64::INFINITY),
            Self::LogNormal { median, ln_sd } => Some((value / median).ln() / ln_sd),
        }
    }

    fn is_valid(&self) -> bool {
        let width = |w: f64| w > 0.0 && w.is_finite();
        match *self {
            Self::Flat => true,
            Self::Normal { mean, sd } => mean.is_finite() && width(sd),
            Self::LogNormal { median, ln_sd } => width(median) && width(ln_sd),
        }
    }
}

/// A name, with a unit in parentheses if there is one.
pub fn titled(name: &str, unit: &str) -> String {
    match unit {
        "" => name.to_owned(),
        unit => format!("{name} ({unit})"),
    }
}

impl Parameter {
    /// A parameter without bounds or prior, its scale the start's magnitude (1 if that is 0).
    pub fn new(name: &str, unit: &str, start: f64) -> Self {
        Self {
            name: name.to_owned(),
            unit: unit.to_owned(),
            start,
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            scale: if start == 0.0 { 1.0 } else { start.abs() },
            prior: Prior::Flat,
        }
    }

    /// Its name, with its unit in parentheses if it has one.
    pub fn title(&self) -> String {
        titled(&self.name, &self.unit)
    }

    /// The same parameter, bounded.
    pub fn within(self, lower: f64, upper: f64) -> Self {
        Self { lower, upper, ..self }
    }

    /// Whether a value is within the bounds.
    pub(crate) fn admits(&self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// Checks bounds, start, scale and prior against each other.
    pub(crate) fn check(&self) -> Result<(), InferError> {
        let (name, prior) = (&self.name, &self.prior);
        let [start, lower, upper] = [self.start, self.lower, self.upper].map(short);
        if self.lower.is_nan() || self.upper.is_nan() || self.lower >= self.upper {
            return InferError::input(format!(
                "{name}: the bounds {lower} to {upper} leave nothing between them"
            ));
        }
        if !self.start.is_finite() || !self.admits(self.start) {
            return InferError::input(format!(
                "{name} starts at {start}, outside its bounds {lower} to {upper}: start within them, or move them"
            ));
        }
        if !(self.scale > 0.0 && self.scale.is_finite()) {
            return InferError::input(format!(
                "{name} has the scale {}: expected a positive number, the size of a change that matters",
                short(self.scale)
            ));
        }
        if !prior.is_valid() {
            return InferError::input(format!(
                "{name}: {prior} is no distribution; widths and medians must be positive"
            ));
        }
        match prior.residual(self.start).map(f64::abs) {
            Some(deviation) if deviation > EXCLUDED_SD => InferError::input(format!(
                "{name} starts at {start}, {deviation:.1} standard deviations from the middle of its prior: start nearer, or widen the prior"
            )),
            _ => Ok(()),
        }
    }
}

/// Measurements against a model with free parameters.
///
/// Points are in the parameters' own units, in the order of [`parameters`](Self::parameters).
pub trait Problem: Sync {
    /// The free parameters.
    fn parameters(&self) -> &[Parameter];

    /// Number of residuals at every point.
    fn residual_count(&self) -> usize;

    /// Residuals at many points: all that can be computed side by side come in one call, so that
    /// they can run as lanes of one batch. One result a point, in order, independent of its
    /// neighbours; a point at which the model fails has an error of its own.
    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>>;

    /// Derivatives of the residuals by each measured number: `None` where each residual is a
    /// measured number of its own.
    fn responses(&self, _point: &[f64]) -> Result<Option<Vec<Response>>, ModelError> {
        Ok(None)
    }

    /// Degrees of freedom of each residual's σ; `None` where all are known.
    fn freedoms(&self, _point: &[f64]) -> Result<Option<Vec<f64>>, ModelError> {
        Ok(None)
    }

    /// What a residual belongs to, as messages name it: "row 3, reflected ToF".
    fn residual_label(&self, index: usize) -> String {
        format!("residual {}", index + 1)
    }
}

/// Residuals, by number, that a measured number enters, with their derivatives by it.
pub(crate) type Response = Vec<(usize, f64)>;

/// Residuals at one point.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Residuals {
    /// (measured − model)/σ, one for each measured number.
    pub standardised: Vec<f64>,
    /// ln σ of each residual up to a constant; empty if no σ depends on the parameters.
    pub ln_sigmas: Vec<f64>,
}

impl Residuals {
    /// Residuals whose σ do not depend on the parameters.
    pub fn new(standardised: Vec<f64>) -> Self {
        let ln_sigmas = Vec::new();
        Self { standardised, ln_sigmas }
    }
}

/// Why a model has no residuals at a point.
#[derive(Clone, Debug, PartialEq, Eq, Default, thiserror::Error)]
#[error("{0}")]
pub struct ModelError(pub String);

/// Results of the points of a batch, in their order.
pub type Outcomes = Vec<Result<Residuals, ModelError>>;

/// Points whose residuals are computed together, on whichever machine has the problem: their bits
/// depend on nothing but the problem and the points.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// A hash of the problem and the bits of the points.
    pub name: Fingerprint,
    /// The points, in the parameters' own units.
    pub points: Vec<Vec<f64>>,
}

impl Batch {
    /// Points in batches of at most `size`, in order. Small ones occupy more machines, large ones
    /// fill the lanes of a batch of shots: a point's curve has a lane for each speed already.
    pub fn cut(problem: &Fingerprint, points: &[Vec<f64>], size: usize) -> Vec<Self> {
        let batch = |points: &[Vec<f64>]| {
            let name = Fingerprint::of("batch", &(problem, points));
            Self { name, points: points.to_vec() }
        };
        points.chunks(size.max(1)).map(batch).collect()
    }

    /// Computes the batch here.
    pub fn outcomes(&self, problem: &dyn Problem) -> Outcomes {
        problem.residuals(&self.points)
    }
}

/// Computes batches elsewhere: outcomes of all of them, in order, or why there are none.
pub(crate) type Compute<'a> = dyn Fn(&[Batch]) -> Result<Vec<Outcomes>, String> + Sync + 'a;

/// A problem whose residuals are computed elsewhere: a fit, a profile or a sampler that is given it
/// in the problem's place has the same bits.
///
/// Once a batch cannot be computed, all points from then on have an error: check
/// [`failure`](Self::failure) before a result is used.
pub struct Spread<'a> {
    problem: &'a dyn Problem,
    fingerprint: Fingerprint,
    size: usize,
    workers: usize,
    compute: &'a Compute<'a>,
    failure: OnceLock<String>,
}

impl<'a> Spread<'a> {
    /// Of a problem by its fingerprint, in batches of at most `size` points: fewer where so many
    /// workers would otherwise not all have one.
    pub fn new(
        problem: &'a dyn Problem,
        fingerprint: Fingerprint,
        size: usize,
        workers: usize,
        compute: &'a Compute<'a>,
    ) -> Self {
        let failure = OnceLock::new();
        Self { problem, fingerprint, size, workers, compute, failure }
    }

    /// Why a batch could not be computed, if one could not.
    pub fn failure(&self) -> Option<&str> {
        self.failure.get().map(String::as_str)
    }

    fn outcomes(&self, points: &[Vec<f64>]) -> Result<Outcomes, String> {
        if let Some(why) = self.failure() {
            return Err(why.to_owned());
        }
        let share = points.len().div_ceil(self.workers.max(1));
        let batches = Batch::cut(&self.fingerprint, points, self.size.min(share));
        let found = (self.compute)(&batches)?;
        let sizes = batches.iter().map(|batch| batch.points.len());
        if !found.iter().map(Vec::len).eq(sizes) {
            return Err("batches came back with other numbers of points".to_owned());
        }
        count_done(points.len());
        Ok(found.into_iter().flatten().collect())
    }
}

impl Problem for Spread<'_> {
    fn parameters(&self) -> &[Parameter] {
        self.problem.parameters()
    }

    fn residual_count(&self) -> usize {
        self.problem.residual_count()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Outcomes {
        self.outcomes(points).unwrap_or_else(|why| {
            let why = self.failure.get_or_init(|| why);
            points.iter().map(|_| Err(ModelError(why.clone()))).collect()
        })
    }

    fn residual_label(&self, index: usize) -> String {
        self.problem.residual_label(index)
    }
}
