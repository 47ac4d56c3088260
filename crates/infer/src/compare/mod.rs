//! Which model the data support.

mod criteria;
mod cross_validation;

pub use criteria::{CompareError, Compared, Comparison, Criteria, compare};
pub use cross_validation::{CrossValidation, Folding, cross_validate};
