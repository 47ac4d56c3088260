//! The provenance of the numbers of a folder, the removal of what an earlier run left there, and
//! the progress of a long computation.

use super::ReproduceError;
use serde::Serialize;
use serde_json::{Value, json};
use std::fs;
use std::path::{Component, Path};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Name of the file with the provenance.
pub const PROVENANCE: &str = "provenance.json";

/// Name of the program in the file.
const PROGRAM: &str = "hertzchain";

#[derive(Clone, Debug, Serialize, PartialEq)]
pub struct Provenance {
    pub version: &'static str,
    pub commit: Option<String>,
    pub solver: String,
    pub tolerance: f64,
    pub accuracy_asked: f64,
    pub accuracy_reached: f64,
    pub seed: u64,
    #[serde(rename = "draws_within_rounding")]
    pub draws: usize,
    pub machine: String,
    pub wall_time_s: f64,
}

impl Provenance {
    pub(crate) fn json(&self, files: &[&str]) -> Value {
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        let mut about = serde_json::to_value(self).unwrap_or_default();
        about["program"] = json!(PROGRAM);
        about["finished_unix_s"] = json!(now.as_ref().map_or(0, Duration::as_secs));
        about["files"] = json!(files);
        about
    }
}

pub(super) fn machine() -> String {
    let threads = rayon::current_num_threads();
    let (arch, os) = (std::env::consts::ARCH, std::env::consts::OS);
    let about = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = about.lines().find(|line| line.starts_with("model name"));
    let model = model.and_then(|line| line.split(": ").nth(1));
    let model = model.map_or(String::new(), |model| format!(", {model}"));
    format!("{arch}, {os}{model}, {threads} threads")
}

/// Removes what the folder's provenance lists, but for the names to keep: tables
/// of an earlier run next to those of this one would seem to belong together.
/// Without a provenance of this program nothing is removed.
///
/// # Errors
/// The first file that can't be removed.
pub fn remove_stale_files(folder: &Path, keep: &[&str]) -> Result<(), ReproduceError> {
    let old = listed(&folder.join(PROVENANCE));
    for name in old.iter().filter(|name| !keep.contains(&name.as_str())) {
        let path = folder.join(name);
        let is_file = fs::symlink_metadata(&path).is_ok_and(|about| about.is_file());
        if is_file && is_plain(name) {
            fs::remove_file(&path).map_err(|error| ReproduceError::Remove {
                path: path.display().to_string(),
                error,
            })?;
        }
    }
    Ok(())
}

/// The files that a provenance lists; none if it is not one of this program.
fn listed(provenance: &Path) -> Vec<String> {
    let text = fs::read(provenance).unwrap_or_default();
    let value: Value = serde_json::from_slice(&text).unwrap_or_default();
    let ours = value.get("program").and_then(Value::as_str) == Some(PROGRAM);
    let files = value.get("files").filter(|_| ours);
    let names = files.and_then(Value::as_array).into_iter().flatten();
    names.filter_map(|name| Some(name.as_str()?.to_owned())).collect()
}

/// Whether a name is that of a file in the folder itself, not a way out of it.
fn is_plain(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    matches!((parts.next(), parts.next()), (Some(Component::Normal(_)), None))
}

/// Receives the progress of a long computation; may be called from any thread.
pub trait ReproduceProgress: Sync {
    /// A stage of so many steps begins.
    fn begin(&self, stage: &str, steps: u64);
    /// One step of the stage is done.
    fn advance(&self);
    /// A note before a stage begins.
    fn note(&self, _text: &str) {}
}

#[cfg(test)]
#[path = "tests/stale_files.rs"]
mod tests;
