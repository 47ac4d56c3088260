//! Sweeps that have little to determine say so.

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
    assert!(printed.contains("two speeds, which determine no errors"), "{printed}");
    assert!(!printed.contains('±') && !printed.contains("R²"), "{printed}");
    let output = sweep(&["-p", "hertz", "--speeds", "0.5,1", "--json"]);
    let swept: Value = serde_json::from_slice(&output.stdout).unwrap();
    let law = &swept["power_law_incident"];
    for key in ["prefactor_error_s", "exponent_error", "covariance", "r_squared"] {
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
    let (printed, reported) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(printed, "");
    assert_eq!(reported.matches("no shot at").count(), 2, "{reported}");
}

#[test]
fn a_fit_ends_where_its_errors_do_and_has_none_below_the_accuracy_of_the_times() {
    let arguments = ["-p", "dry", "--speeds", "log:0.1:1:5", "-a", "1e-4"];
    let printed = text(&sweep(&arguments).stdout);
    // Standard errors of 3.5 µs and 0.0036, far above the accuracy.
    assert!(
        printed.contains("ToF = (676.4 ± 3.5) µs") && printed.contains("^(-0.1794 ± 0.0036)"),
        "{printed}"
    );
    assert!(printed.contains("R² = 0.9988,"), "{printed}");
    let hertz = ["-p", "hertz", "--speeds", "log:0.1:1:5", "--json"];
    let swept: Value = serde_json::from_slice(&sweep(&hertz).stdout).unwrap();
    let law = &swept["power_law_incident"];
    let of = |key: &str| law[key].as_f64().unwrap();
    // A perfect power law: what scatters is far less than what is not known.
    assert!(of("prefactor_error_s") < of("prefactor_accuracy_s"), "{law}");
    let reached = (swept["points"].as_array().unwrap().iter())
        .map(|point| point["accuracy_reached"].as_f64().unwrap());
    let least = reached.fold(f64::INFINITY, f64::min);
    assert!(of("prefactor_accuracy_s") >= least * of("prefactor_s"), "{law}");
    assert!(of("exponent_accuracy") > 0.0, "{law}");
    let printed = text(&sweep(&hertz[..4]).stdout);
    // The same as in JSON, in µs to two digits.
    let error = 1e6 * of("prefactor_accuracy_s");
    let reported = format!("ToF = (630.84158 ± {error:.5}) µs");
    assert!(printed.contains(&reported), "{reported}: {printed}");
}

#[test]
fn a_sweep_of_a_chain_without_a_wall_tells_what_a_shot_tells() {
    for preset in ["newtons-cradle", "heavy-striker"] {
        let output = sweep(&["-p", preset, "--speeds", "0.25,0.5"]);
        let printed = text(&output.stdout);
        assert!(printed.contains("No times of flight: the chain has no wall."), "{printed}");
        assert!(!printed.contains("ToF"), "{printed}");
        let arguments = ["-p", preset, "--speeds", "0.25,0.5", "--json"];
        let swept: Value = serde_json::from_slice(&sweep(&arguments).stdout).unwrap();
        let point = &swept["points"][1];
        assert_eq!(point["passage"]["missing"], "the chain has no wall");
        let maxima = point["sensor_maxima"].as_array().unwrap();
        let largest = (maxima.iter().filter_map(|peak| peak["value"].as_f64())).fold(0.0, f64::max);
        // Five digits in the table.
        let peak = format!("{largest:.4}");
        assert!(largest > 0.0 && printed.contains(&peak[..5]), "{peak}: {printed}");
    }
}

#[test]
fn threads_are_counted_from_1() {
    for count in ["0", "-3", "many", "1e9"] {
        let output = sweep(&["--threads", count]);
        assert_eq!(output.status.code(), Some(2));
        let reported = text(&output.stderr);
        assert!(reported.contains("expected a whole number from 1 to 1024"), "{reported}");
    }
}

#[test]
fn a_calibrated_sweep_says_so() {
    let speeds = ["-p", "hertz", "-a", "1e-3", "--speeds", "0.1:1:200"];
    let printed = text(&sweep(&speeds).stdout);
    assert!(printed.contains("chosen by 48 calibration shots"), "{printed}");
    let each = [&speeds[..], &["--json", "--error-control", "per-shot"]].concat();
    let swept: Value = serde_json::from_slice(&sweep(&each).stdout).unwrap();
    assert!(swept["calibration"].is_null());
    assert_eq!(swept["error_control"], "per shot: as asked");
}

#[test]
fn a_return_that_was_not_waited_for_is_none() {
    let reflected = |duration: &str| {
        let all = ["-p", "dry", "--speeds", "0.5,1", "--duration", duration];
        let output = sweep(&all);
        assert!(text(&output.stderr).contains("2 of 2 shots end before"), "{output:?}");
        let swept: Value =
            serde_json::from_slice(&sweep(&[&all[..], &["--json"]].concat()).stdout).unwrap();
        swept["points"][0]["tof_reflected_s"].clone()
    };
    // The wall's peak is at 0.925 ms; rattling of the sensor bead has maxima from 1.1 ms on.
    assert!(reflected("1.2ms").is_null());
    let known = reflected("2.2ms").as_f64().unwrap();
    assert!((known - 797.884e-6).abs() < 1e-8, "{known}");
}

#[test]
fn a_speed_that_is_given_twice_is_one_point_of_a_power_law() {
    let printed = text(&sweep(&["-p", "hertz", "--speeds", "0.5,1,0.5"]).stdout);
    assert!(printed.contains("two speeds, which determine no errors"), "{printed}");
    let reported = sweep(&["-p", "hertz", "--speeds", "1", "--check", "--error-control", "none"]);
    assert!(text(&reported.stderr).contains("nothing to compare with"), "{reported:?}");
}
