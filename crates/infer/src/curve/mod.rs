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

pub use self::{
    advice::{Advice, Prospect},
    band::FitCurve,
    candidates::{Choices, ExpectedErrors, Kind, Way, ways},
    joint::CurveProblem,
    model::{Model, Predicted, Speeds},
    problem::MeasuredCurve,
    surrogate::Surrogate,
};
pub(crate) use joint::Supply;
pub(crate) use model::Shooting;
