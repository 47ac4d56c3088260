//! fit, gauge and design at the command line, and what they refuse.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

pub fn run(arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
    program.args(arguments).output().unwrap()
}

pub fn refused(arguments: &[&str]) -> String {
    let output = run(arguments);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(!message.contains("panicked"), "{message}");
    message
}

pub fn json(arguments: &[&str]) -> Value {
    let output = run(arguments);
    let told = String::from_utf8_lossy(&output.stderr);
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| unreachable!("{error}: {told}"))
}

pub fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("inference-{test}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

pub fn file(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// Six speeds of a preset's curve, as `sweep` writes them, as a path.
pub fn curve(folder: &Path, preset: &str) -> String {
    let out = folder.join(preset);
    let out = out.to_str().unwrap();
    let swept = run(&[
        "sweep",
        "-p",
        preset,
        "--speeds",
        "log:0.1:1.2:6",
        "--out",
        out,
    ]);
    assert!(swept.status.success());
    format!("{out}/sweep.csv")
}

const ERRORS: [&str; 4] = ["--tof-error", "2e-7", "--speed-error", "5e-4"];

pub fn with_errors<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    arguments.iter().copied().chain(ERRORS).collect()
}

#[test]
fn a_swept_curve_gives_its_own_numbers_back_and_files_beside() {
    let folder = folder("fit");
    let data = curve(&folder, "dry");
    let out = folder.join("out");
    let out = out.to_str().unwrap();
    let fit = [
        "fit", &data, "-p", "dry", "--free", "eta,B", "--start", "eta=2e4", "--json", "-o", out,
    ];
    let found = json(&with_errors(&fit));
    for (at, exact) in [3.2e4, 77.0].into_iter().enumerate() {
        let parameter = &found["parameters"][at];
        let value = parameter["value"].as_f64().unwrap();
        let sd = parameter["standard_error"].as_f64().unwrap();
        // No noise, so only the solver's errors, far below the data's.
        assert!((value - exact).abs() < 0.1 * sd, "{parameter}");
    }
    for name in [
        "fit.json",
        "fit.csv",
        "parameters.csv",
        "fit.svg",
        "fit.png",
        "singular-values.png",
    ] {
        assert!(Path::new(out).join(name).exists(), "{name}");
    }
    // One thread or two: the same bits.
    let one = json(&with_errors(&[&fit[..], &["--threads", "1"]].concat()));
    assert_eq!(one, found);
}

/// The walkers are written as they stand, whole, under their name: a run that is
/// killed goes on from there to the bits of one that was not.
#[test]
fn a_posterior_that_is_killed_goes_on_to_the_walkers_of_one_that_was_not() {
    let folder = folder("killed");
    let data = curve(&folder, "dry");
    let posterior = |out: &str, steps: &str, more: &[&str]| {
        let out = folder.join(out);
        let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
        program
            .args(["fit", &data, "-p", "dry", "--free", "eta,B"])
            .args(["--method", "posterior", "--seed", "5", "--steps", steps])
            .args(ERRORS)
            .arg("--out")
            .arg(out)
            .args(more)
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        program
    };
    let chain = |out: &str| fs::read(folder.join(out).join("chain.json")).unwrap();
    assert!(posterior("whole", "60", &[]).status().is_ok());
    assert!(posterior("broken", "20", &[]).status().is_ok());
    let begun = chain("broken");
    for delay_ms in [50, 400] {
        let mut child = posterior("broken", "60", &["--resume"]).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(delay_ms));
        child.kill().unwrap();
        child.wait().unwrap();
        // Whole at any moment: what was there, or what the run came to.
        assert!([&begun, &chain("whole")].contains(&&chain("broken")));
    }
    assert!(posterior("broken", "60", &["--resume"]).status().is_ok());
    assert!(chain("broken") == chain("whole"));
    assert!(begun != chain("whole"));
}

