//! From files of volts to times of flight, in one command.

use hertzchain::inference;
use hertzchain::options::{CurveOptions, MeasureOptions};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn measure(folder: &Path, arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
    let program = program.current_dir(folder).arg("measure").args(arguments);
    program.output().unwrap()
}

fn json(output: &Output) -> Value {
    let reported = String::from_utf8_lossy(&output.stderr);
    serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|error| unreachable!("{error}: {reported}"))
}

fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("measure-{test}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Incident time of flight in µs at a speed: a Hertz chain's power.
fn incident_us(speed_m_s: f64) -> f64 {
    630.0 * speed_m_s.powf(-0.2)
}

/// Samples at 1 MS/s: three bells and a ripple in place of noise.
pub(crate) fn volts(speed_m_s: f64, wet: f64) -> Vec<f64> {
    let incident = wet * incident_us(speed_m_s);
    let bell = |at: f64, i: f64| ((i - at) / 35.0).cosh().powi(-4);
    let sample = |i: f64| {
        let pulses = bell(500.0, i) + 1.6 * bell(500.0 + incident, i);
        pulses + 0.4 * bell(500.0 + 2.01 * incident, i) + 1e-3 * (1.7 * i).sin()
    };
    (0..4000).map(|i| sample(f64::from(i))).collect()
}

/// A file as a European oscilloscope exports it.
pub(crate) fn write(path: &Path, volts: &[f64]) {
    let mut text = "Gerät;XY 1\n\nZeit (µs);Kanal A (V)\n".to_owned();
    for (i, volt) in volts.iter().enumerate() {
        text += &format!("{i},0;{volt:.6}\n").replace('.', ",");
    }
    fs::write(path, text).unwrap();
}

const SPEEDS: [f64; 3] = [0.2, 0.5, 1.0];

/// Dry and wet shots at three speeds, and the table that determines them.
fn shots(folder: &Path) {
    let mut list = "file,case,speed,speed error\n".to_owned();
    for (case, wet) in [("dry", 1.0), ("gear", 0.98)] {
        for (number, speed) in SPEEDS.iter().enumerate() {
            let name = format!("{case}-{number}.csv");
            write(&folder.join(&name), &volts(*speed, wet));
            list += &format!("{name},{case},{speed},0.001\n");
        }
    }
    fs::write(folder.join("list.txt"), list).unwrap();
}

#[test]
fn one_command_gives_a_time_of_flight_from_a_file_of_volts() {
    let folder = folder("one");
    write(&folder.join("shot.csv"), &volts(0.5, 1.0));
    let output = measure(&folder, &["shot.csv", "--json"]);
    assert_eq!(output.status.code(), Some(0));
    let shot = &json(&output)["shots"][0];
    let found = shot["tof_incident_s"]["value"].as_f64().unwrap();
    // The ripple of 1e-3 moves each of two tops by some 1e-3 of a width of 42 µs.
    assert!((found - 1e-6 * incident_us(0.5)).abs() < 1e-7, "{found}");
    assert_eq!(shot["flags"].as_array().unwrap().len(), 0, "{shot}");
    let again = measure(&folder, &["shot.csv", "./shot.csv", ".", "--json"]);
    assert_eq!(json(&again)["shots"].as_array().unwrap().len(), 1);
    assert!(String::from_utf8_lossy(&again.stderr).contains("given twice, measured once"));
}

#[test]
fn voltages_are_in_volts_whatever_the_file_has() {
    let folder = folder("millivolts");
    let rows = volts(0.5, 1.0).into_iter().enumerate();
    let rows: String = rows.map(|(i, volt)| format!("{i},{:.4}\n", 1e3 * volt)).collect();
    fs::write(folder.join("shot.csv"), format!("Time (us),CH1 (mV)\n{rows}")).unwrap();
    let shot = &json(&measure(&folder, &["shot.csv", "--json"]))["shots"][0];
    let found = shot["incident"]["height_v"].as_f64().unwrap();
    assert!((found - 1.0).abs() < 0.01, "{found}");
}

#[test]
fn speeds_from_a_table_give_curves_power_laws_and_ratios() {
    let folder = folder("curves");
    shots(&folder);
    let output = measure(&folder, &[".", "--shots", "list.txt", "--json", "--out", "out"]);
    // The table of shots lies in the same folder and is no recording.
    assert_eq!(output.status.code(), Some(0));
    let all = json(&output);
    let law = &all["cases"][0]["power_law_incident"];
    // As above, over a factor 5 in speed.
    assert!((law["exponent"].as_f64().unwrap() + 0.2).abs() < 2e-4, "{law}");
    let ratios = all["ratios"][0]["incident"].as_array().unwrap();
    assert_eq!(ratios.len(), 3);
    for ratio in ratios {
        assert!((ratio["ratio"].as_f64().unwrap() - 0.98).abs() < 3e-4, "{ratio}");
    }
    for name in [
        "shots.csv",
        "speeds.csv",
        "ratios.csv",
        "measured.json",
        "signals.svg",
        "times-of-flight.png",
        "ratios.png",
    ] {
        assert!(folder.join("out").join(name).exists(), "{name}");
    }
    let table = fs::read_to_string(folder.join("out/speeds.csv")).unwrap();
    let mut lines = table.lines().map(|line| line.split(',').count());
    let titles = lines.next().unwrap();
    assert!(lines.all(|cells| cells == titles), "{table}");
}

#[test]
fn a_bad_record_is_told_and_the_good_ones_are_measured() {
    let folder = folder("bad");
    write(&folder.join("good.csv"), &volts(0.5, 1.0));
    fs::write(folder.join("empty.csv"), "").unwrap();
    fs::write(folder.join("lie.npy"), "1,2\n").unwrap();
    let output = measure(&folder, &["empty.csv", "good.csv", "lie.npy"]);
    assert_eq!(output.status.code(), Some(2));
    let reported = String::from_utf8_lossy(&output.stderr);
    assert_eq!(reported.matches("refused: ").count(), 2, "{reported}");
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(printed.contains("723."), "{printed}");
}

#[test]
fn a_file_without_a_rate_asks_for_it_and_takes_it() {
    let folder = folder("rate");
    let column: String = volts(0.5, 1.0).iter().map(|v| format!("{v:.6}\n")).collect();
    fs::write(folder.join("column.txt"), column).unwrap();
    let asked = measure(&folder, &["column.txt"]);
    assert!(String::from_utf8_lossy(&asked.stderr).contains("--rate"));
    let given = measure(&folder, &["column.txt", "--rate", "1MS/s"]);
    assert_eq!(given.status.code(), Some(0));
}

#[test]
fn times_of_few_digits_are_told_once_and_a_rate_ends_it() {
    let folder = folder("digits");
    for name in ["one.csv", "two.csv"] {
        let rows = volts(0.5, 1.0).into_iter().enumerate();
        // No sample at a tie of rounding, which would determine more.
        let time_s = |i: usize| (i as f64 - 400.0) * 1e-6 + 0.3e-6;
        let rows: String = rows.map(|(i, v)| format!("{:.5},{v:.6}\n", time_s(i))).collect();
        fs::write(folder.join(name), format!("Time (s),Volts\n{rows}")).unwrap();
    }
    let reported = |more: &[&str]| {
        let output = measure(&folder, &[&["one.csv", "two.csv"], more].concat());
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let open = reported(&[]);
    assert_eq!(open.matches("times are even only to 10 µs").count(), 1, "{open}");
    assert!(open.contains("--rate"), "{open}");
    assert_eq!(reported(&["--rate", "1MHz", "--low-pass", "0"]), "");
}

#[test]
fn a_lost_passing_pulse_counts_in_no_mean() {
    let folder = folder("lost");
    let mut list = "file,case,speed,speed error\n".to_owned();
    for number in 0..3 {
        let mut all = volts(0.5, 1.0);
        if number == 2 {
            all.iter_mut().take(700).for_each(|volt| *volt *= 1e-3);
        }
        write(&folder.join(format!("{number}.csv")), &all);
        list += &format!("{number}.csv,dry,0.5,0.001\n");
    }
    fs::write(folder.join("list.txt"), list).unwrap();
    let files = ["0.csv", "1.csv", "2.csv", "--shots", "list.txt", "--json"];
    let found = json(&measure(&folder, &files));
    let row = &found["cases"][0]["speeds"][0];
    assert_eq!((&row["shots"], &row["left_out"]), (&2.into(), &1.into()), "{found}");
    let named =
        json(&measure(&folder, &[&files[..], &["--beads", "40", "--sensor", "7"]].concat()));
    assert_eq!(named["shots"][2]["flags"][0], "incident pulse missing", "{named}");
    assert!(named["shots"][2]["missing"].is_string());
}

#[test]
fn every_method_agrees_on_pulses_of_one_shape() {
    let folder = folder("methods");
    write(&folder.join("shot.csv"), &volts(0.5, 1.0));
    for method in ["local", "onset", "correlation", "shape"] {
        let output = measure(&folder, &["shot.csv", "--method", method, "--json"]);
        let found = &json(&output)["shots"][0]["tof_incident_s"]["value"];
        let found = found.as_f64().unwrap();
        // The ripple; onsets lie on the flank, where it counts as for tops.
        assert!((found - 1e-6 * incident_us(0.5)).abs() < 1e-7, "{method}: {found}");
    }
}

/// Two columns, and what of them is reported on standard error.
fn told_of_two_columns(folder: &Path, arguments: &[&str]) -> String {
    let rows = volts(0.5, 1.0);
    let rows = rows.iter().enumerate().map(|(i, v)| format!("{i},{v:.6}\n"));
    let text = "t,sum\n".to_owned() + &rows.collect::<String>();
    fs::write(folder.join("two.csv"), text).unwrap();
    let output = measure(folder, &[&["two.csv"], arguments].concat());
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn calibrated_sensors_state_forces_and_the_wall_channels_delay_is_taken_out() {
    let folder = folder("calibrated");
    // The wall's pulse is half-way between the others.
    let wall_us = 500.0 + incident_us(0.5);
    let rows = volts(0.5, 1.0).into_iter().enumerate().map(|(i, volt)| {
        let is_wall = (i as f64 - wall_us).abs() < 0.5 * incident_us(0.5);
        let ripple = 1e-3 * (2.9 * i as f64).sin();
        let [sensor, wall] = if is_wall { [ripple, volt] } else { [volt, ripple] };
        format!("{i},{sensor:.6},{wall:.6}\n")
    });
    let text = "t (us),sensor,wall\n".to_owned() + &rows.collect::<String>();
    fs::write(folder.join("pair.csv"), text).unwrap();
    let shot = |arguments: &[&str]| {
        let both = ["pair.csv", "--channel", "sensor", "--channel", "wall", "--json"];
        json(&measure(&folder, &[&both, arguments].concat()))["shots"][0].clone()
    };
    let plain = shot(&[]);
    let options = ["--skew", "-3us", "--sensitivity", "20mV/N", "--wall-sensitivity", "0.04V/N"];
    let found = shot(&options);
    let of = |shot: &Value, name: &str| shot[name]["value"].as_f64().unwrap();
    let moved = of(&found, "tof_incident_s") - of(&plain, "tof_incident_s");
    // Rounding.
    assert!((moved - 3e-6).abs() < 1e-12, "{moved:e}");
    let share = of(&found, "wall_over_incident") / of(&plain, "wall_over_incident");
    assert!((share - 0.5).abs() < 1e-12, "{share}");
    let height_n = found["incident"]["height_n"].as_f64().unwrap();
    let expected_n = plain["incident"]["height_v"].as_f64().unwrap() / 0.02;
    assert!((height_n / expected_n - 1.0).abs() < 1e-12, "{height_n} {expected_n}");
    assert!(plain["wall"]["height_n"].is_null());
    let summed = measure(&folder, &["pair.csv", "--channel", "sensor", "--skew", "1us"]);
    let reported = String::from_utf8_lossy(&summed.stderr).into_owned();
    assert!(reported.contains("name the two channels"), "{reported}");
}

#[test]
fn a_time_without_a_unit_is_told_and_a_unit_can_be_given() {
    let folder = folder("unit");
    let reported = told_of_two_columns(&folder, &[]);
    assert!(
        reported.contains("taken as times in s") && reported.contains("--time-unit us"),
        "{reported}"
    );
    let output = measure(&folder, &["two.csv", "--time-unit", "us", "--json"]);
    let found = &json(&output)["shots"][0]["tof_incident_s"]["value"];
    assert!((found.as_f64().unwrap() - 1e-6 * incident_us(0.5)).abs() < 1e-7);
    let stated = ["--time-unit", "us", "--low-pass", "0"];
    assert_eq!(told_of_two_columns(&folder, &stated), "");
}

#[test]
fn a_continuous_recording_is_cut_and_the_cut_is_told() {
    let folder = folder("continuous");
    let shot = volts(0.5, 1.0);
    let all = [shot.as_slice(), &vec![0.0; 40_000], &shot, &vec![0.0; 40_000]].concat();
    write(&folder.join("long.csv"), &all);
    let output = measure(&folder, &["long.csv", "--json"]);
    assert_eq!(output.status.code(), Some(0));
    let all = json(&output);
    assert_eq!(all["shots"].as_array().unwrap().len(), 2);
    assert!(all["notes"][0]["note"].as_str().unwrap().contains("--whole"));
    let level = measure(&folder, &["long.csv", "--level", "0.3", "--json"]);
    assert_eq!(json(&level)["shots"].as_array().unwrap().len(), 2);
    let never = measure(&folder, &["long.csv", "--level", "-7"]);
    let reported = String::from_utf8_lossy(&never.stderr).into_owned();
    assert!(reported.contains("never passes the level of -7 V"), "{reported}");
    assert_eq!(never.status.code(), Some(2));
}

#[test]
fn three_channels_of_a_shot_are_one_too_many() {
    let folder = folder("three");
    let reported =
        told_of_two_columns(&folder, &["--channel", "1", "--channel", "1", "--channel", "1"]);
    assert!(reported.contains("at most two channels"), "{reported}");
}

#[test]
fn force_removes_what_the_earlier_run_had_and_nothing_of_others() {
    let folder = folder("force");
    write(&folder.join("shot.csv"), &volts(0.5, 1.0));
    let out = folder.join("out");
    fs::create_dir_all(&out).unwrap();
    let run = || measure(&folder, &["shot.csv", "--out", "out", "--force"]).status.code();
    // A table of another verb's: no measurement was here before.
    fs::write(out.join("ratios.csv"), "of others").unwrap();
    assert_eq!(run(), Some(0));
    assert!(out.join("ratios.csv").exists() && out.join("measured.json").exists());
    assert_eq!(run(), Some(0));
    assert!(!out.join("ratios.csv").exists() && out.join("signals.svg").exists());
}

#[test]
fn options_that_would_have_no_effect_are_refused() {
    let folder = folder("idle");
    let cases: [(&[&str], &str); 3] = [
        (&["--channel", "2", "--channel", "2"], "--channel 2 twice"),
        (&["--onset", "0.1"], "--onset is of --method onset"),
        (&["--wall-polarity", "negative"], "none where one channel sums both sensors"),
    ];
    for (options, expected) in cases {
        let reported = told_of_two_columns(&folder, options);
        assert!(reported.contains(expected), "{options:?}: {reported}");
    }
}

#[test]
fn lines_of_the_table_that_fit_no_record_are_told() {
    let folder = folder("unmatched");
    write(&folder.join("shot, 1.csv"), &volts(0.5, 1.0));
    let list = "file,speed\n\"shot, 1.csv\",0.5\nshot-2.csv,0.7\n";
    fs::write(folder.join("list.csv"), list).unwrap();
    let output = measure(&folder, &["shot, 1.csv", "--shots", "list.csv"]);
    let reported = String::from_utf8_lossy(&output.stderr);
    let expected = "line 3: shot-2.csv is none of the files given (shot, 1.csv)";
    assert!(reported.contains(expected), "{reported}");
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn shots_that_are_the_same_have_no_spread_of_rounding() {
    let folder = folder("same");
    let mut list = "file,speed,speed error\n".to_owned();
    for (number, speed) in [0.5, 0.5, 0.7, 0.7, 0.9].iter().enumerate() {
        write(&folder.join(format!("{number}.csv")), &volts(0.5, 1.0));
        list += &format!("{number}.csv,{speed},0.001\n");
    }
    fs::write(folder.join("list.txt"), list).unwrap();
    let output = measure(&folder, &[".", "--shots", "list.txt"]);
    let printed = String::from_utf8_lossy(&output.stdout);
    // Equal times have no spread: what is reported of their means is what shots share, which is less
    // than the error of one.
    let spreads = printed.lines().filter(|line| line.contains("  0  "));
    assert_eq!(spreads.count(), 2, "{printed}");
    assert!(!printed.contains(" ± 0 "), "{printed}");
    // The fit has the errors of the picks.
    let fits = printed.lines().filter(|line| line.contains("v^("));
    assert_eq!(fits.filter(|line| !line.contains("e-1")).count(), 2);
}

#[test]
fn an_odd_unit_of_times_is_named_and_not_called_absent() {
    let folder = folder("shakes");
    let rows = volts(0.5, 1.0);
    let rows = rows.iter().enumerate().map(|(i, v)| format!("{i},{v:.6}\n"));
    let text = "Time (shakes),sum\n".to_owned() + &rows.collect::<String>();
    fs::write(folder.join("odd.csv"), text).unwrap();
    let refused = measure(&folder, &["odd.csv"]);
    let reported = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2));
    assert!(reported.contains("shakes") && reported.contains("--time-unit"), "{reported}");
    let given = measure(&folder, &["odd.csv", "--time-unit", "us"]);
    assert_eq!(given.status.code(), Some(0));
}

#[test]
fn counts_are_times_in_the_unit_that_is_given() {
    let folder = folder("counts");
    let rows = volts(0.5, 1.0).into_iter().enumerate();
    let rows: String = rows.map(|(i, v)| format!("{i},{v:.6}\n")).collect();
    fs::write(folder.join("bare.csv"), rows).unwrap();
    let asked = measure(&folder, &["bare.csv"]);
    assert!(String::from_utf8_lossy(&asked.stderr).contains("--rate"));
    let output = measure(&folder, &["bare.csv", "--time-unit", "us", "--json"]);
    let found = &json(&output)["shots"][0]["tof_incident_s"]["value"];
    assert!((found.as_f64().unwrap() - 1e-6 * incident_us(0.5)).abs() < 1e-7);
}

#[test]
fn shots_and_speeds_without_times_are_told_counted_and_in_the_exit_code() {
    let folder = folder("timeless");
    let mut list = "file,case,speed,speed error\n".to_owned();
    for (number, speed) in [0.2, 0.2, 0.5, 0.5, 1.0].iter().enumerate() {
        let mut all = volts(*speed, 1.0);
        if *speed == 0.5 {
            // The passing pulse alone.
            let noise = |i: usize| 1e-3 * (1.7 * i as f64).sin();
            (700..all.len()).for_each(|i| all[i] = noise(i));
        }
        write(&folder.join(format!("{number}.csv")), &all);
        list += &format!("{number}.csv,gear,{speed},0.001\n");
    }
    fs::write(folder.join("list.txt"), list).unwrap();
    let output = measure(&folder, &[".", "--shots", "list.txt", "--out", "out"]);
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(
        printed.contains("5 records, 3 with times of flight, 2 flagged, 0 refused"),
        "{printed}"
    );
    assert!(
        printed.contains("gear at 0.5000 m/s: none of 2 shots")
            || printed.contains("gear at 0.5 m/s: none of 2 shots"),
        "{printed}"
    );
    let table = fs::read_to_string(folder.join("out/speeds.csv")).unwrap();
    let lost = table.lines().last().unwrap();
    assert!(lost.starts_with("gear,5e-1,,0,2,,"), "{table}");
    let reported = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(reported.contains("2 of 5") && reported.contains("no time of flight"), "{reported}");
}

/// Fits of shots at speeds whose errors are reported or not.
fn fits(folder: &Path, speeds: &[f64], error: &str) -> String {
    let mut list = "file,speed,speed error\n".to_owned();
    for (number, speed) in speeds.iter().enumerate() {
        // No power law: a part of the time does not depend on the speed.
        let wet = 1.0 + 0.1 * (speed - 0.5);
        write(&folder.join(format!("{number}.csv")), &volts(*speed, wet));
        list += &format!("{number}.csv,{speed},{error}\n");
    }
    fs::write(folder.join("list.txt"), list).unwrap();
    let output = measure(folder, &[".", "--shots", "list.txt"]);
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    let fit = printed.lines().find(|line| line.starts_with("incident:"));
    fit.unwrap_or_else(|| unreachable!("{printed}")).to_owned()
}

#[test]
fn a_power_law_is_judged_by_errors_of_speeds_only_where_these_are_known() {
    let known = fits(&folder("known"), &[0.2, 0.5, 1.0], "1e-6");
    assert!(known.contains("NOT a power law within the errors"), "{known}");
    let unknown = fits(&folder("unknown"), &[0.2, 0.5, 1.0], "");
    assert!(!unknown.contains("NOT a power law"), "{unknown}");
    assert!(unknown.contains("`speed error`") && unknown.contains("taken for 0"), "{unknown}");
    for (name, csv, supported) in
        [("known", ",false", Value::Bool(false)), ("unknown", ",unknown", Value::Null)]
    {
        let folder = folder(name);
        fits(&folder, &[0.2, 0.5, 1.0], if name == "known" { "1e-6" } else { "" });
        let reported = measure(&folder, &[".", "--shots", "list.txt", "--json", "--out", "out"]);
        let law = &json(&reported)["cases"][0]["power_law_incident"];
        assert_eq!(law["supported"], supported, "{law}");
        let why = law["supported_unknown_because"].as_str();
        assert_eq!(why.is_some(), name == "unknown", "{law}");
        let laws = fs::read_to_string(folder.join("out/power-laws.csv")).unwrap();
        assert!(laws.lines().nth(1).unwrap().ends_with(csv), "{laws}");
    }
    let two = fits(&folder("two"), &[0.2, 1.0], "1e-6");
    assert!(two.contains("two speeds, which cannot test it"), "{two}");
}

#[test]
fn ratios_of_both_times_are_printed() {
    let folder = folder("both-ratios");
    shots(&folder);
    let output = measure(&folder, &[".", "--shots", "list.txt"]);
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    for time in ["incident", "reflected"] {
        let lines = printed.matches(&format!("  {time} at ")).count();
        assert_eq!(lines, SPEEDS.len(), "{printed}");
    }
}

/// Of six records at 1 MHz none takes it: one line says so, and no table repeats it.
#[test]
fn a_low_pass_above_half_the_rate_is_told_once() {
    let folder = folder("low-pass");
    shots(&folder);
    let output = measure(&folder, &[".", "--shots", "list.txt", "--smooth", "2MHz"]);
    assert_eq!(output.status.code(), Some(2));
    let reported = String::from_utf8_lossy(&output.stderr);
    assert_eq!(reported.matches("half the sampling rate").count(), 1, "{reported}");
    assert!(reported.contains("sampled at 1000000 Hz"), "{reported}");
    assert!(output.stdout.is_empty());
}

#[test]
fn frequencies_times_and_sensitivities_of_measure_have_units() {
    let folder = folder("units");
    shots(&folder);
    for plain in [
        ["--skew", "5"],
        ["--low-pass", "180"],
        ["--ac-coupling", "0.5"],
        ["--smooth", "50"],
        ["--mains", "50"],
        ["--sensitivity", "12"],
    ] {
        let output = measure(&folder, &[&["."], &plain[..]].concat());
        assert_eq!(output.status.code(), Some(2), "{plain:?}");
        let reported = String::from_utf8_lossy(&output.stderr);
        assert!(reported.contains("with its unit, such as"), "{reported}");
    }
    let options: MeasureOptions =
        serde_json::from_str(r#"{"records": [], "skew": 5e-6, "low_pass": 180e3}"#).unwrap();
    assert_eq!(options.picking.skew.unwrap().0, 5e-6);
    assert_eq!(options.picking.low_pass.unwrap().0, 180e3);
}

#[test]
fn the_amplifiers_low_pass_has_the_names_that_fit_gives_it() {
    let folder = folder("names-of-low-pass");
    shots(&folder);
    let reported = |options: &[&str], code: i32| {
        let output = measure(&folder, &[&["."], options].concat());
        assert_eq!(output.status.code(), Some(code), "{options:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    let words = reported(&["--filter", "butterworth2"], 2);
    assert!(words.contains("--low-pass or --rig"), "{words}");
    let words = reported(&["--low-pass", "50kHz", "--filter", "bessel4"], 0);
    assert!(words.contains("low-pass of 50000 Hz, order 4 (Bessel)"), "{words}");
}

#[test]
fn a_measured_curve_is_fitted_in_memory_as_from_its_file() {
    let folder = folder("in-memory");
    shots(&folder);
    let list = folder.join("list.txt");
    let options = MeasureOptions { shots: Some(list.clone()), ..MeasureOptions::default() };
    let measured = hertzchain::measure(std::slice::from_ref(&folder), &options).unwrap();
    let curve = measured.curve("dry").unwrap();
    let output = measure(&folder, &[".", "--shots", "list.txt", "--out", "out"]);
    assert_eq!(output.status.code(), Some(0));
    let options = CurveOptions { case: Some("dry".to_owned()), ..CurveOptions::default() };
    let stored = inference::data(&folder.join("out/speeds.csv"), &options, None).unwrap();
    assert_eq!(curve.rows, stored.rows);
}

#[test]
fn a_folders_other_files_are_listed_once_and_the_table_excludes_shots() {
    let folder = folder("beside");
    write(&folder.join("a.csv"), &volts(0.5, 1.0));
    write(&folder.join("b.csv"), &volts(0.5, 1.01));
    fs::write(folder.join("README.txt"), "Two shots.\n").unwrap();
    fs::create_dir(folder.join("plots")).unwrap();
    fs::write(folder.join("list.csv"), "file,speed,counts\na.csv,0.5,yes\nb.csv,0.5,no\n").unwrap();
    let output = measure(&folder, &[".", "--shots", "list.csv", "--json", "--report", "page.html"]);
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(
        reported.matches("not read as recordings: README.txt, plots/;").count(),
        1,
        "{reported}"
    );
    let found = json(&output);
    assert_eq!(found["shots"][0]["not_counted"].as_array().unwrap().len(), 0);
    assert_eq!(found["shots"][1]["not_counted"][0], "excluded");
    assert_eq!(found["cases"][0]["speeds"][0]["shots"], 1);
    let page = fs::read_to_string(folder.join("page.html")).unwrap();
    assert!(page.contains("excluded by the list of shots; does not count: excluded"), "{page}");
    assert!(page.contains("data:image/svg+xml,%3Csvg"));
}

#[test]
fn hidden_files_and_tables_of_shots_in_a_folder_are_passed_over() {
    let folder = folder("passed-over");
    write(&folder.join("a.csv"), &volts(0.5, 1.0));
    fs::write(folder.join("._a.csv"), [0; 16]).unwrap();
    fs::write(folder.join(".DS_Store"), [0; 16]).unwrap();
    fs::write(folder.join("shots.csv"), "file,speed\na.csv,0.4\n").unwrap();
    fs::write(folder.join("hand.csv"), "file,speed\na.csv,0.5\n").unwrap();
    let output = measure(&folder, &[".", "--shots", "hand.csv"]);
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{reported}");
    assert!(reported.contains("not read as recordings: ._a.csv, shots.csv;"), "{reported}");
}

#[test]
fn binary_files_of_instruments_in_a_folder_are_listed_with_their_export() {
    let folder = folder("instruments");
    let trc = b"#9000015346WAVEDESC\x00";
    for (name, bytes) in
        [("a.trc", &trc[..]), ("b.trc", trc), ("c.bin", b"RG01\x00\x01"), ("d.bin", b"\x00")]
    {
        fs::write(folder.join(name), bytes).unwrap();
    }
    let alone = measure(&folder, &["."]);
    let reported = String::from_utf8_lossy(&alone.stderr).into_owned();
    assert_eq!(alone.status.code(), Some(2));
    for whose in
        ["a.trc is a binary file (.trc) of a LeCroy", "c.bin is a binary file (.bin) of a Rigol"]
    {
        assert_eq!(reported.matches(whose).count(), 1, "{reported}");
    }
    write(&folder.join("e.csv"), &volts(0.5, 1.0));
    let beside = measure(&folder, &["."]);
    let reported = String::from_utf8_lossy(&beside.stderr).into_owned();
    assert_eq!(beside.status.code(), Some(0), "{reported}");
    assert!(
        reported.contains("a.trc and 1 more: is a binary file (.trc) of a LeCroy"),
        "{reported}"
    );
    assert!(reported.contains("not read as recordings: d.bin;"), "{reported}");
}

#[test]
fn nothing_is_measured_without_a_reason() {
    let folder = folder("no-reason");
    fs::write(folder.join("list.csv"), "file,speed\na.csv,0.5\n").unwrap();
    let output = measure(&folder, &["list.csv", "--shots", "list.csv"]);
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2));
    assert!(reported.contains("nothing was measured: there is no recording"), "{reported}");
}
