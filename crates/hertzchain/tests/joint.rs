//! fit of several tables, and with systematic errors, at the command line.

use crate::common::{curve, file, folder, json, refused, run, with_errors};
use hertzchain::prelude::*;
use serde_json::Value;
use std::fs;

/// Incident times alone of a chain, at six speeds near each other.
fn incident(folder: &std::path::Path, name: &str, model: &str) -> String {
    let out = folder.join(name);
    let sweep = ["sweep", model, "--speeds", "log:0.3:0.6:6", "--out", out.to_str().unwrap()];
    assert!(run(&sweep).status.success());
    out.join("sweep.csv").to_str().unwrap().to_owned()
}

fn sd(found: &Value, at: usize) -> Option<f64> {
    found["parameters"][at]["standard_error"].as_f64()
}

#[test]
fn a_push_that_the_fit_advises_determines_what_one_table_leaves_open() {
    let folder = folder("pushed");
    let text = String::from_utf8(run(&["presets", "hertz-viscoelastic"]).stdout).unwrap();
    let bare = file(&folder, "bare.toml", &text);
    let push = "\n[near_end]\npush = \"constant\"\nforce = \"0.24 N\"\n";
    let pushed = file(&folder, "pushed.toml", &(text + push));
    let tables = [("bare", &bare), ("pushed", &pushed)];
    let [one, other] = tables.map(|(name, model)| incident(&folder, name, model));
    let fit = |more: &[&str]| {
        let fit = ["fit", &one, "-m", &bare, "--free", "K,A", "--use", "incident", "--json"];
        json(&[&fit[..], &["--tof-error", "5us", "--speed-error", "5e-4"], more].concat())
    };
    let alone = fit(&[]);
    let advised = alone["would_separate"].to_string();
    assert!(advised.contains("pushed with 0.24 N"), "{advised}");
    let also = format!("{other}={pushed}");
    let out = folder.join("both");
    let both = fit(&["--also", &also, "-o", out.to_str().unwrap()]);
    assert_eq!(both["not_determined"].as_array().map(Vec::len), Some(0), "{both}");
    for (at, exact) in [8.792_630_379_6e9, 3.385_289_514_9e-7].into_iter().enumerate() {
        let error = sd(&both, at).unwrap();
        let off = both["parameters"][at]["value"].as_f64().unwrap() - exact;
        // No noise, so only the solver's errors.
        assert!(off.abs() < 0.1 * error && error < exact, "{both}");
        assert!(sd(&alone, at).is_none_or(|before| error < 0.5 * before), "{alone}");
    }
    assert_eq!(both["tables"][1]["model"], pushed.as_str());
    // Above the tables stands what all of them have together.
    assert_eq!(both["data"]["values"], 12);
    assert_eq!(both["data"]["file"], format!("{one}, {other}"));
    assert_eq!(both["model"], format!("{bare}, {pushed}"));
    for name in ["fit.png", "fit-2.png"] {
        assert!(out.join(name).exists(), "{name}");
    }
    let rows = fs::read_to_string(out.join("fit.csv")).unwrap();
    assert!(rows.lines().next().unwrap().ends_with("residual,file"), "{rows}");
    assert_eq!(rows.lines().filter(|line| line.ends_with(&other)).count(), 6);
}

#[test]
fn a_dry_and_a_wet_table_share_what_both_models_know() {
    let folder = folder("dry-and-wet");
    let [dry, wet] = ["dry", "motor"].map(|preset| curve(&folder, preset));
    let also = format!("{wet}=motor");
    let fit = ["fit", &dry, "-p", "dry", "--also", &also, "--free", "dry.B,wet.K,wet.A"];
    let output = run(&with_errors(&[&fit[..], &["--own", "dry.B"]].concat()));
    let text = String::from_utf8(output.stdout).unwrap();
    for words in ["dry.B#1", "dry.B#2", "wet.K", "Dry chain of 40", "χ² = "] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let message = refused(&with_errors(&[&fit[..], &["--own", "eta"]].concat()));
    assert!(message.contains("--own eta: nothing of this name is free"), "{message}");
    let message = refused(&with_errors(&["fit", &dry, "--free", "B", "--own", "B"]));
    assert!(message.contains("--own is for several tables"), "{message}");
}

#[test]
fn a_fit_of_several_tables_is_the_same_from_rust() {
    let folder = folder("joint-rust");
    let table = curve(&folder, "dry");
    let also = format!("{table}=dry");
    let fit = ["fit", &table, "-p", "dry", "--also", &also, "--free", "eta,B", "--json"];
    let found = json(&with_errors(&fit));
    let options = serde_json::json!({"free": ["eta", "B"], "tof_error": 2e-7, "speed_error": 5e-4});
    let options: FitOptions = from_json("fit", options).unwrap();
    let data = inference::data(table.as_ref(), &options.measured, None).unwrap();
    let pair = (data, preset("dry").unwrap());
    let own = hertzchain::fit::fit_tables(&[pair.clone(), pair], &options).unwrap();
    let value = |at: usize| found["parameters"][at]["value"].as_f64().unwrap();
    assert_eq!(own.inferred.fit.point, [value(0), value(1)]);
    assert_eq!(own.tables().len(), 2);
}

#[test]
fn a_delay_is_reported_with_its_prior_and_in_all_that_the_fit_says() {
    let folder = folder("delay");
    let table = curve(&folder, "dry");
    let fit = ["fit", &table, "-p", "dry", "--free", "eta,B", "--systematic", "delay=0.2us"];
    let text = String::from_utf8(run(&with_errors(&fit)).stdout).unwrap();
    assert!(text.contains("s, prior (0.0 ± 2.0)·1e-7 s"), "{text}");
    let found = json(&with_errors(&[&fit[..], &["--method", "profile", "--json"]].concat()));
    assert_eq!(found["parameters"][2]["prior"]["sd"], 2e-7);
    assert_eq!(found["options"]["systematic"]["delay"], "0.2us");
    assert!(found["correlation"][0][2].as_f64().unwrap().abs() > 0.1, "{found}");
    assert_eq!(found["profiles"][2]["name"], "delay");
    // What the curve says nothing of is left to its prior.
    let silent = ["fit", &table, "-p", "dry", "--free", "eta", "--systematic", "radius_error=1nm"];
    let text = String::from_utf8(run(&with_errors(&silent)).stdout).unwrap();
    assert!(text.contains("combinations of the parameters, priors the others."), "{text}");
    for (asked, words) in [
        ("delay=-1us", "expected a standard deviation above 0"),
        ("delay=1mm", "has another dimension"),
        ("eta=1%", "are the same number"),
        ("lag=1us", "there is no number `lag`"),
    ] {
        let message = refused(&with_errors(&[&fit[..6], &["--systematic", asked]].concat()));
        assert!(message.contains(words), "{asked}: {message}");
    }
}
