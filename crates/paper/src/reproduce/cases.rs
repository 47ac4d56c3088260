//! The paper's chains.

use super::ReproduceError;
use crate::claims::Oil;
use hertzchain_experiment::{Experiment, Reading, preset};

/// The paper's chains, in the order of the tables.
pub const CASES: [&str; 6] = [
    "hertz",
    "hertz-viscoelastic",
    "dry",
    "pump",
    "gear",
    "motor",
];

/// The wet ones.
pub const OILS: [&str; 3] = ["pump", "gear", "motor"];

/// The paper's chains in one reading.
#[derive(Clone, Debug)]
pub struct Cases(Vec<(&'static str, Experiment)>);

impl Cases {
    /// All of them.
    ///
    /// # Errors
    /// A reading that leaves something outside a chain.
    pub fn new(reading: &Reading) -> Result<Self, ReproduceError> {
        let open = |case| {
            let experiment = preset(case).map_err(ReproduceError::Preset)?;
            Ok((case, experiment.with_reading(reading)?))
        };
        let all = CASES.into_iter().map(open);
        all.collect::<Result<_, ReproduceError>>().map(Self)
    }

    /// Names and experiments, in the order of the tables.
    pub(super) fn all(&self) -> &[(&'static str, Experiment)] {
        &self.0
    }

    /// The experiment of a case.
    #[must_use]
    pub fn get(&self, case: &str) -> Option<&Experiment> {
        let found = self.0.iter().find(|(name, _)| *name == case);
        found.map(|(_, experiment)| experiment)
    }

    /// The liquids as printed.
    #[must_use]
    pub fn oils(&self) -> Vec<Oil> {
        let oil = |case: &&str| {
            let liquid = self.get(case)?.liquid()?;
            Some(Oil {
                case: (*case).to_owned(),
                kinematic_viscosity_m2_s: liquid.kinematic_viscosity_m2_s?,
                density_kg_m3: liquid.density_kg_m3?,
            })
        };
        OILS.iter().filter_map(oil).collect()
    }
}
