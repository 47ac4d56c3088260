//! Posterior distributions by an affine-invariant ensemble sampler.

mod chain;
mod diagnosis;

pub use self::{
    chain::{Chain, Sampling},
    diagnosis::{Autocorrelation, Diagnosis, Posterior, Requirements, Shortfall, Unconverged},
};
