//! Why a shot, a batch or a shard has no result.

use hertzchain_chain::ChainError;
use hertzchain_chain::wave::SolveError;
use hertzchain_experiment::{Mistakes, PathError};

/// Why a shot, a batch or a shard has no result.
#[derive(Clone, Debug, thiserror::Error)]
pub enum StudyError {
    /// The experiment is refused, or can't have this speed.
    #[error(transparent)]
    Mistakes(Box<Mistakes>),
    /// A number that the experiment does not take.
    #[error(transparent)]
    Number(Box<PathError>),
    /// The chain can't be set up.
    #[error(transparent)]
    Chain(#[from] ChainError),
    /// The motion can't be computed as asked.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The computation was cancelled.
    #[error("the computation was broken off")]
    Stopped,
    /// An input that is not accepted.
    #[error("{0}")]
    Refused(String),
    /// A fixed step does not reach the accuracy asked for.
    #[error("{0}")]
    NotConverged(String),
    /// Shards that are missing, damaged or do not belong together.
    #[error("{0}")]
    Shards(String),
    /// A file that can't be written.
    #[error("{0}")]
    Unwritable(String),
}

impl From<Mistakes> for StudyError {
    fn from(mistakes: Mistakes) -> Self {
        Self::Mistakes(Box::new(mistakes))
    }
}

impl From<PathError> for StudyError {
    fn from(error: PathError) -> Self {
        Self::Number(Box::new(error))
    }
}
