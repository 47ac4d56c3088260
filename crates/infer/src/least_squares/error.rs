//! Why nothing can be fitted.

use crate::{ModelError, ParameterError};

/// Why a fit cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// No parameter is free.
    #[error("no parameter is free: name at least one")]
    NothingFree,
    /// Two parameters have one name.
    #[error("{name} is free twice: name every parameter once")]
    Twice {
        /// The name.
        name: String,
    },
    /// A parameter cannot be free as described.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// Fewer numbers than parameters.
    #[error(
        "{data} measured numbers and {priors} priors cannot determine {parameters} parameters: measure more, or free fewer"
    )]
    TooFew {
        /// Residuals of the data.
        data: usize,
        /// Parameters with a prior that is not flat.
        priors: usize,
        /// Free parameters.
        parameters: usize,
    },
    /// The model cannot be computed where the fit starts.
    #[error("no residuals at the start: {0}")]
    Start(#[source] ModelError),
    /// A parameter has no influence on any residual.
    #[error(
        "{name} changes no residual near {value:.4e}: keep it fixed, or measure something that depends on it"
    )]
    ChangesNothing {
        /// The parameter.
        name: String,
        /// Where it was varied.
        value: f64,
    },
    /// An option is out of its range.
    #[error("{name} is {value}: expected {expected}")]
    Option {
        /// What it is.
        name: &'static str,
        /// What it was.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// The model fails beside the optimum, so that nothing can be said about it.
    #[error("the fit came to {point:?}, beside which the model fails: {source}")]
    BesideOptimum {
        /// Where the fit came to.
        point: Vec<f64>,
        /// What the model said.
        source: ModelError,
    },
}
