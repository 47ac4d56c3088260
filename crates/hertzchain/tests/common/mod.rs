//! What tests of fit, gauge and design share: running the program, folders and curves.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub(crate) fn run(arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
    program.args(arguments).output().unwrap()
}

pub(crate) fn refused(arguments: &[&str]) -> String {
    let output = run(arguments);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(!message.contains("panicked"), "{message}");
    message
}

pub(crate) fn json(arguments: &[&str]) -> Value {
    let output = run(arguments);
    let reported = String::from_utf8_lossy(&output.stderr);
    serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|error| unreachable!("{error}: {reported}"))
}

pub(crate) fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("inference-{test}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

pub(crate) fn file(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// Six speeds of a preset's curve, as `sweep` writes them, as a path.
pub(crate) fn curve(folder: &Path, preset: &str) -> String {
    let out = folder.join(preset);
    let out = out.to_str().unwrap();
    let swept = run(&["sweep", "-p", preset, "--speeds", "log:0.1:1.2:6", "--out", out]);
    assert!(swept.status.success());
    format!("{out}/sweep.csv")
}

pub(crate) const ERRORS: [&str; 4] = ["--tof-error", "2e-7", "--speed-error", "5e-4"];

pub(crate) fn with_errors<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    arguments.iter().copied().chain(ERRORS).collect()
}

pub(crate) const HEAD: &str = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error\n";

/// The small rig, its chains laid compact and pushed by nothing, so that they are
/// the model's.
pub(crate) fn compact() -> String {
    let small = include_str!("../../../sim/tests/small.toml");
    let changes = [
        ("force = \"0.24 N\"", "force = \"0 N\""),
        ("stiffness = \"100 N/m\"", "stiffness = \"0 N/m\""),
        ("incline = \"0.2 deg\"", "incline = \"0 deg\""),
        ("taps = 2", "taps = 0"),
        ("shots = 3", "shots = 1"),
        ("gap_scatter = \"5 um\"", "gap_scatter = \"0 um\""),
    ];
    changes.iter().fold(small.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}
