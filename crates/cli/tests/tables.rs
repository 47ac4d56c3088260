//! Result files: short numbers, names with the units that the numbers have.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

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
                 striker_rebound,accuracy_reached\n";
    assert!(table.starts_with(names), "{table}");
    for name in ["time.npy", "position.npy", "velocity.npy", "force.npy"] {
        assert!(out.join(name).exists(), "{name}");
    }
}

#[test]
fn results_in_si_name_their_units() {
    let (out, _) = folder("si-results");
    let path = out.to_str().unwrap();
    let swept = good(&[
        "sweep", "-p", "dry", "--speeds", "0.5,1", "--json", "--out", path,
    ]);
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
        let cells: Vec<&str> = text
            .lines()
            .skip(1)
            .flat_map(|line| line.split(','))
            .collect();
        // A sign, seventeen digits, a point and an exponent.
        let longest = cells.iter().max_by_key(|cell| cell.len()).unwrap();
        assert!(longest.len() <= 24, "{file}: {longest}");
        assert!(
            cells.iter().all(|cell| cell.parse::<f64>().is_ok()),
            "{file}"
        );
        assert!(cells.iter().any(|cell| cell.contains("e-")), "{file}");
    }
}
