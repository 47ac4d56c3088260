//! Why there is no chain.

use crate::FitError;

/// Why walkers cannot be started or led on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SamplingError {
    /// The problem itself cannot be used.
    #[error(transparent)]
    Problem(#[from] FitError),
    /// An option is out of its range.
    #[error("{name} is {value}: expected {expected}")]
    Option {
        /// What it is.
        name: &'static str,
        /// What it was.
        value: f64,
        /// What it may be.
        expected: String,
    },
    /// No place around the optimum has a density.
    #[error(
        "walkers find no place around the optimum where the model can be computed: the fit may be at the edge of what the model bears; set bounds that keep away from it"
    )]
    NoPlace,
    /// A saved chain is of other parameters.
    #[error(
        "the chain is of {chain:?}, the problem has {problem:?}: continue it with the same free parameters, in the same order"
    )]
    OtherParameters {
        /// Names in the chain.
        chain: Vec<String>,
        /// Names in the problem.
        problem: Vec<String>,
    },
    /// A saved chain's densities are not the problem's.
    #[error(
        "the chain was sampled from other data, another model or other priors: continue it with what it was begun with, or start anew"
    )]
    OtherProblem,
    /// A saved chain's numbers of walkers, parameters and samples do not fit together.
    #[error(
        "the saved chain is damaged: its walkers, parameters and samples do not fit together; start anew"
    )]
    Damaged,
}
