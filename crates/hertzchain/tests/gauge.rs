//! gauge at the command line.

use crate::common::{curve, file, folder, json, run, with_errors};

#[test]
fn the_gauge_knows_its_oils_and_says_when_it_does_not() {
    let folder = folder("gauge");
    let (dry, pump) = (curve(&folder, "dry"), curve(&folder, "pump"));
    let found = json(&with_errors(&["gauge", &pump, "--dry", &dry, "--json"]));
    assert!(found["verdict"].as_str().unwrap().starts_with("It is pump oil"), "{found}");
    // A dry chain's curve is that of no oil.
    let found = json(&with_errors(&["gauge", &dry, "--dry", &dry, "--json", "--use", "incident"]));
    assert!(found["verdict"].as_str().unwrap().starts_with("None of these"), "{found}");
    assert!(found["to_add"].as_str().unwrap().contains("reflected"));
}

/// A dry row of softer beads than the model's: no viscosity makes up for that.
#[test]
fn a_dry_curve_that_is_not_its_models_is_told_before_all_else() {
    let folder = folder("gauge-doubt");
    let pump = curve(&folder, "pump");
    let softer = String::from_utf8(run(&["presets", "dry"]).stdout).unwrap();
    assert!(softer.contains("\"213 GPa\""));
    let softer = file(&folder, "softer.toml", &softer.replace("213 GPa", "200 GPa"));
    let out = folder.join("softer");
    let out = out.to_str().unwrap();
    let sweep = ["sweep", &softer, "--speeds", "log:0.1:1.2:6", "--out", out];
    assert!(run(&sweep).status.success());
    let reported = |dry: &str| {
        let gauge = [
            "gauge",
            &pump,
            "--dry",
            dry,
            "--use",
            "incident",
            "-p",
            "pump",
            "--dry-preset",
            "dry",
        ];
        String::from_utf8(run(&with_errors(&gauge)).stdout).unwrap()
    };
    let text = reported(&format!("{out}/sweep.csv"));
    let first = text.lines().next().unwrap();
    assert!(first.starts_with("warning: of the dry curve"), "{text}");
    assert!(first.contains("the model does not follow the data"), "{text}");
    let second = text.lines().nth(1).unwrap();
    assert!(second.contains("check that --dry names"), "{text}");
    // Under the verdict, where a long table ends, it is said again.
    let last = text.lines().last().unwrap();
    assert!(last.starts_with("warning: see the first lines"), "{text}");
    let text = reported(&curve(&folder, "dry"));
    assert!(!text.contains("warning"), "{text}");
}
