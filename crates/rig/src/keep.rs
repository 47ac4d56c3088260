//! What a folder of recordings holds, and of which campaign.
//!
//! A recording is there whole or not at all. That it is one of this campaign
//! is told by a file beside it, with the experiment and a fingerprint of all
//! that recordings follow from.

use crate::error::RigError;
use crate::plan::{Plan, Series};
use hertzchain_study::reproduce::commit;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Another version may make other bits.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Name of the file that tells which campaign it is.
const TOLD_IN: &str = "campaign.toml";

/// What a folder with another file of that name holds.
const ANOTHER: &str =
    "another campaign, or this one by another build of the program, as its campaign.toml tells";

/// A folder for the recordings of one campaign.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
}

/// A fingerprint of all that recordings follow from, the program's version and
/// commit included: 64 bits of FNV-1a.
#[must_use]
pub fn fingerprint(plan: &Plan) -> u64 {
    let experiment = &plan.experiment;
    // Numbers that a program has set are not in the text; where the file lies
    // does not matter.
    let numbers = experiment.numbers();
    let inputs = format!(
        "{} {:?} {} {numbers:?} {:?} {}",
        VERSION,
        commit(),
        plan.seed,
        experiment.reading(),
        experiment.text()
    );
    inputs.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

impl Folder {
    /// Makes the folder if need be, and notes in it which campaign it is for.
    ///
    /// # Errors
    /// A folder that can't be written to, or that holds other recordings.
    pub fn open(path: &Path, plan: &Plan) -> Result<Self, RigError> {
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
        let beside = path.join(format!(".{TOLD_IN}.{}", std::process::id()));
        let written = fs::write(&beside, told).and_then(|()| fs::rename(&beside, &told_in));
        written.map_err(|error| {
            let _ = fs::remove_file(&beside);
            refused(error)
        })?;
        Ok(folder)
    }

    fn holds(&self, holds: &'static str) -> RigError {
        RigError::AnotherCampaign {
            path: self.path.display().to_string(),
            holds,
        }
    }

    /// The file of a series.
    #[must_use]
    pub fn file(&self, series: &Series) -> PathBuf {
        self.path.join(format!("{}.h5", series.name))
    }

    /// Whether a series is finished.
    #[must_use]
    pub fn has(&self, series: &Series) -> bool {
        self.file(series).is_file()
    }
}

/// What tells a campaign: the experiment with a fingerprint above it.
fn told(plan: &Plan) -> String {
    format!(
        "# A campaign with seed {}, inputs {:016x}, by hertzchain {VERSION}{}. The recordings beside this file \
         are its own.\n{}",
        plan.seed,
        fingerprint(plan),
        commit().map_or(String::new(), |commit| format!(" ({commit})")),
        plan.experiment.text()
    )
}