#[test]
fn profiles_and_other_models_are_told_in_words() {
    let folder = folder("words");
    let data = curve(&folder, "dry");
    let fit = [
        "fit", &data, "-p", "dry", "--free", "eta,B", "--method", "profile",
    ];
    let against = ["--against", "hertz-viscoelastic=eta"];
    let output = run(&with_errors(&[&fit[..], &against].concat()));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("by profile") && text.contains("is rejected"),
        "{text}"
    );
    let three = ["fit", &data, "-p", "dry", "--free", "Y,nu,eta,B"];
    let text = String::from_utf8(run(&with_errors(&three)).stdout).unwrap();
    assert!(text.contains("determine 3 of 4 combinations"), "{text}");
    assert!(text.contains("free K and A instead"), "{text}");
    assert!(text.contains("no further data of this kind"), "{text}");
    // What is open has no error bar, and B has one.
    for name in ["Y", "nu", "eta"] {
        let own = |line: &&str| line.trim_start().starts_with(&format!("{name} "));
        let line = text.lines().find(own).unwrap();
        assert!(line.ends_with("not determined"), "{text}");
    }
    assert!(text.contains("B    77"), "{text}");
    let found = json(&with_errors(&[&three[..], &["--json"]].concat()));
    let determined = |at: usize| found["parameters"][at]["determined"].as_bool();
    assert_eq!(
        [0, 1, 2, 3].map(determined),
        [false, false, false, true].map(Some)
    );
    assert!(found["parameters"][0]["standard_error"].is_null());
}

#[test]
fn speeds_without_errors_are_warned_of_by_line() {
    let folder = folder("exact");
    let rows = "0.1,0,1.0274e-3,1e-7\n0.4,1e-3,7.9465e-4,1e-7\n1.0,,6.8166e-4,1e-7\n";
    let data = file(&folder, "data.csv", &format!("{HEAD}{rows}"));
    let told = |more: &[&str]| {
        let fit = ["fit", &data, "-p", "dry", "--free", "eta"];
        let output = run(&[&fit[..], more].concat());
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let warning = told(&[]);
    assert!(
        warning.contains("lines 2, 4: speeds without an error"),
        "{warning}"
    );
    // A cell that is 0 is a cell; one that is empty is filled.
    let warning = told(&["--speed-error", "1e-3"]);
    assert!(
        warning.contains("line 2: speeds without an error"),
        "{warning}"
    );
    assert_eq!(told(&["--speed-error", "0"]), "");
    let message = refused(&["fit", &data, "--free", "eta", "--error-shots", "4"]);
    assert!(
        message.contains("expected a whole number from 6"),
        "{message}"
    );
}

#[test]
fn a_posterior_of_too_many_parameters_says_before_it_begins_that_it_takes_its_time() {
    let folder = folder("many");
    let out = folder.join("swept");
    let sweep = ["sweep", "-p", "dry", "--speeds", "log:0.1:1.2:19", "--out"];
    assert!(
        run(&[&sweep[..], &[out.to_str().unwrap()]].concat())
            .status
            .success()
    );
    let data = out.join("sweep.csv");
    let posterior = [
        "fit",
        data.to_str().unwrap(),
        "-p",
        "dry",
        "--free",
        "B:each",
        "--method",
        "posterior",
        "--steps",
        "0",
    ];
    let output = run(&with_errors(&posterior));
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(
        told.contains("19 parameters are free, and curves are interpolated for up to 18"),
        "{told}"
    );
}

/// Residuals are written as they come: a run that is killed goes on from there to the
/// bits of one that was not.
#[test]
fn a_fit_and_its_profiles_that_are_killed_go_on_to_the_bits_of_one_that_was_not() {
    let folder = folder("killed-profile");
    let data = curve(&folder, "dry");
    let fit = |out: &str, more: &[&str]| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_hertzchain"));
        program
            .args([
                "fit", &data, "-p", "dry", "--free", "eta,B", "--starts", "3",
            ])
            .args(["--method", "profile", "--accuracy", "1e-7", "--seed", "5"])
            .args(ERRORS)
            .arg("--out")
            .arg(folder.join(out))
            .args(more)
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        program
    };
    let parts = |out: &str| {
        let found = fs::read_dir(folder.join(out).join("partial"));
        found.map_or(0, |found| {
            let names = found.map(|entry| entry.unwrap().file_name());
            names
                .filter(|name| name.to_str().unwrap().starts_with("part-"))
                .count()
        })
    };
    let mut more: &[&str] = &[];
    for wanted in [2, 4] {
        let mut child = fit("broken", more).spawn().unwrap();
        while parts("broken") < wanted && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(5));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(parts("broken") >= wanted, "it ended before it was killed");
        more = &["--resume"];
    }
    let result = |out: &str| fs::read(folder.join(out).join("fit.json"));
    assert!(result("broken").is_err());
    assert!(fit("broken", more).status().unwrap().success());
    assert!(fit("whole", &[]).status().unwrap().success());
    assert_eq!(result("broken").unwrap(), result("whole").unwrap());
    assert_eq!(parts("broken"), 0);
}

