//! From measurements to parameters: fits, uncertainty, identifiability, design.
#![doc = include_str!("../README.md")]

mod compare;
mod covariance;
mod curve;
mod data;
mod design;
mod error;
mod free;
pub mod gauge;
mod goodness;
mod identify;
mod least_squares;
mod linear;
mod problem;
mod profile;
mod pulses;
mod random;
mod sampler;

pub use compare::{
    Compared, Comparison, Criteria, CrossValidation, Folding, compare, cross_validate,
};
pub use covariance::Covariance;
pub use curve::{
    Advice, Choices, CurveProblem, ExpectedErrors, FitCurve, Joint, Kind, Model, Part, Predicted,
    Prospect, Speeds, Supply, Surrogate, USUAL_PRELOAD_N, Way, ways,
};
pub use data::{
    Data, DataRow, Defaults, FEWEST_SHOTS, Freedom, Observable, Scatter, Selection, widening,
    wrong_speed,
};
pub use design::{Aim, Candidate, Design, Expected, design};
pub use error::InferError;
pub use free::{Form, FreeNumber, FreeNumbers, SHORT_NAMES, same_number};
pub use goodness::{Goodness, Largest, Runs, largest_residual, runs};
pub use identify::{Identifiability, UnidentifiableDirection};
pub use least_squares::{Binding, Ending, Fit, Fitting, Jacobian, Loss, Started, fit};
pub use problem::{
    Batch, Compute, ModelError, Outcomes, Parameter, Prior, Problem, Residuals, Response, Spread,
    titled,
};
pub use profile::{End, Interval, Profile, Profiling, RISE_OF_95_PERCENT, profile};
pub use pulses::{PulseProblem, Pulses, Respond};
pub use sampler::{
    Autocorrelation, Chain, Diagnosis, Posterior, Requirements, Sampling, Shortfall, Unconverged,
    autocorrelation_time, split_r_hat,
};
