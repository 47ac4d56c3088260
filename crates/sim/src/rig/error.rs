//! What can be wrong with a campaign, told to people.

use crate::StudyError;
use crate::rig::striker::OutOfRange;
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
    /// It was broken off.
    #[error("the campaign was broken off; the same folder goes on from there")]
    Stopped,
    /// A speed that the actuator does not have.
    #[error("{what}: {why}")]
    Speed {
        /// Which speed: a series' or the taps'.
        what: String,
        /// Why.
        why: OutOfRange,
    },
    /// The experiment has mistakes at one of the speeds.
    #[error(transparent)]
    Mistakes(#[from] Box<Mistakes>),
    /// A number that an experiment does not take.
    #[error(transparent)]
    Number(#[from] PathError),
    /// A shot that can't be computed.
    #[error("series {series}, {when}: {why}")]
    Shot {
        /// Name of the series.
        series: String,
        /// Which shot or tap.
        when: String,
        /// Why.
        why: StudyError,
    },
    /// A recording that can't be written.
    #[error("{0}; `campaign` with the same folder goes on from there")]
    Record(#[from] MeasureError),
    /// A file with the name of a recording that is another's, or damaged.
    #[error("{0}; move it away, and `campaign` makes it again")]
    NotOurs(MeasureError),
    /// A folder that can't be used.
    #[error("cannot write into {path}: {error}")]
    Folder {
        /// Which one.
        path: String,
        /// What the system says.
        error: io::Error,
    },
    /// A folder with recordings of something else.
    #[error(
        "{path} holds {holds}, and recordings of two campaigns do not mix: choose another folder, or \
         move these files away"
    )]
    AnotherCampaign {
        /// The folder.
        path: String,
        /// What is there.
        holds: &'static str,
    },
    /// A folder whose campaign can't be told from its file.
    #[error(
        "{0} is of another build of the program, or of an experiment whose numbers a program has set: merge \
         with the build that made the recordings"
    )]
    OtherBuild(String),
    /// Two recordings of one series that are not the same.
    #[error("{one} and {other} are the same series with other bytes: one is damaged; move it away")]
    Differ {
        /// One file.
        one: String,
        /// The other.
        other: String,
    },
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
    let listed = names
        .iter()
        .take(LISTED)
        .cloned()
        .collect::<Vec<_>>()
        .join(", ");
    match names.len().saturating_sub(LISTED) {
        0 => listed,
        more => format!("{listed} and {more} more"),
    }
}

impl From<Mistakes> for RigError {
    fn from(mistakes: Mistakes) -> Self {
        Self::Mistakes(Box::new(mistakes))
    }
}

impl RigError {
    pub(crate) fn folder(path: &Path, error: io::Error) -> Self {
        Self::Folder {
            path: path.display().to_string(),
            error,
        }
    }
}
