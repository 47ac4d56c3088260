//! What can go wrong when a theory is evaluated.

use thiserror::Error;

/// Why a theoretical number could not be given.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TheoryError {
    /// An argument outside the theory's or the method's range.
    #[error("{quantity} is {value}, expected {expected}")]
    OutOfRange {
        /// What was given, in words.
        quantity: &'static str,
        /// Its value, in SI units.
        value: f64,
        /// What would be accepted.
        expected: &'static str,
    },
    /// Lists of beads and contacts whose lengths do not fit together.
    #[error("{given} contact stiffnesses given, the beads and ends need {expected}")]
    ContactCount {
        /// Contacts that the beads and ends ask for.
        expected: usize,
        /// Contacts that were given.
        given: usize,
    },
    /// A computation that did not reach its accuracy.
    #[error("{computation} did not converge: {error:e} left")]
    NotConverged {
        /// Which computation.
        computation: &'static str,
        /// The error that was left.
        error: f64,
    },
}

/// Accepts positive finite numbers only.
pub(super) fn require_positive(quantity: &'static str, value: f64) -> Result<(), TheoryError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(TheoryError::OutOfRange {
        quantity,
        value,
        expected: "positive and finite",
    })
}
