//! What is to be inferred, and from which residuals.

use crate::Parameter;

/// Measurements against a model with free parameters.
///
/// Points are in the parameters' own units, in the order of
/// [`parameters`](Self::parameters); scaling is the business of this crate.
pub trait Problem: Sync {
    /// The free parameters.
    fn parameters(&self) -> &[Parameter];

    /// How many residuals there are at every point.
    fn residual_count(&self) -> usize;

    /// Residuals at many points: all that can be computed side by side come in
    /// one call, so that they can run as lanes of one ensemble. One result a
    /// point, in order; a point at which the model fails has an error of its own.
    /// A point's residuals must not depend on its neighbours.
    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>>;

    /// What each measured number, larger by some amount, changes in the residuals at a point:
    /// residuals and changes, one list a residual. `None` where each residual is a measured
    /// number of its own.
    ///
    /// # Errors
    /// A model that fails at the point.
    fn responses(&self, _point: &[f64]) -> Result<Option<Vec<Response>>, ModelError> {
        Ok(None)
    }

    /// What a residual belongs to, as messages name it: "row 3, reflected ToF".
    fn residual_label(&self, index: usize) -> String {
        format!("residual {}", index + 1)
    }
}

/// Residuals, by number, that a measured number enters, with what it changes each by.
pub type Response = Vec<(usize, f64)>;

/// Residuals at one point.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Residuals {
    /// (measured − model)/σ, one for each measured number.
    pub standardised: Vec<f64>,
    /// ln σ of each residual up to a constant that no parameter changes, so that
    /// a wide σ pays for itself; empty if no σ depends on the parameters.
    pub ln_sigmas: Vec<f64>,
}

impl Residuals {
    /// Residuals whose σ do not depend on the parameters.
    #[must_use]
    pub fn new(standardised: Vec<f64>) -> Self {
        Self {
            standardised,
            ln_sigmas: Vec::new(),
        }
    }
}

/// Why a model has no residuals at a point.
#[derive(Clone, Debug, PartialEq, Eq, Default, thiserror::Error)]
#[error("{0}")]
pub struct ModelError(pub String);
