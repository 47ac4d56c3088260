//! What an earlier run left in the folder.

use super::ReproduceError;
use super::provenance::{PROGRAM, PROVENANCE};
use serde_json::Value;
use std::fs;
use std::path::{Component, Path};

/// Removes what the folder's provenance lists, but for the names to keep: tables
/// of an earlier run beside those of this one would seem to belong together.
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
    names
        .filter_map(|name| Some(name.as_str()?.to_owned()))
        .collect()
}

/// Whether a name is that of a file in the folder itself, not a way out of it.
fn is_plain(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    matches!(
        (parts.next(), parts.next()),
        (Some(Component::Normal(_)), None)
    )
}

#[cfg(test)]
#[path = "tests/stale_files.rs"]
mod tests;
