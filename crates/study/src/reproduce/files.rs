//! Files that are there whole or not at all.

use super::ReproduceError;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Writes a file beside its place and then renames it, so that nobody ever
/// sees half of it. Folders on the way are made.
///
/// # Errors
/// What the system says, with the path.
pub fn write_atomically(path: &Path, content: &[u8]) -> Result<(), ReproduceError> {
    written(path, content).map_err(|error| ReproduceError::Write {
        path: path.display().to_string(),
        error,
    })
}

fn written(path: &Path, content: &[u8]) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let beside = beside(path);
    let result = fs::write(&beside, content).and_then(|()| fs::rename(&beside, path));
    if result.is_err() {
        // Nothing half-written stays; the first error is the one that counts.
        let _ = fs::remove_file(&beside);
    }
    result
}

/// A name of this process beside the file.
fn beside(path: &Path) -> PathBuf {
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.part", std::process::id()));
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_cannot_be_renamed_leaves_nothing_behind() {
        let folder = std::env::temp_dir().join(format!("hertzchain-atomic-{}", std::process::id()));
        // A folder of that name is in the way of the rename.
        let path = folder.join("tof.csv");
        fs::create_dir_all(path.join("in-the-way")).unwrap();
        assert!(write_atomically(&path, b"case").is_err());
        let left = fs::read_dir(&folder).unwrap().count();
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!(left, 1, "only the folder that was in the way");
    }

    #[test]
    fn an_existing_file_is_replaced_whole() {
        let folder = std::env::temp_dir().join(format!("hertzchain-whole-{}", std::process::id()));
        let path = folder.join("deep").join("tof.csv");
        write_atomically(&path, b"a long first content").unwrap();
        write_atomically(&path, b"short").unwrap();
        let read = fs::read(&path).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!(read, b"short");
    }
}
