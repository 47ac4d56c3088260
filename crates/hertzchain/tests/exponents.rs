//! An exponent of a law, on which the unit of its stiffness depends, freed or set alone.

use crate::common::{curve, file, folder, json, run, with_errors};

const EXPONENT: &str = "contacts[1].laws.elastic_power.exponent";

#[test]
fn an_exponent_can_be_free_alone_and_the_report_says_what_the_stiffness_then_is() {
    let data = curve(&folder("exponent-free"), "exponent-section");
    let fit =
        ["fit", &data, "-p", "exponent-section", "--free", "exponent", "--start", "exponent=1.97"];
    let found = json(&with_errors(&[&fit[..], &["--json"]].concat()));
    let exponent = &found["parameters"][0];
    let value = exponent["value"].as_f64().unwrap();
    // The curve's own exponent, within a standard error: it has no noise.
    let error = exponent["standard_error"].as_f64().unwrap();
    assert!((value - 2.0).abs() < error && error < 1e-3, "{value} {error}");
    assert_eq!(exponent["lower"], 1.0);
    let reported = String::from_utf8(run(&with_errors(&fit)).stderr).unwrap();
    for words in ["is free and", "its number 2.5e12 is kept", "N/m^2", "overlap of 1 m"] {
        assert!(reported.contains(words), "{words}: {reported}");
    }
    assert!(reported.contains(found["kept"][0].as_str().unwrap()), "{reported}");
}

#[test]
fn an_exponent_can_be_set_alone() {
    let data = curve(&folder("exponent-set"), "exponent-section");
    let fit = |sets: &[&str]| {
        let free = ["--free", "elastic_power.stiffness", "--json"];
        let fit = ["fit", &data, "-p", "exponent-section"];
        json(&with_errors(&[&fit[..], sets, &free].concat()))
    };
    // By itself, with the stiffness free: its start is the file's number in the new unit.
    let found = fit(&["--set", "exponent=1.9"]);
    assert_eq!(found["parameters"][0]["unit"], "N/m^1.9");
    assert_eq!(found["parameters"][0]["start"], 2.5e12);
    assert_eq!(found["kept"].as_array().unwrap().len(), 0);
    // With nothing else said of the stiffness it is kept, and reported.
    let other = ["fit", &data, "-p", "exponent-section", "--set", "exponent=1.9", "--free", "Y"];
    let reported = String::from_utf8(run(&with_errors(&other)).stderr).unwrap();
    assert!(reported.contains("is set and") && reported.contains("now N/m^1.9"), "{reported}");
}

#[test]
fn a_rival_can_have_a_free_exponent() {
    let folder = folder("exponent-rival");
    let data = curve(&folder, "hertz-viscoelastic");
    let model = String::from_utf8(run(&["presets", "hertz-viscoelastic"]).stdout).unwrap();
    // The same contacts by a law whose exponent is a number of the file.
    let law = "{ law = \"elastic_power\", stiffness = \"8.7926303796e9 N/m^1.5\", exponent = 1.5 }";
    let power = file(&folder, "pow.toml", &model.replace("\"elastic_hertz\"", law));
    let against = format!("{power}=exponent,eta");
    let fit = [
        "fit",
        &data,
        "-p",
        "hertz-viscoelastic",
        "--free",
        "eta",
        "--against",
        &against,
        "--json",
    ];
    let found = json(&with_errors(&fit));
    let alternative = &found["comparison"]["models"][1];
    // The true exponent is 3/2, and the curve has no noise; both models hold it.
    let exponent = alternative["point"][0].as_f64().unwrap();
    assert!((exponent - 1.5).abs() < 1e-3, "{found}");
    assert!(
        alternative["kept"][0].as_str().unwrap().contains(&EXPONENT.replace('1', "0")),
        "{alternative}"
    );
}
