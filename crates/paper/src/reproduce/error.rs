//! Why a reproduction ends without a result.

use crate::claims::ClaimError;
use hertzchain_experiment::{Mistakes, SwitchError, UnknownPreset};
use hertzchain_sim::StudyError;

/// Why a reproduction ends without a result.
#[derive(Debug, thiserror::Error)]
pub enum ReproduceError {
    /// A shot can't be computed.
    #[error("the shot of `{case}` at {speed_m_s} m/s: {error}")]
    Shot {
        /// The case.
        case: String,
        /// Speed in m/s.
        speed_m_s: f64,
        /// Why.
        error: Box<StudyError>,
    },
    /// A reading that an experiment can't have.
    #[error(transparent)]
    Mistakes(#[from] Mistakes),
    /// A switch that does not exist.
    #[error(transparent)]
    Reading(SwitchError),
    /// One of the paper's chains is missing from the program.
    #[error(transparent)]
    Preset(UnknownPreset),
    /// A case that does not exist.
    #[error("there is no case `{0}`")]
    NoCase(String),
    /// The claims can't be read.
    #[error(transparent)]
    Claims(#[from] ClaimError),
    /// A file of an earlier run can't be removed.
    #[error("{path}, of an earlier run, can't be removed: {error}")]
    Remove {
        /// The file.
        path: String,
        /// Why.
        error: std::io::Error,
    },
}

pub(crate) fn failed(case: &str, speed_m_s: f64, error: StudyError) -> ReproduceError {
    ReproduceError::Shot {
        case: case.to_owned(),
        speed_m_s,
        error: Box::new(error),
    }
}
