//! fit at the command line.

use crate::common::{curve, folder, json, run, with_errors};
use std::path::Path;

#[test]
fn a_swept_curve_gives_its_own_numbers_back_and_files_beside() {
    let folder = folder("fit");
    let data = curve(&folder, "dry");
    let out = folder.join("out");
    let out = out.to_str().unwrap();
    let fit =
        ["fit", &data, "-p", "dry", "--free", "eta,B", "--start", "eta=2e4", "--json", "-o", out];
    let found = json(&with_errors(&fit));
    for (at, exact) in [3.2e4, 77.0].into_iter().enumerate() {
        let parameter = &found["parameters"][at];
        let value = parameter["value"].as_f64().unwrap();
        let sd = parameter["standard_error"].as_f64().unwrap();
        // No noise, so only the solver's errors, far below the data's.
        assert!((value - exact).abs() < 0.1 * sd, "{parameter}");
    }
    for name in
        ["fit.json", "fit.csv", "parameters.csv", "fit.svg", "fit.png", "singular-values.png"]
    {
        assert!(Path::new(out).join(name).exists(), "{name}");
    }
    // One thread or two: the same bits.
    let one = json(&with_errors(&[&fit[..], &["--threads", "1", "--force"]].concat()));
    assert_eq!(one, found);
}

#[test]
fn profiles_and_other_models_are_told_in_words() {
    let folder = folder("words");
    let data = curve(&folder, "dry");
    let fit = ["fit", &data, "-p", "dry", "--free", "eta,B", "--method", "profile"];
    let against = ["--against", "hertz-viscoelastic=eta"];
    let output = run(&with_errors(&[&fit[..], &against].concat()));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("by profile") && text.contains("is rejected"), "{text}");
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
    assert_eq!([0, 1, 2, 3].map(determined), [false, false, false, true].map(Some));
    assert!(found["parameters"][0]["standard_error"].is_null());
}

#[test]
fn a_posterior_of_too_many_parameters_says_before_it_begins_that_it_takes_its_time() {
    let folder = folder("many");
    let out = folder.join("swept");
    let sweep = ["sweep", "-p", "dry", "--speeds", "log:0.1:1.2:19", "--out"];
    assert!(run(&[&sweep[..], &[out.to_str().unwrap()]].concat()).status.success());
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
    let reported = String::from_utf8(output.stderr).unwrap();
    assert!(
        reported.contains("19 parameters are free, and curves are interpolated for up to 18"),
        "{reported}"
    );
}

#[test]
fn a_bound_that_binds_is_no_error_bar() {
    let folder = folder("bound");
    let data = curve(&folder, "dry");
    let fit =
        ["fit", &data, "-p", "dry", "--free", "eta,B", "--bounds", "B=80:200", "--start", "B=90"];
    let text = String::from_utf8(run(&with_errors(&fit)).stdout).unwrap();
    assert!(text.contains("80 kg s/m^2, at its bound"), "{text}");
}
