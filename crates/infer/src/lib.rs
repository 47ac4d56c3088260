//! From measurements to parameters: fits, uncertainty, identifiability, design.
//!
//! The numerics know nothing of chains: they see a [`Problem`], whose residuals
//! are computed for many points at once.

mod curve;
mod data;
mod free;
mod parameter;
mod problem;

pub use curve::{CurveError, CurveProblem, Model, Predicted, Speeds};
pub use data::{Data, DataError, DataRow, Defaults, Observable, Place};
pub use free::{Form, FreeError, FreeNumber, FreeNumbers, SHORT_NAMES};
pub use parameter::{Parameter, ParameterError, Prior};
pub use problem::{ModelError, Problem, Residuals};
