//! The table of what stands around the chain: read, checked, without effect.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::{Experiment, Finding, RigPartKind, preset, schema};

const DRY: &str = include_str!("../../../experiments/dry.toml");

fn opened(text: &str) -> Experiment {
    Experiment::from_text("test.toml", text).unwrap()
}

fn without_rig() -> Experiment {
    opened(DRY.split("[rig]").next().unwrap())
}

/// The only mistake after a replacement.
fn after(from: &str, to: &str) -> Finding {
    assert!(DRY.contains(from), "{from}");
    let mistakes = Experiment::from_text("test.toml", &DRY.replacen(from, to, 1)).unwrap_err();
    assert_eq!(mistakes.findings().len(), 1, "{mistakes}");
    mistakes.findings()[0].clone()
}

#[test]
fn the_presets_of_the_paper_name_every_part_of_its_rig() {
    for name in ["dry", "pump", "gear", "motor"] {
        let experiment = preset(name).unwrap();
        let rig = experiment.rig().unwrap();
        for kind in RigPartKind::ALL {
            assert!(rig.part(kind).is_some(), "{name} has no {kind:?}");
        }
        assert_eq!(rig.part(RigPartKind::Springs).unwrap().force_n, Some(0.24));
        assert_eq!(rig.part(RigPartKind::Bar).unwrap().mass_kg, Some(6.0));
    }
}

#[test]
fn a_part_is_there_when_it_is_named_and_has_a_name_of_its_own() {
    let text = DRY.replace("photogate = { name = \"photogate\" }", "photogate = {}");
    let rig = opened(&text).rig().cloned().unwrap();
    assert_eq!(rig.part(RigPartKind::Photogate).unwrap().name, "photogate");
    let text = text.replace("photogate = {}", "");
    assert!(opened(&text).rig().unwrap().part(RigPartKind::Photogate).is_none());
    assert!(without_rig().rig().is_none());
}

#[test]
fn nothing_is_computed_from_the_rig() {
    let (with, without) = (opened(DRY), without_rig());
    let chain = |experiment: &Experiment| format!("{:?}", experiment.chain(None).unwrap().0);
    assert_eq!(chain(&with), chain(&without));
    assert_eq!(with.sensors(), without.sensors());
    assert_eq!(with.numbers(), without.numbers());
    // A name that fits a number of the model alone stays unambiguous.
    assert_eq!(with.get("mass").unwrap(), without.get("mass").unwrap());
}

#[test]
fn mistakes_in_the_rig_are_told_at_their_place() {
    let of_dimension = after("mass = \"6 kg\"", "mass = \"6 m\"");
    assert_eq!(of_dimension.text(), "\"6 m\"");
    let negative = after("force = \"0.24 N\"", "force = \"-0.24 N\"");
    assert_eq!(negative.text(), "\"-0.24 N\"");
    let unknown = after("photogate = {", "fotogate = {");
    assert_eq!(unknown.text(), "fotogate");
    assert!(unknown.one_line().contains("`photogate`"), "{unknown:?}");
    let foreign = after("bits = 16", "mass = \"1 kg\"");
    assert!(foreign.one_line().contains("[rig.recorder]"), "{foreign:?}");
    let word = after("stop = { name = \"steel stop\" }", "stop = \"steel stop\"");
    assert!(word.one_line().contains("expected a table"), "{word:?}");
}

#[test]
fn the_schema_says_that_the_rig_computes_nothing() {
    let rig = &schema()["else"]["properties"]["rig"];
    let about = rig["description"].as_str().unwrap();
    assert!(about.contains("computes nothing"), "{about}");
    assert!(rig["properties"]["bar"]["properties"]["mass"].is_object());
}
