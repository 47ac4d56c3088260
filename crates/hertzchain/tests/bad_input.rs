//! Wrong files and arguments as a user meets them: one report each, exit code 2.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const DRY: &str = include_str!("../../../experiments/dry.toml");
const DIMENSIONLESS: &str =
    "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\ncount = 5\n";

fn run(arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
    program.args(arguments).output().unwrap()
}

fn reported(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn file(name: &str, text: impl AsRef<[u8]>) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bad-input");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path
}

/// What is reported when a file with this text is checked: one report, code 2.
fn one_report(name: &str, text: impl AsRef<[u8]>) -> String {
    let path = file(name, text);
    refused(&["check", path.to_str().unwrap()])
}

fn refused(arguments: &[&str]) -> String {
    let output = run(arguments);
    let message = reported(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    let reports = message.lines().filter(|line| is_report(line)).count();
    assert_eq!(reports, 1, "{message}");
    assert!(!message.contains("panicked"), "{message}");
    message
}

fn is_report(line: &str) -> bool {
    line.starts_with("  ×") || line.starts_with("error: ")
}

#[test]
fn a_second_table_is_one_report_that_underlines_both() {
    let twice = "\n[track]\nincline = \"1 deg\"\n".repeat(2);
    let message = one_report("twice.toml", format!("{DRY}{twice}"));
    assert!(message.contains("`[track]` stands here a second time"), "{message}");
    assert!(message.contains("the first one is here"), "{message}");
    assert_eq!(message.matches("┬").count(), 2, "{message}");
}

#[test]
fn overlapping_sections_are_one_report_that_underlines_both() {
    let sections = "[[contacts]]\nto = 9\nlaws = [\"elastic_hertz\"]\n[[contacts]]\nfrom = 5\n";
    let message = one_report("overlap.toml", DRY.replacen("[[contacts]]\n", sections, 1));
    assert!(message.contains("contacts 5 to 9 belong to two sections"), "{message}");
    assert_eq!(message.matches("┬").count(), 2, "{message}");
    assert!(message.contains("help: end the first section with `to = 4`"), "{message}");
}

#[test]
fn a_warning_is_underlined_like_a_mistake_and_ends_well() {
    let path = file("warned.toml", DRY.replace("ratio = 0.3", "ratio = 0.6"));
    let path = path.to_str().unwrap();
    for arguments in [
        &["check", path][..],
        &["theory", path],
        &["shot", path],
        &["sweep", path, "--speeds", "0.5,1"],
    ] {
        let output = run(arguments);
        let message = reported(&output);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {message}");
        for part in ["⚠ the Poisson ratio", "warned.toml:16:17", "┬", "above 1/2"] {
            assert!(message.contains(part), "{arguments:?}: {message} lacks {part}");
        }
    }
}

#[test]
fn what_the_physics_refuses_is_underlined_by_every_verb() {
    let track = "\n[track]\nincline = \"1 deg\"\n";
    let text = DRY.replacen("  \"elastic_hertz\",", "", 1) + track;
    let path = file("inelastic.toml", text);
    for verb in ["check", "theory", "shot", "sweep"] {
        let message = refused(&[verb, path.to_str().unwrap()]);
        assert!(message.contains("laws = ["), "{verb}: {message}");
        assert!(message.contains("add \"elastic_hertz\""), "{verb}: {message}");
    }
}

#[test]
fn numbers_that_no_body_has_are_underlined() {
    let message = one_report("soft.toml", DRY.replace("= \"213 GPa", "= \"1e-300 Pa"));
    assert!(message.contains("young_modulus = \"1e-300 Pa\""), "{message}");
    assert!(message.contains("from 1 Pa to 1e21 Pa"), "{message}");
}

#[test]
fn a_sweep_without_a_striker_points_at_what_is_there_instead() {
    let moved = "[[initial]]\nbead = 1\nvelocity = \"1 m/s\"";
    let text = DRY.replace("[striker]\nspeed = \"0.5 m/s\"", moved);
    let path = file("free.toml", text);
    let path = path.to_str().unwrap();
    for arguments in [&["sweep", path][..], &["shot", path, "--speed", "1"]] {
        let message = refused(arguments);
        assert!(message.contains("[[initial]]") && message.contains("─"), "{message}");
        assert!(message.contains("put a [striker]"), "{message}");
    }
}

#[test]
fn an_output_folder_that_is_a_file_is_called_one() {
    let path = file("in-the-way", "keep me");
    for verb in ["shot", "sweep", "reproduce", "man"] {
        let message = refused(&[verb, "--out", path.to_str().unwrap()]);
        assert!(message.contains("it is a file; --out names a folder"), "{message}");
    }
    assert_eq!(fs::read_to_string(path).unwrap(), "keep me");
    // A device is no folder either.
    if cfg!(unix) {
        let message = refused(&["reproduce", "--out", "/dev/null"]);
        assert!(message.contains("it is a file"), "{message}");
    }
}

#[test]
fn a_dimensionless_experiment_takes_plain_numbers_only() {
    let path = file("plain.toml", DIMENSIONLESS);
    let path = path.to_str().unwrap();
    for arguments in [
        &["shot", path, "--speed", "1 m/s"][..],
        &["check", path, "--speed", "1 m/s"],
        &["theory", path, "--speed", "1 m/s"],
        &["shot", path, "--duration", "1 ms"],
        &["shot", path, "--solver", "rk4", "--step", "1 us"],
        &["sweep", path, "--speeds", "0.1,1 m/s"],
        &["sweep", path, "--speeds", "log:0.1 m/s:1:3"],
    ] {
        let message = refused(arguments);
        assert!(message.contains("dimensionless; expected a plain number"), "{message}");
    }
    for arguments in [
        &["shot", path, "--speed", "2", "--duration", "5"][..],
        &["sweep", path, "--speeds", "log:0.5:2:3"],
    ] {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", reported(&output));
    }
}

#[test]
fn times_of_an_si_experiment_have_units_and_plain_speeds_are_in_metres_a_second() {
    for arguments in [
        &["shot", "--duration", "0.002"][..],
        &["shot", "--solver", "rk4", "--step", "1e-6"],
        &["sweep", "--duration", "2"],
    ] {
        let message = refused(arguments);
        assert!(message.contains("has no unit"), "{message}");
    }
    let endless = refused(&["shot", "--duration", "1e9 s"]);
    assert!(endless.contains("expected at most") && endless.contains("billion"), "{endless}");
    let comma = refused(&["shot", "--duration", "0,002 s"]);
    assert!(comma.contains("write 0.002 s; expected a time"), "{comma}");
    let of =
        |speed: &str| run(&["shot", "--speed", speed, "--duration", "0.1 ms", "--json"]).stdout;
    assert!(!of("0.5").is_empty());
    assert_eq!(of("0.5"), of("500 mm/s"));
    let help = run(&["shot", "--help"]).stdout;
    assert!(String::from_utf8(help).unwrap().contains("a plain number is in m/s"));
}

#[test]
fn hundreds_of_mistakes_are_told_twenty_at_a_time() {
    let gaps: String = (0..500).map(|i| format!("\n[[gaps]]\ncontact = {i}\ngap = 1\n")).collect();
    let path = file("many.toml", format!("{DRY}{gaps}"));
    let output = run(&["check", path.to_str().unwrap()]);
    let message = reported(&output);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(message.lines().filter(|line| is_report(line)).count(), 20);
    assert!(message.ends_with("… and 480 more mistakes\n"), "{message}");
}

#[test]
fn endless_lines_are_told_in_one() {
    let key = "k".repeat(1_000_000);
    let unit = "m".repeat(1_000_000);
    let deep = format!("a{} = 1\n", ".a".repeat(50_000));
    for (name, text) in [
        ("key.toml", format!("{DRY}\n{key} = 1\n")),
        ("unit.toml", DRY.replace("= \"6.35 mm", &format!("= \"6 {unit}"))),
        ("deep.toml", deep),
    ] {
        let message = one_report(name, text);
        assert!(message.len() < 2000, "{name}: {} letters", message.len());
        assert!(message.contains(name), "{message}");
    }
}

#[test]
fn what_is_no_text_is_said_to_be_none() {
    let wide: Vec<u8> =
        (std::iter::once(0xFEFF).chain(DRY.encode_utf16())).flat_map(u16::to_le_bytes).collect();
    assert!(one_report("wide.toml", wide).contains("UTF-16"));
    assert!(one_report("empty.toml", "").contains("hertzchain presets dry"));
    assert!(one_report("zero.toml", b"a = 1\0").contains("zero bytes"));
    let folder = env!("CARGO_TARGET_TMPDIR");
    assert!(refused(&["check", folder]).contains("it is a folder"));
}
