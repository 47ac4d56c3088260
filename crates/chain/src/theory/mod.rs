//! Theory.

mod error;
pub mod solitary;

pub use error::TheoryError;
use error::require_positive;
