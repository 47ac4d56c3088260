//! Sweeps that have little to tell say so.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

use serde_json::Value;
use std::process::{Command, Output};

fn sweep(arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
    program.arg("sweep").args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn two_speeds_give_a_power_law_without_errors() {
    let output = sweep(&["-p", "hertz", "--speeds", "0.5,1"]);
    let printed = text(&output.stdout);
    assert!(
        printed.contains("two speeds, which tell no errors"),
        "{printed}"
    );
    assert!(
        !printed.contains('±') && !printed.contains("R²"),
        "{printed}"
    );
    let output = sweep(&["-p", "hertz", "--speeds", "0.5,1", "--json"]);
    let swept: Value = serde_json::from_slice(&output.stdout).unwrap();
    let law = &swept["power_law_incident"];
    for key in [
        "prefactor_error_s",
        "exponent_error",
        "covariance",
        "r_squared",
    ] {
        assert!(law[key].is_null(), "{key}: {}", law[key]);
    }
    assert!(law["exponent"].is_number());
}

#[test]
fn a_sweep_in_json_says_why_it_has_no_energy_budget() {
    // One goes through the ensemble loop, the other through the wave loop.
    for more in [&[][..], &["--rebound"]] {
        let all = [&["-p", "dry", "--speeds", "0.5", "--json"], more].concat();
        let swept: Value = serde_json::from_slice(&sweep(&all).stdout).unwrap();
        let reason = swept["points"][0]["energy"]["missing"].as_str().unwrap();
        assert!(reason.contains("shot"), "{reason}");
    }
}

#[test]
fn a_sweep_without_a_shot_tells_why_and_prints_no_empty_table() {
    let output = sweep(&["-p", "pump", "--speeds", "1e-30,1e-29"]);
    assert_eq!(output.status.code(), Some(2));
    let (printed, told) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(printed, "");
    assert_eq!(told.matches("no shot at").count(), 2, "{told}");
}
