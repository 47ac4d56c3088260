//! Result files: short numbers, names with the units that the numbers have.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const PLAIN: &str = "title = \"plain\"\nunits = \"dimensionless\"\n[striker]\nspeed = 1\n\
                     [[beads]]\ncount = 8\n[sensors]\nbead = 2\n[far_end]\nkind = \"half-bead\"\n";

/// Standard output of a run that must succeed.
fn good(arguments: &[&str]) -> String {
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
    let output = program.args(arguments).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// An empty folder of a test, with the dimensionless chain in it.
fn folder(name: &str) -> (PathBuf, String) {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    let file = path.join("plain.toml");
    fs::write(&file, PLAIN).unwrap();
    let file = file.to_str().unwrap().to_owned();
    (path, file)
}

/// All names in a JSON text.
fn keys(json: &Value) -> Vec<String> {
    match json {
        Value::Object(fields) => {
            let inner = fields.iter().flat_map(|(name, value)| {
                let mut all = keys(value);
                all.push(name.clone());
                all
            });
            inner.collect()
        }
        Value::Array(items) => items.iter().flat_map(keys).collect(),
        _ => Vec::new(),
    }
}

fn has_unit(name: &str) -> bool {
    let units = ["_s", "_m", "_m_s", "_n", "_j", "_per_s"];
    units.iter().any(|unit| name.ends_with(unit))
}

#[test]
fn results_of_a_dimensionless_chain_name_no_units() {
    let (out, file) = folder("plain-results");
    let path = out.to_str().unwrap();
    let shot = good(&["shot", &file, "--json", "--out", path, "--npy"]);
    let swept = good(&["sweep", &file, "--speeds", "0.5,1", "--json", "--out", path]);
    for text in [&shot, &swept] {
        let json: Value = serde_json::from_str(text).unwrap();
        let names = keys(&json);
        assert!(names.iter().any(|name| name == "tof_incident"), "{names:?}");
        let units: Vec<_> = names.iter().filter(|name| has_unit(name)).collect();
        assert!(units.is_empty(), "{units:?}");
    }
    let table = fs::read_to_string(out.join("sweep.csv")).unwrap();
    let names = "speed,tof_incident,tof_reflected,sensor_peak,wall_peak,returning_peak,\
                 striker_rebound,accuracy_reached,competing_time,competing_peak,\
                 competing_reflected_time,competing_reflected_peak\n";
    assert!(table.starts_with(names), "{table}");
    for name in ["time.npy", "position.npy", "velocity.npy", "force.npy"] {
        assert!(out.join(name).exists(), "{name}");
    }
}

#[test]
fn results_in_si_name_their_units() {
    let (out, _) = folder("si-results");
    let path = out.to_str().unwrap();
    let swept = good(&["sweep", "-p", "dry", "--speeds", "0.5,1", "--json", "--out", path]);
    let json: Value = serde_json::from_str(&swept).unwrap();
    assert!(json["points"][0]["tof_incident_s"].is_number());
    let table = fs::read_to_string(out.join("sweep.csv")).unwrap();
    assert!(table.starts_with("speed_m_s,tof_incident_s,tof_reflected_s,sensor_peak_n,"));
}

#[test]
fn tiny_numbers_have_an_exponent_and_every_number_is_short() {
    let (out, _) = folder("short-numbers");
    good(&["shot", "-p", "dry", "--out", out.to_str().unwrap()]);
    for file in ["traces.csv", "energy.csv"] {
        let text = fs::read_to_string(out.join(file)).unwrap();
        let cells: Vec<&str> = text.lines().skip(1).flat_map(|line| line.split(',')).collect();
        // A sign, seventeen digits, a point and an exponent.
        let longest = cells.iter().max_by_key(|cell| cell.len()).unwrap();
        assert!(longest.len() <= 24, "{file}: {longest}");
        assert!(cells.iter().all(|cell| cell.parse::<f64>().is_ok()), "{file}");
        assert!(cells.iter().any(|cell| cell.contains("e-")), "{file}");
    }
}

#[test]
fn traces_hold_no_numbers_below_the_solver_s_error() {
    let (out, _) = folder("floor");
    good(&["shot", "-p", "dry", "--out", out.to_str().unwrap()]);
    let text = fs::read_to_string(out.join("traces.csv")).unwrap();
    let forces: Vec<f64> = (text.lines().skip(1))
        .flat_map(|line| line.split(',').skip(1))
        .map(|cell| cell.parse().unwrap())
        .collect();
    let largest = forces.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
    let shot = good(&["shot", "-p", "dry", "--json"]);
    let shot: Value = serde_json::from_str(&shot).unwrap();
    let least = shot["tolerance"].as_f64().unwrap() * largest;
    let small = |force: &&f64| **force != 0.0 && force.abs() < least;
    assert_eq!(forces.iter().find(small), None);
    assert!(forces.contains(&0.0));
}

#[test]
fn what_was_understood_is_told_in_numbers() {
    let check: Value = serde_json::from_str(&good(&["check", "-p", "dry", "--json"])).unwrap();
    let groups = check["groups"].as_array().unwrap();
    let row = |title: &str, name: &str| -> Value {
        let group = groups.iter().find(|group| group["title"] == title).unwrap();
        let rows = group["rows"].as_array().unwrap();
        rows.iter().find(|row| row["name"] == name).unwrap()["value"].clone()
    };
    assert_eq!(row("Experiment", "sensor bead"), 7);
    assert_eq!(row("Beads", "number of beads N"), 40);
    let bead = row("Beads", "beads 1 to 40");
    assert_eq!(bead["radius_m"], 0.00635);
    assert_eq!(bead["young_modulus_pa"], 213e9);
    assert_eq!(bead["shear_viscosity_pa_s"], 3.2e4);
    assert_eq!(row("Ends", "far end")["kind"], "fixed half-bead");
    let (_, file) = folder("plain-check");
    let plain: Value = serde_json::from_str(&good(&["check", &file, "--json"])).unwrap();
    let units: Vec<_> = keys(&plain).into_iter().filter(|key| has_unit(key)).collect();
    assert!(units.is_empty(), "{units:?}");
}

#[test]
fn beads_are_counted_in_chains_without_units_too() {
    let (_, file) = folder("plain-words");
    let shot = good(&["shot", &file]);
    assert!(shot.contains(" beads per unit time"), "{shot}");
    let theory = good(&["theory", &file]);
    for (name, end) in [("speed ", " beads per unit time"), ("length ", " beads")] {
        let found = theory.lines().any(|line| line.trim().starts_with(name) && line.ends_with(end));
        assert!(found, "{name}: {theory}");
    }
}

#[test]
fn times_have_the_digits_of_the_accuracy_that_was_reached() {
    let printed = good(&["shot", "-p", "dry", "-a", "1e-13", "--check"]);
    let line = printed.lines().find(|line| line.contains("incident time")).unwrap();
    let number = line.split_whitespace().rev().nth(1).unwrap();
    // An integration with 80-bit numbers that ends its steps at changes of contacts tends to
    // 761.904023866 µs, to 1e-9 µs. No accuracy below 5e-13 is stated, which is eleven decimals.
    assert!(number.starts_with("761.90402386"), "{number}");
    assert!((12..=15).contains(&number.len()), "{number}");
}

#[test]
fn competing_maxima_and_a_wall_pulse_without_an_incident_one_are_in_tables_and_json() {
    let (out, file) = folder("competing");
    let written = |beads: u32, striker: f64| {
        let striker = format!("speed = 1\nmass = {striker:?}\n");
        let row = PLAIN.replace("speed = 1\n", &striker).replace("bead = 2", "bead = 1");
        fs::write(&file, row.replace("count = 8", &format!("count = {beads}"))).unwrap();
    };
    let json = |arguments: &[&str]| serde_json::from_str::<Value>(&good(arguments)).unwrap();
    // A striker of ten beads presses a single one until after the wall's maximum.
    written(1, 10.0);
    let sweep = ["sweep", &file, "--speeds", "1", "--json"];
    for passage in
        [&json(&["shot", &file, "--json"])["passage"], &json(&sweep)["points"][0]["passage"]]
    {
        assert!(passage["missing"].is_string(), "{passage}");
        // Half of 12.1736, when the striker lets go of a row that is elastic.
        let wall = passage["wall"]["time"].as_f64().unwrap();
        assert!((wall - 0.5 * 12.1736).abs() < 0.1, "{wall}");
    }
    // The train of a heavy one.
    written(3, 1000.0);
    let path = out.to_str().unwrap();
    let swept = json(&["sweep", &file, "--speeds", "1", "--json", "--out", path]);
    let competing = swept["points"][0]["passage"]["competing"].as_array().unwrap();
    for pulse in ["incident", "wall", "reflected"] {
        assert!(competing.iter().any(|other| other["pulse"] == pulse), "{pulse}");
    }
    let table = fs::read_to_string(out.join("sweep.csv")).unwrap();
    let last: Vec<&str> = table.lines().last().unwrap().rsplit(',').take(4).collect();
    assert!(last.iter().all(|cell| !cell.is_empty()), "{table}");
}
