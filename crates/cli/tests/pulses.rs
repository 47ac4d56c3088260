//! Whole pulses of recordings at the command line.

use crate::common::{compact, file, folder, json, refused, run};
use std::path::Path;

#[test]
fn whole_pulses_of_a_campaign_give_back_what_its_rig_was_made_of() {
    let folder = folder("pulses");
    let rig = file(&folder, "rig.toml", &compact());
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let (records, out) = (path("records"), path("out"));
    assert!(run(&["campaign", &rig, "--out", &records]).status.success());
    let free = "steel.eta,sensor_gain";
    let fit = [
        "fit",
        &records,
        "-m",
        &rig,
        "--case",
        "dry",
        "--free",
        free,
        "--start",
        "steel.eta=2e4",
        "--json",
        "-o",
        &out,
    ];
    let found = json(&fit);
    assert_eq!(found["records"].as_array().unwrap().len(), 3);
    // 10 pC/N at 1 mV/pC.
    for (at, exact) in [3.2e4, 0.01].into_iter().enumerate() {
        let parameter = &found["parameters"][at];
        let value = parameter["value"].as_f64().unwrap();
        let sd = parameter["standard_error"].as_f64().unwrap();
        // Of a thousand seeds three would fail.
        assert!((value - exact).abs() < 3.0 * sd, "{parameter}");
        assert!(sd < 0.02 * exact, "{parameter}");
    }
    for name in ["pulses.csv", "pulses.png", "fit.json", "parameters.csv"] {
        assert!(Path::new(&out).join(name).exists(), "{name}");
    }
    // What is left out says why.
    let silent: String = (0..3000).map(|n| format!("{}e-6,0\n", n)).collect();
    let silent = file(&folder, "silent.csv", &format!("time_s,volts\n{silent}"));
    let message = refused(&[
        "fit",
        &silent,
        "-m",
        &rig,
        "--case",
        "dry",
        "--free",
        "steel.eta",
    ]);
    assert!(message.contains("no record is left"), "{message}");
    assert!(message.contains("was the sensor connected"), "{message}");
    let untitled = file(&folder, "untitled.csv", "0.5,7e-4,1e-7\n0.6,6.8e-4,1e-7\n");
    let message = refused(&[
        "fit",
        &untitled,
        "-m",
        &rig,
        "--case",
        "dry",
        "--free",
        "steel.eta",
    ]);
    assert!(
        message.contains("names its columns, speed_m_s"),
        "{message}"
    );
}
