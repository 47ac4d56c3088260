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

pub use self::{
    compare::{Compared, Comparison, Criteria, CrossValidation, Folding, compare, cross_validate},
    covariance::Covariance,
    curve::{
        Advice, Choices, CurveProblem, ExpectedErrors, FitCurve, Kind, MeasuredCurve, Model,
        Predicted, Prospect, Speeds, Surrogate, Way, ways,
    },
    data::{Data, DataRow, FEWEST_SHOTS, Freedom, Observable, Scatter, Selection, wrong_speed},
    design::{Aim, Candidate, Design, Expected, design},
    error::InferError,
    free::{Form, FreeNumber, FreeNumbers, same_number},
    goodness::{Goodness, Largest, Runs, largest_residual, runs},
    identify::{Identifiability, UnidentifiableDirection},
    least_squares::{Binding, Ending, Fit, Fitting, Jacobian, Loss, Started, fit},
    problem::{Batch, ModelError, Outcomes, Parameter, Prior, Problem, Residuals, Spread, titled},
    profile::{End, Interval, Profile, Profiling, RISE_OF_95_PERCENT, profile},
    pulses::{PulseProblem, Pulses, Respond},
    sampler::{
        Autocorrelation, Chain, Diagnosis, Posterior, Requirements, Sampling, Shortfall,
        Unconverged,
    },
};
