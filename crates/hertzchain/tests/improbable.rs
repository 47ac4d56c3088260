//! Every verb that loads an experiment warns of what is improbable about it.

use crate::common::{HEAD, compact, file, folder, run};
use hertzchain::campaign::PreparedCampaign;
use hertzchain::options::CampaignOptions;
use hertzchain_experiment::Experiment;

const TABLE: &str = "0.2,1e-4,9.030e-4,2e-7\n0.5,1e-4,7.565e-4,2e-7\n1.0,1e-4,6.829e-4,2e-7\n";

fn warned(arguments: &[&str]) -> String {
    String::from_utf8(run(arguments).stderr).unwrap()
}

/// Steel of 210 MPa, as when a unit is wrong.
fn soft(text: &str) -> String {
    let soft = text.replace("\"213 GPa\"", "\"210 MPa\"");
    assert_ne!(soft, text);
    soft
}

#[test]
fn verbs_that_infer_and_measure_warn_of_steel_of_210_mpa_once() {
    let folder = folder("improbable");
    let data = file(&folder, "data.csv", &(HEAD.to_owned() + TABLE));
    let model = String::from_utf8(run(&["presets", "dry"]).stdout).unwrap();
    let model = file(&folder, "soft.toml", &soft(&model));
    let record = file(&folder, "empty.csv", "Time (s),V\n");
    let free = ["--free", "eta", "--accuracy", "1e-4"];
    let also = format!("{data}={model}");
    for arguments in [
        &[&["fit", &data, "--model", &model][..], &free].concat()[..],
        &[&["fit", &data, "--model", &model, "--also", &also][..], &free].concat(),
        &[&["design", &data, "--model", &model][..], &free].concat(),
        &["gauge", &data, "--dry", &data, "--dry-model", &model],
        &["measure", &record, "--rig", &model],
    ] {
        // Warnings come before what prevents the rest: a file is no folder.
        let reported = warned(&[arguments, &["--out", &data]].concat());
        assert_eq!(reported.matches("Young modulus of 210 MPa").count(), 1, "{reported}");
    }
}

#[test]
fn a_value_that_is_set_is_warned_of_as_one_in_the_file() {
    let folder = folder("improbable-set");
    let data = file(&folder, "data.csv", &(HEAD.to_owned() + TABLE));
    let fit = ["fit", &data, "-p", "dry", "--free", "eta", "--accuracy", "1e-4"];
    assert!(!warned(&fit).contains("Poisson ratio"));
    let reported = warned(&[&fit[..], &["--set", "nu=0.7"]].concat());
    assert!(reported.contains("the Poisson ratio of `aisi316` is 0.7"), "{reported}");
}

#[test]
fn a_campaign_warns_of_its_experiment() {
    let soft = Experiment::from_text("soft", &soft(&compact())).unwrap();
    let options = CampaignOptions::default();
    let prepared = PreparedCampaign::new(&soft, &options).unwrap();
    let first = &prepared.warnings[0];
    assert!(first.contains("Young modulus of 210 MPa"), "{:?}", prepared.warnings);
}

#[test]
fn rows_of_one_speed_are_one_speed() {
    let folder = folder("one-speed");
    let rows = "0.5,1e-4,7.565e-4,2e-7\n0.5,1e-4,7.566e-4,2e-7\n";
    let data = file(&folder, "data.csv", &(HEAD.to_owned() + rows));
    let fit = ["fit", &data, "-p", "dry", "--free", "eta", "--accuracy", "1e-4"];
    let text = String::from_utf8(run(&fit).stdout).unwrap();
    assert!(text.contains("2 values at 1 speed\n"), "{text}");
}
