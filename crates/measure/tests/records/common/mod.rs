//! What the tests share: folders of their own, and Python in a throw-away
//! environment.
#![allow(dead_code, reason = "no test uses everything")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

mod python;

use python::Python;
use std::fs;
use std::path::{Path, PathBuf};

static PYTHON: Python = Python::new(
    "python-for-records",
    &["numpy", "scipy", "h5py", "npTDMS", "xarray", "h5netcdf"],
    "formats as other programs write them are NOT tested now",
);

/// A folder of one test's own, empty at first.
pub(super) fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("records-{test}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// A file that is kept with the tests.
pub(super) fn kept(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/records/data").join(name)
}

/// Runs a Python program in a folder and gives what it prints; `None`, with a
/// notice, where there is no Python with the packages.
pub(super) fn python(folder: &Path, program: &str) -> Option<String> {
    PYTHON.run(folder, program)
}
