//! The paper's chains and speeds, and the errors of a reproduction.

use crate::claims::{ClaimError, PrintedOil};
use hertzchain_experiment::{Experiment, Mistakes, PathError, Reading, UnknownName, preset};
use hertzchain_sim::StudyError;

/// Speeds of the tables and curves in m/s: those that the paper names or that
/// others can compare with, and enough between them for smooth curves.
pub(crate) const SPEEDS_M_S: [f64; 31] = [
    0.075, 0.085, 0.1, 0.115, 0.125, 0.1368, 0.1396, 0.16, 0.18, 0.2, 0.225, 0.25, 0.28, 0.32,
    0.36, 0.3993, 0.45, 0.5, 0.55, 0.6, 0.675, 0.75, 0.825, 0.9, 0.95, 1.0, 1.05, 1.1, 1.152, 1.19,
    1.23,
];

/// The paper's chains, in the order of the tables.
pub const CASES: [&str; 6] = ["hertz", "hertz-viscoelastic", "dry", "pump", "gear", "motor"];

pub(crate) const OILS: [&str; 3] = ["pump", "gear", "motor"];

#[derive(Clone, Debug)]
pub(crate) struct Cases(Vec<(&'static str, Experiment)>);

impl Cases {
    pub(crate) fn new(reading: &Reading) -> Result<Self, ReproduceError> {
        let open = |case| {
            let experiment = preset(case).map_err(ReproduceError::Preset)?;
            Ok((case, experiment.with_reading(reading)?))
        };
        let all = CASES.into_iter().map(open);
        all.collect::<Result<_, ReproduceError>>().map(Self)
    }

    /// The cases with each experiment changed.
    pub(crate) fn changed(
        &self,
        change: impl Fn(&str, &Experiment) -> Result<Experiment, PathError>,
    ) -> Result<Self, ReproduceError> {
        let changed = |(case, own): &(&'static str, Experiment)| Ok((*case, change(case, own)?));
        self.0.iter().map(changed).collect::<Result<_, ReproduceError>>().map(Self)
    }

    pub(super) fn all(&self) -> &[(&'static str, Experiment)] {
        &self.0
    }

    pub(crate) fn get(&self, case: &str) -> Result<&Experiment, ReproduceError> {
        let found = self.0.iter().find(|(name, _)| *name == case);
        let found = found.ok_or_else(|| ReproduceError::NoCase(case.to_owned()));
        found.map(|(_, experiment)| experiment)
    }

    pub(crate) fn oils(&self) -> Vec<PrintedOil> {
        let oil = |case: &&str| {
            let liquid = self.get(case).ok()?.liquid()?;
            Some(PrintedOil {
                case: (*case).to_owned(),
                kinematic_viscosity_m2_s: liquid.kinematic_viscosity_m2_s?,
                density_kg_m3: liquid.density_kg_m3?,
            })
        };
        OILS.iter().filter_map(oil).collect()
    }
}

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
    /// A number that an experiment can't have.
    #[error(transparent)]
    Number(#[from] PathError),
    /// One of the paper's chains is missing from the program.
    #[error(transparent)]
    Preset(UnknownName),
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
    ReproduceError::Shot { case: case.to_owned(), speed_m_s, error: Box::new(error) }
}
