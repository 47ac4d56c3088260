//! Which model a fit has, which contact its numbers belong to, and what no model explains.

use crate::common::{curve, file, folder, json, refused, run, with_errors};

fn text(arguments: &[&str]) -> String {
    String::from_utf8(run(arguments).stdout).unwrap()
}

#[test]
fn a_model_that_is_not_named_is_stated_in_the_first_line_and_in_json() {
    let folder = folder("no-model");
    let data = curve(&folder, "dry");
    let fit = ["fit", &data, "--free", "eta"];
    let design = ["design", &data, "--free", "eta", "--picks", "1"];
    let out = folder.join("shards");
    let sweep = ["sweep", "--speeds", "0.4,0.5"];
    let part = ["--shard", "1/2", "--out", out.to_str().unwrap()];
    let part = [&sweep[..], &part].concat();
    let verbs: [&[&str]; 6] = [&["shot"], &["theory"], &sweep, &part, &fit, &design];
    for verb in verbs {
        let errors = match verb.contains(&data.as_str()) {
            true => with_errors(verb),
            false => verb.to_vec(),
        };
        let report = text(&errors);
        let first = report.lines().next().unwrap();
        assert!(
            first.contains("the paper's dry chain is assumed (preset dry"),
            "{verb:?}: {first}"
        );
        if verb != ["theory"] && verb != part {
            let found = json(&[&errors[..], &["--json"]].concat());
            assert_eq!(found["assumed_model"].as_str(), Some(first));
        }
        let named = text(&[&errors[..], &["-p", "dry"]].concat());
        assert!(!named.contains("assumed"), "{named}");
    }
}

#[test]
fn a_gauge_states_both_models_that_are_not_named_and_a_campaign_wants_one() {
    let folder = folder("no-models");
    let data = curve(&folder, "dry");
    let gauge = with_errors(&["gauge", &data, "--dry", &data, "--use", "incident"]);
    let report = text(&gauge);
    let first = report.lines().next().unwrap();
    assert!(first.contains("(preset pump") && first.contains("(preset dry"), "{first}");
    let wet = text(&[&gauge[..], &["-p", "pump"]].concat());
    let first = wet.lines().next().unwrap();
    assert!(!first.contains("(preset pump") && first.contains("(preset dry"), "{first}");
    let out = folder.join("records");
    let why = refused(&["campaign", "--out", out.to_str().unwrap()]);
    assert!(why.contains("Name an experiment file"), "{why}");
}

/// Beads of two sizes before a plane.
const UNLIKE: &str = "title = \"Dimers before a plane\"\n[materials.steel]\nyoung_modulus = \"200 GPa\"\n\
    poisson_ratio = 0.3\ndensity = \"7.8 g/cm^3\"\nshear_viscosity = \"3e4 Pa s\"\n[striker]\nspeed = \"0.5 m/s\"\n\
    [[beads]]\nrepeat = 7\ncell = [{ radius = \"5 mm\", material = \"steel\" }, \
    { radius = \"4 mm\", material = \"steel\" }]\n[sensors]\nbead = 3\n[far_end]\nkind = \"plane\"\n\
    [[contacts]]\nlaws = [\"elastic_hertz\", \"damping_viscoelastic\"]\n";

#[test]
fn a_fit_of_k_and_a_names_their_contact() {
    let folder = folder("reference");
    let row = file(&folder, "row.toml", UNLIKE);
    let out = folder.join("swept");
    let swept = run(&["sweep", &row, "--speeds", "log:0.1:1:6", "-o", out.to_str().unwrap()]);
    assert!(swept.status.success());
    let data = out.join("sweep.csv").to_str().unwrap().to_owned();
    let fit = ["fit", &data, "-m", &row, "--free", "K,A"];
    let report = text(&with_errors(&fit));
    for name in ["K", "A"] {
        let words = format!("{name} is that of contact 1 (beads 1 and 2); contacts 0 to 14 ");
        assert!(report.contains(&words), "{report}");
    }
    let found = json(&with_errors(&[&fit[..], &["--json"]].concat()));
    let reference = &found["references"][0];
    assert_eq!((&reference["name"], &reference["contact"]), (&"K".into(), &1.into()));
    // The last bead's radius of 4 mm at the plane, over 4 · 5/9 mm between beads.
    let most = reference["ratios"][1].as_f64().unwrap();
    assert!((most - 1.8_f64.sqrt()).abs() < 1e-12, "{most}");
    assert!(found["chi_square"]["probability"].as_f64().unwrap() > 0.999);
}

#[test]
fn of_models_that_do_not_follow_the_data_none_is_favoured() {
    let folder = folder("bad-models");
    let data = curve(&folder, "dry");
    let fit = ["fit", &data, "-p", "hertz", "--free", "Y", "--against", "hertz-viscoelastic=eta"];
    let report = text(&with_errors(&fit));
    assert!(report.contains("No model follows the data"), "{report}");
    let found = json(&with_errors(&[&fit[..], &["--json"]].concat()));
    assert!(found["comparison"]["favoured"].is_null());
    for model in found["comparison"]["models"].as_array().unwrap() {
        assert_eq!(model["freedom"], 11);
        assert!(model["probability"].as_f64().unwrap() < 1e-3, "{model}");
    }
    // Other starts were tried, as the report says.
    assert!(report.contains("so 7 others were tried"), "{report}");
}
