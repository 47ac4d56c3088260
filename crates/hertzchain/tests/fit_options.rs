//! Options of fit and design: those that give the same bits again, those that hold for rivals,
//! those that say what could be measured, those that would say nothing.

use crate::common::{compact, curve, file, folder, json, refused, run, with_errors};
use hertzchain::options::{FitOptions, ModelOptions, from_json, recorded};
use hertzchain::{fit, inference};
use serde_json::Value;
use std::path::Path;

#[test]
fn options_of_a_results_json_give_the_same_bits_again() {
    let folder = folder("again");
    let data = curve(&folder, "dry");
    let fit = [
        "fit",
        &data,
        "-p",
        "dry",
        "--free",
        "eta,B",
        "--set",
        "aisi316.young_modulus=210GPa",
        "--bounds",
        "B=1:500",
        "--prior",
        "eta=3e4+-1e4",
        "--starts",
        "3",
        "--seed",
        "7",
        "--accuracy",
        "1e-6",
        "--json",
    ];
    let found = json(&with_errors(&fit));
    assert_eq!(found["version"], env!("CARGO_PKG_VERSION"));
    let options: FitOptions = from_json("fit", found["options"].clone()).unwrap();
    assert_eq!(recorded(&options), found["options"]);
    let data = inference::data(Path::new(&data), &options.measured, None).unwrap();
    let dry = inference::experiment(&options.modelled, None).unwrap();
    let again = hertzchain::fit(&data, &dry, &options).unwrap();
    assert_eq!(fit::json(&again, &options)["parameters"], found["parameters"]);
    // Without one of them it is another fit.
    let other = FitOptions { modelled: ModelOptions::default(), ..options };
    let dry = inference::experiment(&other.modelled, None).unwrap();
    let other = hertzchain::fit(&data, &dry, &other).unwrap();
    assert_ne!(other.inferred.fit.point, again.inferred.fit.point);
}

#[test]
fn rivals_know_what_is_set_and_known_in_the_fits_own_model() {
    let folder = folder("rivals");
    let softer = run(&["presets", "dry"]).stdout;
    let softer = String::from_utf8(softer).unwrap().replace("\"213 GPa\"", "\"200 GPa\"");
    let softer = file(&folder, "softer.toml", &softer);
    let out = folder.join("swept");
    let sweep = ["sweep", &softer, "--speeds", "log:0.1:1.2:6", "--out", out.to_str().unwrap()];
    assert!(run(&sweep).status.success());
    let data = out.join("sweep.csv");
    // The same model by two names of its numbers: nothing may distinguish them.
    let fit = [
        "fit",
        data.to_str().unwrap(),
        "-p",
        "dry",
        "--free",
        "eta,B",
        "--set",
        "young_modulus=200GPa",
        "--start",
        "B=90",
        "--bounds",
        "B=80:200",
        "--prior",
        "eta=3e4+-1e3",
        "--accuracy",
        "1e-6",
        "--json",
        "--against",
        "dry=aisi316.eta,dry.B",
        "--against",
        "hertz-viscoelastic=eta",
    ];
    let found = json(&with_errors(&fit));
    let [own, same, other] = [0, 1, 2].map(|at| &found["comparison"]["models"][at]);
    assert_eq!(own["point"], same["point"]);
    assert_eq!(own["point"][1], 80.0);
    assert_eq!(own["chi_square"], same["chi_square"]);
    assert_eq!(other["settings_left_out"], Value::Array(Vec::new()));
    // A number that a rival has not is left out, and reported.
    let fit = [
        "fit",
        data.to_str().unwrap(),
        "-p",
        "dry",
        "--free",
        "eta",
        "--set",
        "damping_cubic.coefficient=60 kg s/m^2",
        "--against",
        "hertz-viscoelastic=eta,Y",
        "--json",
    ];
    let found = json(&with_errors(&fit));
    let left_out = &found["comparison"]["models"][1]["settings_left_out"];
    assert_eq!(left_out[0], "damping_cubic.coefficient=60 kg s/m^2", "{found:#}");
}

#[test]
fn options_that_would_say_nothing_are_refused_at_once() {
    let folder = folder("unheeded");
    let data = curve(&folder, "dry");
    let fit = ["fit", &data, "-p", "dry", "--free", "eta"];
    let nowhere = folder.join("nowhere").to_str().unwrap().to_owned();
    for (options, words) in [
        (&["--robust", "--against", "hertz=Y"][..], "a robust loss is none"),
        (&["--rate", "1MHz"], "--rate is for recordings"),
        (&["--resume", "--out", &nowhere], "holds nothing of one: leave it out"),
    ] {
        let message = refused(&with_errors(&[&fit[..], options].concat()));
        assert!(message.contains(words), "{options:?}: {message}");
    }
    let rig = file(&folder, "rig.toml", &compact());
    let silent: String = (0..3000).map(|n| format!("{n}e-6,0\n")).collect();
    let silent = file(&folder, "silent.csv", &format!("time_s,volts\n{silent}"));
    let fit = ["fit", &silent, "-m", &rig, "--case", "dry", "--free", "steel.eta"];
    let message = refused(&[&fit[..], &["--against", "hertz=Y"]].concat());
    assert!(message.contains("DATA are recordings"), "{message}");
}

