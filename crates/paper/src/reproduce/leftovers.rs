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
pub fn remove_leftovers(folder: &Path, keep: &[&str]) -> Result<(), ReproduceError> {
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
mod tests {
    use super::*;
    use std::path::PathBuf;

    /// A new folder with a provenance and some files.
    fn folder(name: &str, provenance: &str) -> PathBuf {
        let name = format!("hertzchain-{name}-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        fs::create_dir_all(folder.join("inside")).unwrap();
        fs::write(folder.join(PROVENANCE), provenance).unwrap();
        for file in ["tof.csv", "readings.md", "mine.txt", "inside/deep.csv"] {
            fs::write(folder.join(file), "").unwrap();
        }
        folder
    }

    /// Which of the files are still there.
    fn left(folder: &Path) -> [bool; 4] {
        let files = ["tof.csv", "readings.md", "mine.txt", "inside/deep.csv"];
        let left = files.map(|file| folder.join(file).exists());
        fs::remove_dir_all(folder).unwrap();
        left
    }

    #[test]
    fn only_what_an_earlier_run_listed_and_this_one_did_not_write_is_removed() {
        let listed =
            r#"{"program": "hertzchain", "files": ["tof.csv", "readings.md", "gone.svg"]}"#;
        let folder = folder("leftovers", listed);
        remove_leftovers(&folder, &["tof.csv"]).unwrap();
        assert_eq!(left(&folder), [true, false, true, true]);
    }

    #[test]
    fn nothing_outside_the_folder_or_below_it_is_removed() {
        let listed =
            r#"{"program": "hertzchain", "files": ["inside/deep.csv", "inside", "..", "", 7]}"#;
        let folder = folder("outside", listed);
        let beside = folder.with_extension("beside");
        fs::write(&beside, "").unwrap();
        let name = beside.file_name().unwrap().to_str().unwrap();
        let listed = listed.replace("..", &format!("../{name}"));
        fs::write(folder.join(PROVENANCE), listed).unwrap();
        remove_leftovers(&folder, &[]).unwrap();
        let stays = beside.exists();
        fs::remove_file(&beside).unwrap();
        assert!(stays);
        assert_eq!(left(&folder), [true; 4]);
    }

    #[test]
    fn a_provenance_of_something_else_removes_nothing() {
        for other in [
            r#"{"program": "another", "files": ["tof.csv"]}"#,
            r#"{"program": "hertzchain"}"#,
            "no JSON",
        ] {
            let folder = folder("other", other);
            remove_leftovers(&folder, &[]).unwrap();
            assert_eq!(left(&folder), [true; 4], "{other}");
        }
    }
}
