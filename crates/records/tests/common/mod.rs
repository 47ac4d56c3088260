//! What the tests share: folders of their own, and Python in a throw-away
//! environment.
#![allow(dead_code, reason = "no test uses everything")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// What the other programs need.
const PACKAGES: &[&str] = &["numpy", "scipy", "h5py", "npTDMS", "xarray", "h5netcdf"];

/// A folder of one test's own, empty at first.
pub fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("records-{test}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// A file that is kept with the tests.
pub fn kept(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

/// Runs a Python program in a folder and gives what it prints; `None`, with a
/// notice that no test captures, where there is no Python with the packages.
pub fn python(folder: &Path, program: &str) -> Option<String> {
    let python = interpreter().as_ref()?;
    let script = folder.join("script.py");
    fs::write(&script, program).unwrap();
    let output = Command::new(python)
        .arg(&script)
        .current_dir(folder)
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    Some(String::from_utf8(output.stdout).unwrap())
}

/// The environment's Python, made at first use and kept with the build.
fn interpreter() -> &'static Option<PathBuf> {
    static PYTHON: OnceLock<Option<PathBuf>> = OnceLock::new();
    PYTHON.get_or_init(|| {
        let made = environment();
        if made.is_none() {
            let mut stderr = std::io::stderr();
            let _ = writeln!(
                stderr,
                "\nNOTICE: no Python with {PACKAGES:?} here and none can be installed:\n\
                 NOTICE: formats as other programs write them are NOT tested now.\n"
            );
        }
        made
    })
}

fn environment() -> Option<PathBuf> {
    let place = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let lock = File::create(place.join("python-for-records.lock")).ok()?;
    lock.lock().ok()?;
    let environment = place.join("python-for-records");
    let python = environment.join("bin/python");
    let complete = environment.join("complete");
    if complete.exists() {
        return Some(python);
    }
    run(Path::new("python3"), &["-m", "venv", environment.to_str()?])?;
    let mut install = vec!["-m", "pip", "install", "--quiet"];
    install.extend(PACKAGES);
    run(&python, &install)?;
    fs::write(complete, "").ok().map(|()| python)
}

fn run(program: &Path, arguments: &[&str]) -> Option<()> {
    let output = Command::new(program).args(arguments).output().ok()?;
    output.status.success().then_some(())
}
