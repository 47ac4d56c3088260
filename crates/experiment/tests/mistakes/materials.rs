//! Materials and masses.

use super::{DRY, after, check, line_of, only};
use crate::{Experiment, preset};
use miette::Diagnostic;

#[test]
fn poisson_ratios_end_at_one() {
    for value in ["1.0", "1.2", "-1.0", "-3"] {
        let finding = after("poisson_ratio = 0.3", &format!("poisson_ratio = {value}"));
        let words = ["`poisson_ratio` is", "between -1 and 1"];
        check(&finding, line_of("poisson_ratio"), value, &words);
    }
    let text = DRY.replace("poisson_ratio = 0.3", "poisson_ratio = 0.6");
    let experiment = Experiment::from_text("test.toml", &text).unwrap();
    let (_, warnings) = experiment.chain(None).unwrap();
    check(&warnings[0], line_of("poisson_ratio"), "0.6", &["above 1/2", "below 1"]);
    assert_eq!(warnings[0].severity(), Some(miette::Severity::Warning));
}

#[test]
fn a_power_law_beyond_its_limits_is_found_at_the_speed_of_the_shot() {
    let pump = preset("pump").unwrap();
    let mistakes = pump.chain(Some(0.01)).unwrap_err();
    let line = mistakes.findings()[0].one_line();
    assert!(line.contains("Poisson ratio is 1.1") && line.contains("at 0.01 m/s"), "{line}");
    assert!(line.contains("between -1 and 1"), "{line}");
}

#[test]
fn materials_without_use_are_a_warning() {
    let text =
        format!("{DRY}\n[materials.brass]\nyoung_modulus = \"100 GPa\"\npoisson_ratio = 0.35\n");
    let experiment = Experiment::from_text("test.toml", &text).unwrap();
    let (_, warnings) = experiment.chain(None).unwrap();
    assert_eq!(warnings.len(), 1);
    assert_eq!(warnings[0].text(), "brass");
}

#[test]
fn beads_need_a_mass_or_a_density() {
    let finding = after("mass = \"8.54 g\"\n", "");
    assert!(finding.one_line().contains("`density` in the material"), "{}", finding.one_line());
    let finding = after("speed = \"0.5 m/s\"", "speed = \"0.5 m/s\"\nradius = \"1 cm\"");
    assert!(finding.one_line().contains("the striker has no mass"));
}

#[test]
fn either_all_beads_have_a_material_or_none() {
    let mixed = "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\n\
                 [materials.a]\nyoung_modulus = 1\npoisson_ratio = 0\n[[beads]]\nmaterial = \"a\"\n";
    assert!(only(mixed).one_line().contains("no material, but others do"));
}

#[test]
fn a_material_that_is_not_there_is_told_what_is() {
    let line = line_of("material = ");
    let named = |name: &str| after("material = \"aisi316\"", &format!("material = \"{name}\""));
    for (name, words) in [
        ("AISI 316", "did you mean `aisi316`"),
        ("aisi316 ", "did you mean `aisi316`"),
        ("materials.aisi316", "did you mean `aisi316`"),
        ("steel", "no material is built in; write a table [materials.steel]"),
        ("stainless steel", "[materials.\"stainless steel\"]"),
        ("", "expected \"aisi316\", the file's only material"),
    ] {
        check(&named(name), line, &format!("\"{name}\""), &[words, "\"aisi316\""]);
    }
}

#[test]
fn a_material_that_is_no_name_is_told_the_names() {
    let second = "\n[materials.brass]\nyoung_modulus = \"100 GPa\"\npoisson_ratio = 0.35\n";
    for value in ["316", "true", "[\"aisi316\"]", "{ name = \"aisi316\" }", "1979-05-27"] {
        for (place, key) in [
            ("material = \"aisi316\"", ""),
            ("speed = \"0.5 m/s\"", "speed = \"0.5 m/s\"\nmass = \"1 g\"\n"),
            ("[[contacts]]\n", "[[contacts]]\n"),
            ("kind = \"half-bead\"", "kind = \"half-bead\"\n"),
        ] {
            let text = DRY.replacen(place, &format!("{key}material = {value}\n"), 1);
            let finding = only(&format!("{text}{second}"));
            let line = finding.one_line();
            assert_eq!(finding.text(), value, "{line}");
            let words = "one of the file's materials: \"aisi316\", \"brass\"";
            assert!(line.contains(words), "{line}");
        }
    }
    let finding = after("material = \"aisi316\"", "material = { poisson_ratio = 0.3 }");
    assert!(finding.one_line().contains("[materials.NAME]"), "{}", finding.one_line());
}

#[test]
fn a_table_of_a_material_with_a_wrong_name_is_told_the_right_one() {
    let line = line_of("[materials.aisi316]");
    let named = |header: &str| after("[materials.aisi316]", header);
    for (header, text, words) in [
        ("[material.aisi316]", "material", "did you mean `materials`"),
        ("[Materials.aisi316]", "Materials", "did you mean `materials`"),
        ("[aisi316]", "aisi316", "a material is written [materials.aisi316]"),
        ("[materials.aisi316.x]", "x", "expected one name: [materials.x]"),
    ] {
        check(&named(header), line, text, &[words]);
    }
    for (header, right) in [
        ("[materials.aisi 316]", "[materials.\"aisi 316\"]"),
        ("[materials aisi316]", "[materials.aisi316]"),
        ("[materials.äisi316]", "[materials.\"äisi316\"]"),
    ] {
        check(&named(header), line, header, &[&format!("expected {right}")]);
    }
    let finding = named("[materials.aisi361]");
    let words = ["no material `aisi316`", "did you mean `aisi361`"];
    check(&finding, line_of("material = "), "\"aisi316\"", &words);
}
