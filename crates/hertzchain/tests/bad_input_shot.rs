//! Files with which no shot comes to a sensible end: every verb refuses them
//! before anything runs, with one report that underlines the place, code 2.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const DRY: &str = include_str!("../../../experiments/dry.toml");

fn run(arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
    program.args(arguments).output().unwrap()
}

fn reported(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn file(name: &str, text: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bad-input-shot");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path
}

/// One report from every verb, with its place, the marked text and words.
fn every_verb_refuses(name: &str, text: &str, marked: &str, words: &[&str]) {
    let path = file(name, text);
    let path = path.to_str().unwrap();
    for verb in ["check", "theory", "shot"] {
        let output = run(&[verb, path]);
        let message = reported(&output);
        assert_eq!(output.status.code(), Some(2), "{verb} {name}: {message}");
        let reports = message.lines().filter(|line| line.starts_with("  ×"));
        assert_eq!(reports.count(), 1, "{verb}: {message}");
        assert!(!message.contains("error: "), "{verb}: {message}");
        for part in [name, marked, "─"].iter().chain(words) {
            assert!(message.contains(part), "{verb}: {message} lacks {part}");
        }
    }
}

fn solver(keys: &str) -> String {
    format!("{DRY}\n[solver]\n{keys}\n")
}

#[test]
fn steps_and_durations_without_sense_are_underlined() {
    for (name, keys, marked, words) in [
        (
            "long-step.toml",
            "method = \"rk4\"\nstep = \"1 s\"",
            "step = \"1 s\"",
            ["longer than a contact lasts", "is sensible"],
        ),
        (
            "short-step.toml",
            "method = \"verlet\"\nstep = \"1e-15 s\"",
            "step = \"1e-15 s\"",
            ["steps of 1e-15 s", "expected at least"],
        ),
        (
            "endless.toml",
            "duration = \"1e9 s\"",
            "duration = \"1e9 s\"",
            ["takes some 6.7e14 steps", "at most 1500 s"],
        ),
    ] {
        every_verb_refuses(name, &solver(keys), marked, &words);
    }
}

#[test]
fn numbers_with_which_nothing_moves_are_underlined() {
    for (name, from, to, words) in [
        (
            "cubic.toml",
            "77 kg s/m^2",
            "1e20 kg s/m^2",
            ["law `damping_cubic` is 7e16 times as strong", "1400 kg s/m^2"],
        ),
        (
            "viscous.toml",
            "3.2e4 Pa s",
            "1e24 Pa s",
            ["law `damping_viscoelastic` is 1.1e18 times as strong", "viscosities"],
        ),
        ("fast.toml", "0.5 m/s", "1e5 m/s", ["overlap by", "more than a bead's radius"]),
    ] {
        every_verb_refuses(name, &DRY.replace(from, to), to, &words);
    }
}

#[test]
fn bead_0_is_told_from_where_beads_are_counted() {
    let text = DRY.replace("bead = 7", "bead = 0");
    let words = ["from 1 to 40", "beads are counted from 1"];
    every_verb_refuses("bead-0.toml", &text, "bead = 0", &words);
}

#[test]
fn a_law_out_of_its_range_is_a_warning_beside_the_results() {
    let path = file("deep.toml", &DRY.replace("0.5 m/s", "60 m/s"));
    let path = path.to_str().unwrap();
    for verb in ["check", "theory", "shot"] {
        let output = run(&[verb, path]);
        let message = reported(&output);
        assert_eq!(output.status.code(), Some(0), "{verb}: {message}");
        for part in ["⚠ two bodies", "speed = \"60 m/s\"", "of their reduced radius", "validity"]
        {
            assert!(message.contains(part), "{verb}: {message} lacks {part}");
        }
    }
}

#[test]
fn a_solver_that_does_not_get_there_is_told_where_it_was_chosen() {
    let solver = "\n[solver]\nmethod = \"rk4\"\naccuracy = 1e-13\n";
    let path = file("slow.toml", &format!("{DRY}{solver}"));
    let chosen_in_file = run(&["shot", path.to_str().unwrap()]);
    let line = ["shot", "--preset", "dry", "--solver", "rk4", "--accuracy", "1e-13"];
    let chosen_on_the_line = run(&line);
    for (output, place) in [(chosen_in_file, true), (chosen_on_the_line, false)] {
        assert_eq!(output.status.code(), Some(2));
        let message = reported(&output);
        assert!(message.contains("use the adaptive solver"), "{message}");
        assert_eq!(message.contains("[solver]"), place, "{message}");
    }
}

#[test]
fn a_speed_of_the_command_line_is_refused_there_and_not_in_the_file() {
    for verb in ["check", "theory", "shot"] {
        for (speed, words) in [
            ("1e9", "expected a positive, finite speed, from 1e-12 m/s to 1e6 m/s"),
            ("1e5 m/s", "more than a bead's radius"),
        ] {
            let output = run(&[verb, "--preset", "dry", "--speed", speed]);
            let message = reported(&output);
            assert_eq!(output.status.code(), Some(2), "{verb}: {message}");
            let option = format!("error: --speed {speed}: ");
            assert!(message.starts_with(&option), "{verb}: {message}");
            assert!(message.contains(words), "{verb}: {message}");
            assert!(!message.contains("dry.toml"), "{verb}: {message}");
        }
        let output = run(&[verb, "--preset", "hertz", "--speed", "60"]);
        let message = reported(&output);
        assert_eq!(output.status.code(), Some(0), "{verb}: {message}");
        assert!(message.contains("warning: --speed 60: two bodies"), "{verb}: {message}");
    }
    let message = reported(&run(&["sweep", "-p", "dry", "--speeds", "1e9"]));
    assert!(message.contains("no shot at 1e9 m/s: a shot at"), "{message}");
}
