//! Times of flight that an experiment predicts, for many sets of parameters at
//! once, and their residuals to measured ones.

mod model;
mod problem;
mod stencil;
mod whiten;

pub use model::{Model, Predicted, Speeds};
pub use problem::{CurveError, CurveProblem};