#[test]
fn a_posterior_is_the_same_in_one_run_and_in_two() {
    let folder = folder("posterior");
    let data = curve(&folder, "dry");
    let out = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let (whole, parts) = (out("whole"), out("parts"));
    let run_into = |out: &str, more: &[&str]| {
        let fit = [
            "fit",
            &data,
            "-p",
            "dry",
            "--free",
            "eta,B",
            "--method",
            "posterior",
            "--json",
            "-o",
            out,
        ];
        json(&with_errors(&[&fit[..], more].concat()))
    };
    let at_once = run_into(&whole, &["--steps", "400"]);
    let first = run_into(&parts, &["--steps", "300"]);
    assert!(
        first["posterior"]["unconverged"]
            .as_str()
            .unwrap()
            .contains("has not converged")
    );
    let then = run_into(&parts, &["--steps", "400", "--resume"]);
    assert_eq!(at_once["posterior"], then["posterior"]);
}

#[test]
fn the_gauge_knows_its_oils_and_says_when_it_does_not() {
    let folder = folder("gauge");
    let (dry, pump) = (curve(&folder, "dry"), curve(&folder, "pump"));
    let found = json(&with_errors(&["gauge", &pump, "--dry", &dry, "--json"]));
    assert!(
        found["verdict"]
            .as_str()
            .unwrap()
            .starts_with("It is pump oil"),
        "{found}"
    );
    // A dry chain's curve is that of no oil.
    let found = json(&with_errors(&[
        "gauge", &dry, "--dry", &dry, "--json", "--use", "incident",
    ]));
    assert!(
        found["verdict"]
            .as_str()
            .unwrap()
            .starts_with("None of these"),
        "{found}"
    );
    assert!(found["to_add"].as_str().unwrap().contains("reflected"));
}

#[test]
fn a_design_ranks_what_to_measure() {
    let folder = folder("design");
    let data = curve(&folder, "dry");
    let design = [
        "design", &data, "-p", "dry", "--free", "eta,B", "--target", "B", "--json",
    ];
    let found = json(&with_errors(&design));
    let now = found["standard_errors_now"][0].as_f64().unwrap();
    let ranked = found["ranked"].as_array().unwrap();
    assert!(ranked.len() > 30);
    let nats = |one: &Value| one["information_nats"].as_f64().unwrap();
    for pair in ranked.windows(2) {
        // What differs by less than a thousandth ranks by cost.
        assert!(nats(&pair[0]) + 1e-3 >= nats(&pair[1]));
    }
    assert!(ranked[0]["standard_errors"][0].as_f64().unwrap() < now);
    let message = refused(&with_errors(&[
        "design", &data, "--free", "eta", "--target", "B",
    ]));
    assert!(
        message.contains("--target B is not free; free are eta"),
        "{message}"
    );
    let fast = ["design", &data, "--free", "eta", "--speeds", "0.1,500"];
    assert!(refused(&with_errors(&fast)).contains("it looks like mm/s"));
    // Errors of what the data leave open are not told as if they meant something.
    let three = ["design", &data, "--free", "Y,nu,eta"];
    let text = String::from_utf8(run(&with_errors(&three)).stdout).unwrap();
    assert!(text.contains("Not determined so far"), "{text}");
    assert!(text.contains("free K and A instead"), "{text}");
    // Nor is noise ranked: two combinations can be determined, and the third by nothing.
    let found = json(&with_errors(&[&three[..], &["--json"]].concat()));
    let names = serde_json::json!(["combination 1", "combination 2"]);
    assert_eq!(found["parameters"], names);
    let told = found["hopeless"].to_string();
    for words in [
        "nu up 1.00 % with",
        "So none of Y, nu, eta can be tightened by itself",
    ] {
        assert!(told.contains(words), "{words}: {told}");
    }
    // A start from where no minimum is found tells nothing.
    let far = ["design", &data, "--free", "Y,eta,B", "--start", "B=1e5"];
    let told = refused(&with_errors(&far));
    assert!(told.contains("found no minimum"), "{told}");
}

