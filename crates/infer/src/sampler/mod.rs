//! Posterior distributions by an ensemble of walkers.

mod autocorrelation;
mod ball;
mod chain;
mod converged;
mod density;
mod error;
mod lead;
mod moves;
mod posterior;

pub use autocorrelation::{Autocorrelation, autocorrelation_time};
pub use chain::{Chain, Sampling};
pub use converged::{Diagnosis, Requirements, Shortfall, Unconverged, split_r_hat};
pub use error::SamplingError;
pub use posterior::Posterior;
