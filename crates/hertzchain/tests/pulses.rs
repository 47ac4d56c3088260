//! Whole pulses of recordings at the command line.

use crate::common::{compact, file, folder, json, refused, run};
use hertzchain_measure::records::{ReadOptions, read};
use std::fs;
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
    let message = refused(&["fit", &silent, "-m", &rig, "--case", "dry", "--free", "steel.eta"]);
    assert!(message.contains("no record is left"), "{message}");
    assert!(message.contains("was the sensor connected"), "{message}");
    let untitled = file(&folder, "untitled.csv", "0.5,7e-4,1e-7\n0.6,6.8e-4,1e-7\n");
    let message = refused(&["fit", &untitled, "-m", &rig, "--case", "dry", "--free", "steel.eta"]);
    assert!(message.contains("names its columns, speed_m_s"), "{message}");
}

/// Recordings as an oscilloscope writes them, with no speed of their own, and a table of shots: text
/// with a preamble, and an array of shots.
#[test]
fn recordings_without_a_speed_are_fitted_with_those_of_a_table_of_shots() {
    let folder = folder("pulses-of-a-table");
    let rig = file(&folder, "rig.toml", &compact());
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let records = path("records");
    assert!(run(&["campaign", &rig, "--out", &records]).status.success());
    let mut table = "file,shot,case,speed,speed error\n".to_owned();
    for series in fs::read_dir(&records).unwrap() {
        let series = series.unwrap().path();
        if series.extension().is_none_or(|ending| ending != "h5") {
            continue;
        }
        for record in read(&series, &ReadOptions::default()) {
            let record = record.unwrap();
            let volts = record.channels[0].volts.clone();
            let case = record.case.clone().unwrap();
            let number = table.lines().count();
            let (speed, error) = (record.speed_m_s.unwrap(), record.speed_error_m_s.unwrap());
            let name = match number % 2 {
                0 => format!("scope-{number}.csv"),
                _ => format!("array-{number}.npy"),
            };
            match number % 2 {
                0 => text(&folder.join("bare"), &name, &volts, record.interval_s),
                _ => array(&folder.join("bare"), &name, &volts),
            }
            table += &format!("{name},,{case},{speed},{error}\n");
        }
    }
    let shots = file(&folder, "shots.csv", &table);
    let fit_result = |more: &[&str]| {
        let begin = ["fit", "-m", &rig, "--case", "dry", "--free", "steel.eta,sensor_gain"];
        let end = ["--rate", "500kHz", "--json"];
        let words: Vec<&str> = begin.iter().chain(more).chain(&end).copied().collect();
        json(&words)
    };
    let bare = path("bare");
    let found = fit_result(&[&bare, "--shots", &shots]);
    // The file's own speeds, digit by digit, make the same fit as those of the table.
    let own = fit_result(&[&records]);
    assert_eq!(found["records"].as_array().unwrap().len(), 3);
    for at in [0, 1] {
        let [one, other] = [&found, &own].map(|fit| {
            let parameter = &fit["parameters"][at];
            ["value", "standard_error"].map(|key| parameter[key].as_f64().unwrap())
        });
        // Texts have nine digits, and the campaign's speeds are rounded nowhere.
        assert!((one[0] - other[0]).abs() < 1e-2 * other[1], "{one:?} {other:?}");
    }
    // One file alone, whose first line is an oscilloscope's and no title.
    let scope = fs::read_dir(&bare).unwrap().map(|entry| entry.unwrap().path());
    let scope = scope.filter(|path| path.extension().is_some_and(|e| e == "csv"));
    for scope in scope {
        let dry = table.lines().any(|line| {
            line.starts_with(scope.file_name().unwrap().to_str().unwrap()) && line.contains(",dry,")
        });
        if dry {
            let found = fit_result(&[scope.to_str().unwrap(), "--shots", &shots]);
            assert_eq!(found["records"].as_array().unwrap().len(), 1);
        }
    }
    let message = refused(&[
        "fit",
        &bare,
        "-m",
        &rig,
        "--case",
        "dry",
        "--free",
        "steel.eta",
        "--rate",
        "500kHz",
    ]);
    assert!(message.contains("no speed of the striker"), "{message}");
}

/// A text as an oscilloscope exports it.
fn text(folder: &Path, name: &str, volts: &[f64], interval_s: f64) {
    fs::create_dir_all(folder).unwrap();
    let mut text = format!("Model,TDS2024\nSample Interval,{interval_s:e}\nTIME,CH1\n");
    for (at, volt) in volts.iter().enumerate() {
        text += &format!("{:.6e},{volt:.9}\n", at as f64 * interval_s);
    }
    fs::write(folder.join(name), text).unwrap();
}

/// An NPY of one shot.
fn array(folder: &Path, name: &str, volts: &[f64]) {
    fs::create_dir_all(folder).unwrap();
    let about =
        format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},), }}", volts.len());
    let about = format!("{about:<117}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(about.len()).unwrap().to_le_bytes());
    bytes.extend(about.as_bytes());
    bytes.extend(volts.iter().flat_map(|volt| volt.to_le_bytes()));
    fs::write(folder.join(name), bytes).unwrap();
}
