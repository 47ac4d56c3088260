//! The drawing of the rig says what the experiment file says, and nothing else.

use crate::figures;
use hertzchain_experiment::Experiment;

const MOTOR: &str = include_str!("../../../experiments/motor.toml");

/// Every text of the drawing of a file, lines of a label joined.
fn texts(file: &str) -> String {
    let experiment = Experiment::from_text("test.toml", file).unwrap();
    let svg = figures::rig::rig(&experiment).unwrap().figure().svg();
    let document = roxmltree::Document::parse(&svg).unwrap();
    let labels = document.descendants().filter_map(|n| n.attribute("aria-label"));
    let joined: Vec<&str> = labels.collect();
    joined.join(" ").replace('\u{a0}', " ")
}

fn changed(from: &str, to: &str) -> String {
    assert!(MOTOR.contains(from), "{from}");
    texts(&MOTOR.replacen(from, to, 1))
}

/// A number of the file, another one, and how the drawing writes both.
const NUMBERS: [(&str, &str, &str, &str); 10] = [
    ("radius = \"6.35 mm\"", "radius = \"6.4 mm\"", "R = 6.35 mm", "R = 6.4 mm"),
    ("mass = \"8.54 g\"", "mass = \"8.6 g\"", "m = 8.54 g", "m = 8.6 g"),
    ("count = 40", "count = 39", "40 beads", "39 beads"),
    ("\"0.5 m/s\"", "\"0.7 m/s\"", "v0 = 0.5 m/s", "v0 = 0.7 m/s"),
    ("bead = 7", "bead = 8", "split bead n = 7", "split bead n = 8"),
    ("force = \"0.24 N\"", "force = \"300 mN\"", "F = 0.24 N", "F = 0.3 N"),
    ("mass = \"4.5 kg\"", "mass = \"5200 g\"", "structure, 4.5 kg", "structure, 5.2 kg"),
    ("mass = \"6 kg\"", "mass = \"7.5 kg\"", "noise, 6 kg", "noise, 7.5 kg"),
    ("bits = 16", "bits = 12", "16-bit ADC", "12-bit ADC"),
    ("rate = \"500 kHz\"", "rate = \"1 MHz\"", "500 kHz", "1000 kHz"),
];

#[test]
fn every_number_of_the_drawing_is_that_of_the_file() {
    let before = texts(MOTOR);
    for (from, to, old, new) in NUMBERS {
        let after = changed(from, to);
        assert!(before.contains(old) && !before.contains(new), "{before}");
        assert!(after.contains(new) && !after.contains(old), "{after}");
    }
}

#[test]
fn the_parts_of_the_rig_are_named_as_in_the_file_and_gone_with_their_line() {
    let table = MOTOR.split_once("[rig]").unwrap().1;
    let parts: Vec<(&str, &str)> = table
        .lines()
        .filter_map(|line| {
            let name = line.split("name = \"").nth(1)?.split('"').next()?;
            Some((line, name))
        })
        .collect();
    assert_eq!(parts.len(), 9);
    let whole = texts(MOTOR);
    for (line, name) in parts {
        assert!(whole.contains(name), "{name} in {whole}");
        assert!(!changed(line, "").contains(name), "{name}");
        let renamed = line.replacen(&format!("\"{name}\""), "\"thing\"", 1);
        assert!(changed(line, &renamed).contains("thing"), "{name}");
    }
}

#[test]
fn without_a_description_only_what_is_computed_with_is_drawn() {
    let bare = texts(MOTOR.split_once("[rig]").unwrap().0);
    for absent in ["actuator", "AISI", "kg", "F =", "ADC", "piezo", "photogate"] {
        assert!(!bare.contains(absent), "{absent} in {bare}");
    }
    for present in ["rigid wall", "40 beads", "motor oil", "striker", "half-bead"] {
        assert!(bare.contains(present), "{present} in {bare}");
    }
}

#[test]
fn what_the_model_computes_with_is_drawn_in_place_of_the_description() {
    let pushed = format!("{MOTOR}\n[near_end]\npush = \"constant\"\nforce = \"0.5 N\"\n");
    let found = texts(&pushed);
    assert!(found.contains("F = 0.5 N") && !found.contains("0.24 N"), "{found}");
    let moving = changed("kind = \"half-bead\"", "kind = \"stop\"\nmass = \"3 kg\"");
    assert!(moving.contains("structure, 3 kg"), "{moving}");
}
