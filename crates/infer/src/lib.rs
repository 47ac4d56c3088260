//! From measurements to parameters: fits, uncertainty, identifiability, design.
//!
//! The numerics know nothing of chains: they see a [`Problem`], whose residuals
//! are computed for many points at once. [`CurveProblem`] is the one of this
//! program: times of flight of an experiment.

mod batch;
mod chance;
mod compare;
mod covariance;
mod curve;
mod data;
mod design;
mod free;
pub mod gauge;
mod goodness;
mod identify;
mod least_squares;
mod linear;
mod parameter;
mod problem;
mod profile;
mod pulses;
mod robust;
mod sampler;

pub use batch::{Batch, Compute, Outcomes, Spread};
pub use compare::{
    CompareError, Compared, Comparison, Criteria, CrossValidation, Folding, compare, cross_validate,
};
pub use covariance::Covariance;
pub use curve::{
    Advice, Choices, CurveError, CurveProblem, ExpectedErrors, FittedCurve, Joint, Kind, Model,
    Part, Predicted, Prospect, Speeds, Supply, Surrogate, SurrogateError, USUAL_PRELOAD_N, Way,
    WayError, ways,
};
pub use data::{
    Data, DataError, DataRow, Defaults, FEWEST_SHOTS, Freedom, Observable, Place, Scatter,
    Selection, widening, wrong_speed,
};
pub use design::{Aim, Candidate, Design, DesignError, Expected, design};
pub use free::{Form, FreeError, FreeNumber, FreeNumbers, SHORT_NAMES, same_number};
pub use goodness::{Goodness, Largest, Runs, largest_residual, runs};
pub use identify::{Confusion, Identifiability, UNDETERMINED};
pub use least_squares::{Binding, Ending, Fit, FitError, Fitting, Jacobian, Loss, Started, fit};
pub use parameter::{Parameter, ParameterError, Prior, titled};
pub use problem::{ModelError, Problem, Residuals, Response};
pub use profile::{End, Interval, Profile, ProfileError, Profiling, RISE_OF_95_PERCENT, profile};
pub use pulses::{PulseError, PulseProblem, Pulses, RecordError, Respond};
pub use sampler::{
    Autocorrelation, Chain, Diagnosis, Posterior, Requirements, Sampling, SamplingError, Shortfall,
    Unconverged, autocorrelation_time, split_r_hat,
};
