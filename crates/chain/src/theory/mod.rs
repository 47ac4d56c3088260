//! Theory.

mod error;
pub mod linear;
pub mod long_wave;
pub mod solitary;
pub mod striker;
pub mod two_body;

pub use error::TheoryError;
use error::require_positive;