/// What a design proposes: names, costs, information over cost.
fn proposed(arguments: &[&str]) -> Vec<(String, f64, f64, f64)> {
    let found = json(&with_errors(arguments));
    let ranked = found["ranked"].as_array().unwrap().iter();
    let reported = |one: &Value| {
        let number = |key: &str| one[key].as_f64().unwrap();
        let name = one["measure"].as_str().unwrap().to_owned();
        (name, number("cost"), number("information_nats"), number("information_over_cost"))
    };
    ranked.map(reported).collect()
}

#[test]
fn pushes_sensors_and_costs_of_a_design_are_options() {
    let folder = folder("ways");
    let data = curve(&folder, "dry");
    let design = ["design", &data, "-p", "dry", "--free", "eta,B", "--speeds", "0.3,0.8", "--json"];
    let usual = proposed(&design);
    let has =
        |all: &[(String, f64, f64, f64)], words: &str| all.iter().any(|one| one.0.contains(words));
    for words in
        ["pushed with 0.24 N", "sensor in bead 5", "sensor in bead 20", "sensor in bead 30"]
    {
        assert!(has(&usual, words), "{words}");
    }
    assert!(usual.iter().all(|(_, cost, information, over)| *cost == 1.0 && information == over));
    let options = ["--preloads", "0.1N,0.5", "--sensors", "10", "--costs", "sensor=4,preload=0.5"];
    let other = proposed(&[&design[..], &options].concat());
    assert!(has(&other, "pushed with 0.1 N") && has(&other, "pushed with 0.5 N"));
    assert!(has(&other, "sensor in bead 10"));
    assert!(!has(&other, "0.24 N") && !has(&other, "bead 20"));
    for (name, cost, information, over) in &other {
        let expected = match name {
            name if name.contains("sensor") => 4.0,
            name if name.contains("pushed") => 0.5,
            _ => 1.0,
        };
        assert_eq!(*cost, expected, "{name}");
        // Divided once: exact.
        assert_eq!(*over, information / cost, "{name}");
    }
    assert!(other.windows(2).all(|pair| pair[0].3 >= pair[1].3));
    // The harder the push, the more the row is changed: they are no two names of one thing.
    let informed = |words: &str| other.iter().find(|one| one.0.contains(words)).unwrap().2;
    assert_ne!(informed("0.8"), informed("0.3"));
    assert_ne!(informed("pushed with 0.1 N"), informed("pushed with 0.5 N"));
    let none = proposed(&[&design[..], &["--preloads", "none"]].concat());
    assert!(!has(&none, "pushed"));
    // Where the push is free, the fit's own would stand in the place of any other.
    let free = [
        "design", &data, "-p", "paper", "--case", "dry", "--free", "preload", "--speeds", "0.5",
        "--json",
    ];
    assert!(!has(&proposed(&free), "pushed"));
    for (options, words) in [
        (["--sensors", "40"], "expected one from 1 to 39"),
        (["--preloads", "2mm"], "expected a force"),
        (["--costs", "lens=2"], "ways are incident, reflected"),
    ] {
        let message = refused(&with_errors(&[&design[..], &options].concat()));
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn a_short_name_is_set_in_other_models_too() {
    let folder = folder("set-short");
    let data = curve(&folder, "dry");
    let fit = ["fit", &data, "-p", "dry", "--free", "B", "--set", "eta=30 kPa s"];
    let found = json(&with_errors(&[&fit[..], &["--against", "dry=dry.B", "--json"]].concat()));
    let [own, same] = [0, 1].map(|at| &found["comparison"]["models"][at]);
    assert_eq!(same["settings_left_out"], Value::Array(Vec::new()));
    let [own, same] = [own, same].map(|one| one["chi_square"].as_f64().unwrap());
    // Curves to 1e-6 and 1e-7.
    assert!((own / same - 1.0).abs() < 1e-2, "{own} {same}");
    let twice = ["--prior", "B=70+-1", "--prior", "B=80+-1"];
    let reported = refused(&with_errors(&[&fit[..], &twice].concat()));
    assert!(reported.contains("--prior B is given twice"), "{reported}");
}

#[test]
fn percents_are_of_the_mean_and_refused_where_there_is_none() {
    let folder = folder("percents");
    let data = curve(&folder, "dry");
    let fit = ["fit", &data, "-p", "dry", "--free", "B", "--json"];
    let with = |more: &[&str]| run(&with_errors(&[&fit[..], more].concat()));
    let found = |prior: &str| {
        let found = json(&with_errors(&[&fit[..], &["--prior", prior]].concat()));
        found["parameters"][0]["standard_error"].as_f64().unwrap()
    };
    assert_eq!(found("B=80+-5%"), found("B=80+-4"));
    for (option, text) in [("--start", "B=90%"), ("--scale", "B=10%")] {
        assert!(!with(&[option, text]).status.success(), "{option} {text}");
    }
}

#[test]
fn models_are_compared_with_what_their_priors_cost() {
    let folder = folder("compared-priors");
    let data = curve(&folder, "dry");
    let fit = ["fit", &data, "-p", "dry", "--free", "B", "--prior", "B=70+-2", "--json"];
    let found = json(&with_errors(&[&fit[..], &["--against", "hertz-viscoelastic=eta"]].concat()));
    let own = &found["comparison"]["models"][0];
    let whole = &found["chi_square"]["value"];
    let values = [own["chi_square"].as_f64().unwrap(), whole.as_f64().unwrap()];
    // Curves to 1e-6 and 1e-7.
    assert!((values[0] / values[1] - 1.0).abs() < 1e-2, "{values:?}");
    assert_eq!(own["freedom"], found["chi_square"]["freedom"]);
}