const HEAD: &str = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error\n";

#[test]
fn data_that_can_not_be_fitted_are_told_by_row_and_column() {
    let folder = folder("data");
    for (number, (rows, words)) in [
        (
            "0.5,0,7.6e-4,1e-7\n0.5,0,7.6e-4,1e-7\n",
            "stands in line 2 too",
        ),
        ("-0.5,0,7.6e-4,1e-7\n", "line 2, speed_m_s"),
        ("0.5,0,7.6e-4,0\n", "line 2, tof_incident_s_error"),
        ("0.5,0,7.6e-4,\n", "no uncertainty"),
        ("0.5,0,760,1\n", "looks like microseconds"),
        (
            "0.5,0,7.6e-4,1e-7\n",
            "1 measured values for 2 free parameters (eta, B)",
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let data = file(&folder, &format!("{number}.csv"), &format!("{HEAD}{rows}"));
        let message = refused(&["fit", &data, "-p", "dry", "--free", "eta,B"]);
        assert!(message.contains(words), "{rows}: {message}");
    }
    assert!(
        refused(&["fit", "nowhere.csv", "--free", "eta"]).contains("nowhere.csv can't be read")
    );
}

#[test]
fn parameters_that_can_not_be_free_are_told_by_name() {
    let folder = folder("free");
    let rows = "0.1,0,1.0274e-3,1e-7\n0.4,0,7.9465e-4,1e-7\n1.0,0,6.8166e-4,1e-7\n";
    let data = file(&folder, "data.csv", &format!("{HEAD}{rows}"));
    for (arguments, words) in [
        (&["--free", "eta,hardness"][..], "hardness"),
        (&["--free", "eta,aisi316.eta"], "are the same number"),
        (
            &["--free", "friction", "--start", "friction=0.05"],
            "the wave knows no friction",
        ),
        (
            &["--free", "eta,wall_gain"],
            "wall_gain changes no residual near 1.0000e0",
        ),
        (
            &["--free", "eta", "--bounds", "eta=1e5:1e6"],
            "outside its bounds",
        ),
        (
            &["--free", "eta", "--bounds", "eta=1e6:1e5"],
            "leave nothing between them",
        ),
        (
            &["--free", "eta", "--prior", "eta=1e3+-10"],
            "start nearer, or widen the prior",
        ),
        (
            &["--free", "eta", "--prior", "eta=1e3+-0"],
            "is no distribution",
        ),
        (
            &["--free", "eta", "--start", "B=3"],
            "nothing of this name is free; free are eta",
        ),
        (
            &["--free", "eta", "--start", "eta=3 mm"],
            "another dimension",
        ),
        (
            &["--free", "nu", "--start", "nu=0.3", "--scale", "nu=-1"],
            "expected a positive number",
        ),
    ] {
        let fit = ["fit", &data, "-p", "dry"];
        let message = refused(&[&fit[..], arguments].concat());
        assert!(message.contains(words), "{arguments:?}: {message}");
    }
}

#[test]
fn a_bound_that_binds_is_no_error_bar() {
    let folder = folder("bound");
    let data = curve(&folder, "dry");
    let fit = [
        "fit", &data, "-p", "dry", "--free", "eta,B", "--bounds", "B=80:200", "--start", "B=90",
    ];
    let text = String::from_utf8(run(&with_errors(&fit)).stdout).unwrap();
    assert!(text.contains("80 kg s/m^2, at its bound"), "{text}");
}

/// The small rig, its chains laid compact and pushed by nothing, so that they are
/// the model's.
pub fn compact() -> String {
    let small = include_str!("../../rig/tests/small.toml");
    let changes = [
        ("force = \"0.24 N\"", "force = \"0 N\""),
        ("stiffness = \"100 N/m\"", "stiffness = \"0 N/m\""),
        ("incline = \"0.2 deg\"", "incline = \"0 deg\""),
        ("taps = 2", "taps = 0"),
        ("shots = 3", "shots = 1"),
        ("gap_scatter = \"5 um\"", "gap_scatter = \"0 um\""),
    ];
    changes.iter().fold(small.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

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
