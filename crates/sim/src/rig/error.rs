//! Why a campaign can't be run.

use hertzchain_experiment::{Mistakes, PathError};
use hertzchain_measure::MeasureError;
use std::io;
use std::path::Path;

/// Why a campaign can't be run.
#[derive(Debug, thiserror::Error)]
pub enum RigError {
    /// An experiment that no rig can do.
    #[error("{0}")]
    Unsuited(String),
    /// It was interrupted.
    #[error("the campaign was interrupted; the same folder goes on from there")]
    Stopped,
    /// A speed that the actuator does not have.
    #[error("{0}")]
    Speed(String),
    /// The experiment has mistakes at one of the speeds.
    #[error(transparent)]
    Mistakes(#[from] Box<Mistakes>),
    /// A number that an experiment does not take.
    #[error(transparent)]
    Number(#[from] PathError),
    /// A shot that can't be computed.
    #[error("{0}")]
    Shot(String),
    /// A recording that can't be written.
    #[error("{0}; `campaign` with the same folder goes on from there")]
    Record(#[from] MeasureError),
    /// A file with the name of a recording that is another's, or damaged.
    #[error("{0}; move it away, and `campaign` makes it again")]
    NotOurs(MeasureError),
    /// A folder that can't be used, or recordings in it that contradict each other.
    #[error("{0}")]
    Folder(String),
    /// A folder with recordings of something else.
    #[error(
        "{0}, and recordings of two campaigns do not mix: choose another folder, or move these files away"
    )]
    AnotherCampaign(String),
    /// Not all series are there.
    #[error(
        "{} of {of} series are missing: {}; run the same `campaign` with any of the folders as --out \
         again, with any --shard: what is there is kept", .missing.len(), first(.missing)
    )]
    Missing {
        /// How many series the campaign has.
        of: usize,
        /// Names of those that are missing.
        missing: Vec<String>,
    },
}

/// Most names that a message lists.
const LISTED: usize = 12;

fn first(names: &[String]) -> String {
    match names.get(..LISTED) {
        Some(listed) if names.len() > LISTED => {
            format!("{} and {} more", listed.join(", "), names.len() - LISTED)
        }
        _ => names.join(", "),
    }
}

impl From<Mistakes> for RigError {
    fn from(mistakes: Mistakes) -> Self {
        Self::Mistakes(Box::new(mistakes))
    }
}

impl RigError {
    pub(crate) fn folder(path: &Path, error: io::Error) -> Self {
        Self::Folder(format!("cannot write into {}: {error}", path.display()))
    }
}
