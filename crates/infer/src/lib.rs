//! From measurements to parameters: fits, uncertainty, identifiability, design.
//!
//! The numerics know nothing of chains: they see a [`Problem`], whose residuals
//! are computed for many points at once.

mod parameter;
mod problem;

pub use parameter::{Parameter, ParameterError, Prior};
pub use problem::{ModelError, Problem, Residuals};
