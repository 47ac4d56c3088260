//! Materials and masses.

use super::{DRY, after, check, line_of, only};
use hertzchain_experiment::{Experiment, preset};
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
    check(
        &warnings[0],
        line_of("poisson_ratio"),
        "0.6",
        &["above 1/2", "below 1"],
    );
    assert_eq!(warnings[0].severity(), Some(miette::Severity::Warning));
}

#[test]
fn a_power_law_beyond_its_limits_is_found_at_the_speed_of_the_shot() {
    let pump = preset("pump").unwrap();
    let mistakes = pump.chain(Some(0.01)).unwrap_err();
    let line = mistakes.findings()[0].one_line();
    assert!(
        line.contains("Poisson ratio is 1.1") && line.contains("at 0.01 m/s"),
        "{line}"
    );
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
    assert!(
        finding.one_line().contains("`density` in the material"),
        "{}",
        finding.one_line()
    );
    let finding = after(
        "speed = \"0.5 m/s\"",
        "speed = \"0.5 m/s\"\nradius = \"1 cm\"",
    );
    assert!(finding.one_line().contains("the striker has no mass"));
}

#[test]
fn either_all_beads_have_a_material_or_none() {
    let mixed = "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\n\
                 [materials.a]\nyoung_modulus = 1\npoisson_ratio = 0\n[[beads]]\nmaterial = \"a\"\n";
    assert!(
        only(mixed)
            .one_line()
            .contains("no material, but others do")
    );
}
