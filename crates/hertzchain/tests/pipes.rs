//! Tables and recordings that come through pipes, and programs that are interrupted.

use crate::common::{ERRORS, curve, file, folder, run};
use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

/// What the program prints, and what lies in its folder of temporary files afterwards.
fn piped(test: &str, arguments: &[&str], input: &str) -> (Option<i32>, String, usize) {
    let scratch = folder(test);
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
    let program = program.args(arguments).env("TMPDIR", &scratch);
    let program = program.stdin(fs::File::open(input).unwrap());
    let done = program.stdout(Stdio::null()).output().unwrap();
    let described = String::from_utf8_lossy(&done.stderr).into_owned();
    let left = fs::read_dir(scratch).unwrap().count();
    (done.status.code(), described, left)
}

#[test]
fn a_table_from_standard_input_is_fitted_and_no_copy_of_it_stays() {
    let table = curve(&folder("piped-table"), "dry");
    let arguments = [&["fit", "-", "-p", "dry", "--free", "eta"][..], &ERRORS].concat();
    let (code, described, left) = piped("piped-fit", &arguments, &table);
    assert_eq!((code, left), (Some(0), 0), "{described}");
}

#[test]
fn an_experiment_comes_from_standard_input() {
    let preset = String::from_utf8(run(&["presets", "dry"]).stdout).unwrap();
    let good = file(&folder("piped-good"), "row.toml", &preset);
    let (code, described, _) = piped("piped-experiment", &["check", "-"], &good);
    assert_eq!(code, Some(0), "{described}");
    let bad = file(&folder("piped-bad"), "row.toml", &preset.replace("count = 40", "count = 0"));
    let (code, described, _) = piped("piped-mistake", &["check", "-"], &bad);
    assert_eq!(code, Some(2), "{described}");
    assert!(described.contains("standard input"), "{described}");
}

#[test]
#[cfg(unix)]
fn an_interrupted_campaign_ends_with_a_message_and_130() {
    let out = folder("interrupted").join("records");
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
    let program = program.args(["campaign", "--preset", "paper", "--out"]).arg(&out);
    let mut program = program.stderr(Stdio::piped()).spawn().unwrap();
    // The folder is made by the verb, so the handler is there; the preset takes minutes.
    while !out.exists() && program.try_wait().unwrap().is_none() {
        std::thread::yield_now();
    }
    let sent = Command::new("kill").args(["-INT", &program.id().to_string()]).status();
    assert!(sent.unwrap().success());
    let done = program.wait_with_output().unwrap();
    let reported = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(130), "{reported}");
    assert!(reported.contains("interrupted"), "{reported}");
}

#[test]
fn a_shot_that_takes_minutes_is_announced_with_its_steps() {
    let folder = folder("long");
    let preset = run(&["presets", "dry"]);
    let text = String::from_utf8(preset.stdout).unwrap();
    let text = text.replace("count = 40", "count = 20000");
    let row = file(&folder, "long.toml", &text);
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
    let shot = program.args(["shot", &row]).stderr(Stdio::piped());
    let mut child = shot.stdout(Stdio::null()).spawn().unwrap();
    let mut first = String::new();
    let reported = BufReader::new(child.stderr.take().unwrap()).read_line(&mut first);
    child.kill().unwrap();
    child.wait().unwrap();
    reported.unwrap();
    // 8 steps a bead, as long dry rows take.
    assert!(first.starts_with("This shot takes about 1.6e5 steps"), "{first}");
}
