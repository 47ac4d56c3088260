//! What can be wrong with an inference.

use crate::ModelError;
use hertzchain_experiment::{Mistakes, PathError};

/// Why nothing can be inferred. Messages say what to change.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InferError {
    /// Data, a name, a parameter, an option or a file that cannot be used.
    #[error("{0}")]
    Input(String),
    /// A short name that several numbers of the experiment have.
    #[error("{name} can be any of: {}", .candidates.join(", "))]
    Ambiguous {
        /// The name as asked.
        name: String,
        /// Unambiguous names.
        candidates: Vec<String>,
    },
    /// A free parameter that changes no residual.
    #[error(
        "{name} changes no residual near {value:.4e}: keep it fixed, or measure something that depends on it; where a \
         free number stands in its place (A for eta, K for Y), free that one alone"
    )]
    ChangesNothing {
        /// The parameter.
        name: String,
        /// Where it was varied.
        value: f64,
    },
    /// The model cannot be computed where it is needed.
    #[error("{0}")]
    Model(String),
    /// A fit that found no minimum, where one is needed.
    #[error("{0}")]
    NotConverged(String),
    /// A better minimum than the fit's was met.
    #[error(
        "a better fit was found on the way, chi-square lower by {by:.3}, at {point:?}: fit again from there"
    )]
    BetterFit {
        /// Where.
        point: Vec<f64>,
        /// How much lower χ² is.
        by: f64,
    },
}

impl InferError {
    pub(crate) fn input<T>(text: impl Into<String>) -> Result<T, Self> {
        Err(Self::Input(text.into()))
    }

    /// The same with what it is about in front.
    pub(crate) fn about(self, what: &str) -> Self {
        Self::Input(format!("{what}: {self}"))
    }
}

impl From<ModelError> for InferError {
    fn from(error: ModelError) -> Self {
        Self::Model(error.0)
    }
}

impl From<Mistakes> for InferError {
    fn from(mistakes: Mistakes) -> Self {
        Self::Input(mistakes.to_string())
    }
}

impl From<PathError> for InferError {
    fn from(error: PathError) -> Self {
        Self::Input(error.to_string())
    }
}
