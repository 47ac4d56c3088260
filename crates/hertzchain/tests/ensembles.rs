//! Sweeps by the ensemble loop, and the instruction set it uses.

use serde_json::Value;
use std::process::{Command, Output};

fn run(arguments: &[&str], set: &str) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
    program.env("HERTZCHAIN_INSTRUCTION_SET", set);
    program.args(arguments).output().unwrap()
}

fn printed(arguments: &[&str], set: &str) -> String {
    let output = run(arguments, set);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// Names after `available here` in the long version.
fn available() -> Vec<String> {
    let version = printed(&["--version", "--verbose"], "");
    let line = version.lines().find(|line| line.starts_with("available here"));
    let names = line.unwrap().trim_start_matches("available here").trim();
    names.split(", ").map(str::to_owned).collect()
}

#[test]
fn the_version_tells_the_instruction_set_in_use_and_those_to_choose_from() {
    let sets = available();
    for set in &sets {
        let version = printed(&["--version", "--verbose"], set);
        assert!(version.contains(&format!("instruction set  {set}\n")), "{version}");
    }
    assert_eq!(printed(&["--version"], ""), format!("hertzchain {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn an_instruction_set_that_is_not_there_is_a_users_mistake() {
    let output = run(&["sweep", "--preset", "hertz", "--speeds", "0.5,1"], "mmx");
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{errors}");
    for word in ["HERTZCHAIN_INSTRUCTION_SET", "`mmx`", available()[0].as_str()] {
        assert!(errors.contains(word), "{word} in {errors}");
    }
}

#[test]
fn every_instruction_set_gives_the_same_times_of_flight_to_rounding() {
    let arguments = ["sweep", "--preset", "dry", "--speeds", "0.1,0.5,1.2", "--json"];
    let times = |set: &str| -> Vec<f64> {
        let json: Value = serde_json::from_str(&printed(&arguments, set)).unwrap();
        let points = json["points"].as_array().unwrap().clone();
        let time = |point: &Value| point["tof_incident_s"].as_f64().unwrap();
        points.iter().map(time).collect()
    };
    let sets = available();
    let best = times(&sets[0]);
    for set in &sets[1..] {
        for (time, best) in times(set).iter().zip(&best) {
            // Roots of 42 bits against exact ones, over some thousand steps.
            assert!((time / best - 1.0).abs() < 1e-11, "{set}: {time} {best}");
        }
    }
}

#[test]
fn a_sweep_follows_the_striker_only_if_asked() {
    let arguments = ["sweep", "--preset", "dry", "--speeds", "0.5,1", "--rebound"];
    let followed = printed(&arguments, "");
    let quick = printed(&arguments[..5], "");
    assert!(followed.contains("rebound") && !quick.contains("rebound"));
}
