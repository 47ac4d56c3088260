//! Times of flight that an experiment predicts, for many sets of parameters at
//! once, and their residuals to measured ones.

mod advice;
mod band;
mod candidates;
mod contacts;
mod joint;
mod model;
mod problem;
mod stencil;
mod surrogate;
mod units;
mod whiten;

pub use advice::{Advice, Prospect};
pub use band::FitCurve;
pub use candidates::{Choices, ExpectedErrors, Kind, USUAL_PRELOAD_N, Way, ways};
pub use joint::{Joint, Part, Supply};
pub(crate) use model::Shooting;
pub use model::{Model, Predicted, Speeds};
pub use problem::CurveProblem;
pub use surrogate::Surrogate;
