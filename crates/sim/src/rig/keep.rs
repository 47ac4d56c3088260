//! What a folder of recordings holds, and of which campaign.
//!
//! A recording is there whole or not at all. That it is one of this campaign
//! is told by a file beside it, with the experiment and a fingerprint of all
//! that recordings follow from.

use crate::commit;
use crate::rig::error::RigError;
use crate::rig::plan::{Plan, Series};
use crate::{Fingerprint, Inputs};
use hertzchain_experiment::Experiment;
use hertzchain_measure::records::{remove_left_behind, write_whole};
use std::collections::HashSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Another version may make other bits.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Name of the file in a folder of recordings that tells which campaign it is.
pub const TOLD_IN: &str = "campaign.toml";

/// What a folder with another file of that name holds.
const ANOTHER: &str =
    "another campaign, or this one by another build of the program, as its campaign.toml tells";

/// A folder for the recordings of one campaign.
#[derive(Clone, Debug)]
pub(super) struct Folder {
    path: PathBuf,
}

/// Of all that recordings follow from, the program's version and commit included.
#[must_use]
pub(super) fn fingerprint(plan: &Plan) -> Fingerprint {
    let inputs = Inputs::of("campaign").count("seed", plan.seed);
    inputs
        .text("experiment", &plan.experiment.understood())
        .fingerprint()
}

impl Folder {
    /// Makes the folder if need be, and notes in it which campaign it is for.
    ///
    /// # Errors
    /// A folder that can't be written to, or that holds other recordings.
    pub(super) fn open(path: &Path, plan: &Plan) -> Result<Self, RigError> {
        let refused = |error| RigError::folder(path, error);
        fs::create_dir_all(path).map_err(refused)?;
        let folder = Self {
            path: path.to_owned(),
        };
        let told = told(plan);
        let told_in = path.join(TOLD_IN);
        match fs::read_to_string(&told_in) {
            Ok(found) if found == told => return Ok(folder),
            Ok(_) => return Err(folder.holds(ANOTHER)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(refused(error)),
        }
        if plan.series.iter().any(|series| folder.has(series)) {
            return Err(
                folder.holds("recordings, but no campaign.toml that tells of which campaign")
            );
        }
        write_whole(&told_in, |file| file.write_all(told.as_bytes())).map_err(refused)?;
        Ok(folder)
    }

    /// Removes what a killed run has left of recordings under way.
    pub(super) fn clear(&self, plan: &Plan) {
        let names: HashSet<String> = plan.series.iter().map(file_name).collect();
        remove_left_behind(&self.path, |file| names.contains(file));
    }

    /// A folder that has recordings of this campaign; nothing is written.
    ///
    /// # Errors
    /// One that holds another campaign's, or none.
    pub(super) fn of(path: &Path, plan: &Plan) -> Result<Self, RigError> {
        let told_in = path.join(TOLD_IN);
        let found = fs::read_to_string(&told_in);
        let found = found.map_err(|error| RigError::folder(&told_in, error))?;
        let folder = Self {
            path: path.to_owned(),
        };
        match found == told(plan) {
            true => Ok(folder),
            false => Err(folder.holds(ANOTHER)),
        }
    }

    fn holds(&self, holds: &'static str) -> RigError {
        RigError::AnotherCampaign {
            path: self.path.display().to_string(),
            holds,
        }
    }

    /// The file of a series.
    #[must_use]
    pub(super) fn file(&self, series: &Series) -> PathBuf {
        self.path.join(file_name(series))
    }

    /// Whether a series is finished.
    #[must_use]
    pub(super) fn has(&self, series: &Series) -> bool {
        self.file(series).is_file()
    }
}

fn file_name(series: &Series) -> String {
    format!("{}.h5", series.name)
}

/// What stands before the seed in the file that tells a campaign.
const SEED: &str = " with seed ";

/// What tells a campaign: the experiment with a fingerprint above it, and the
/// name that its files have where it has no cases.
fn told(plan: &Plan) -> String {
    let named = match (plan.experiment.cases().is_empty(), plan.cases.first()) {
        (true, Some(case)) => format!(" of `{}`", case.name),
        _ => String::new(),
    };
    format!(
        "# A campaign{named}{SEED}{}, inputs {}, by hertzchain {VERSION}{}. The recordings beside this file \
         are its own.\n{}",
        plan.seed,
        fingerprint(plan).short(),
        commit().map_or(String::new(), |commit| format!(" ({commit})")),
        plan.experiment.text()
    )
}

/// The campaign of a folder, from the file in it that tells which it is.
///
/// # Errors
/// A folder without one, or one by another build of the program or with numbers that
/// a program has set: these are not in the file.
pub fn told_plan(path: &Path) -> Result<Plan, RigError> {
    let file = path.join(TOLD_IN);
    let text = fs::read_to_string(&file).map_err(|error| RigError::folder(&file, error))?;
    let other = || RigError::OtherBuild(file.display().to_string());
    let (line, toml) = text.split_once('\n').ok_or_else(other)?;
    let seed = line
        .split_once(SEED)
        .and_then(|(_, rest)| rest.split_once(','));
    let seed = seed
        .and_then(|(seed, _)| seed.parse().ok())
        .ok_or_else(other)?;
    let name = line.split('`').nth(1).unwrap_or(TOLD_IN);
    let plan = Plan::new(&Experiment::from_text(name, toml)?, Some(seed))?;
    match told(&plan) == text {
        true => Ok(plan),
        false => Err(other()),
    }
}
