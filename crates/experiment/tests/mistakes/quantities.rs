//! Numbers and their units.

use super::{DRY, after, check, line_of, only};
use crate::{Experiment, examples, film_presets, preset, presets};

#[test]
fn a_wrong_dimension_names_the_expected_unit() {
    let finding = after("\"6.35 mm\"\nmass", "\"6.35 kg\"\nmass");
    let words = ["`radius` is a mass", "a length in m", "\"6.35 mm\""];
    check(&finding, line_of("radius = \"6.35 mm\""), "\"6.35 kg\"", &words);
}

#[test]
fn a_missing_unit_is_asked_for() {
    let line = line_of("mass = \"8.54 g\"");
    let words = ["`mass` has no unit", "a mass in kg", "\"8.54 g\""];
    check(&after("\"8.54 g\"\nmaterial", "8.54\nmaterial"), line, "8.54", &words);
    check(&after("\"8.54 g\"\nmaterial", "\"8.54\"\nmaterial"), line, "\"8.54\"", &words);
}

#[test]
fn a_negative_mass_must_be_positive() {
    let finding = after("\"8.54 g\"\nmaterial", "\"-8.54 g\"\nmaterial");
    let words = ["`mass` is -8.54 g", "must be positive"];
    check(&finding, line_of("mass = \"8.54 g\""), "\"-8.54 g\"", &words);
}

#[test]
fn speeds_are_positive_and_finite() {
    let line = line_of("speed =");
    for (value, words) in [
        ("\"0 m/s\"", "must be positive"),
        ("\"-1 m/s\"", "must be positive"),
        ("\"nan\"", "not a finite number"),
        ("nan", "no unit"),
        ("inf", "no unit"),
        ("\"1e999 m/s\"", "too large"),
    ] {
        check(&after("\"0.5 m/s\"", value), line, value, &[words, "a speed in m/s"]);
    }
    let dry = preset("dry").unwrap();
    for speed in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let line = dry.chain(Some(speed)).unwrap_err().to_string();
        assert!(line.contains("expected a positive, finite speed"), "{line}");
    }
}

#[test]
fn plain_numbers_are_finite() {
    for value in ["nan", "inf", "-inf", "1e999"] {
        let finding = after("poisson_ratio = 0.3", &format!("poisson_ratio = {value}"));
        check(&finding, line_of("poisson_ratio"), value, &["not a finite number"]);
    }
}

#[test]
fn dimensionless_files_have_plain_numbers() {
    let file = "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\ncount = 5\n";
    let experiment = Experiment::from_text("test.toml", file).unwrap();
    let (chain, _) = experiment.chain(None).unwrap();
    assert_eq!((chain.beads[4].mass_kg, chain.beads[4].radius_m), (1.0, 1.0));
    assert_eq!(chain.gravity_m_s2, 0.0);
    let finding = only(&file.replace("speed = 1", "speed = \"1 m/s\""));
    check(&finding, 3, "\"1 m/s\"", &["has a unit in a dimensionless file", "a plain number"]);
}

#[test]
fn chains_have_between_one_and_many_beads() {
    let line = line_of("count = 40");
    let words = ["`count` = 0 is out of range", "from 1 to 2000000"];
    check(&after("count = 40", "count = 0"), line, "0", &words);
    check(&after("count = 40", "count = 1000000000000"), line, "1000000000000", &["out of range"]);
    check(&after("count = 40", "count = 40.5"), line, "40.5", &["not a whole number"]);
    let two = format!(
        "{DRY}\n[[beads]]\ncount = 1999961\nradius = \"1 mm\"\nmass = \"1 g\"\nmaterial = \"aisi316\"\n"
    );
    assert!(only(&two).one_line().contains("more than 2000000 beads"));
    assert!(
        only("beads = []\ncontacts = [{laws = [\"elastic_hertz\"]}]").one_line().contains("empty")
    );
    let cells = "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\nrepeat = 2000000\ncell = [{count = 2000000}]";
    assert!(only(cells).one_line().contains("more than"));
}

#[test]
fn numbers_that_no_body_has_are_refused_at_their_place() {
    for (from, to, words) in [
        ("213 GPa\"\npoisson", "1e-300 Pa\"\npoisson", "from 1 Pa to 1e21 Pa"),
        ("213 GPa\"\npoisson", "213 mPa\"\npoisson", "from 1 Pa to 1e21 Pa"),
        ("6.35 mm\"\nmass", "1e-300 m\"\nmass", "from 1 nm to 1000 km"),
        ("6.35 mm\"\nmass", "1e200 m\"\nmass", "from 1 nm to 1000 km"),
        ("8.54 g\"\nmaterial", "1e-200 g\"\nmaterial", "from 1e-30 kg to 1e25 kg"),
        ("3.2e4 Pa s", "1e90 Pa s", "from 0 to 1e24 Pa s"),
        ("speed = \"0.5 m/s", "speed = \"3e8 m/s", "from 1e-12 m/s to 1e6 m/s"),
        ("\"77 kg s/m^2\" }", "\"1e-300 kg s/m^2\" }", "from 1e-100 to 1e100 in size"),
    ] {
        let finding = after(from, to);
        let written = finding.one_line();
        assert!(written.contains(words), "{written} lacks {words}");
        let value = finding.text().trim_matches('"');
        assert!(value.len() > 4 && to.contains(value), "{written}");
    }
    let density = DRY
        .replace("mass = \"8.54 g\"\n", "")
        .replace("poisson_ratio = 0.3", "poisson_ratio = 0.3\ndensity = \"1e-300 g/cm^3\"");
    assert_eq!(only(&density).text(), "\"1e-300 g/cm^3\"");
}

#[test]
fn a_message_repeats_what_the_user_wrote() {
    let track = |value: &str| only(&format!("{DRY}\n[track]\nincline = {value}\n")).one_line();
    let line = track("\"100 deg\"");
    assert!(line.contains("`incline` is 100 deg, but must be between 0 and 90 deg"), "{line}");
    let solver = |value: &str| only(&format!("{DRY}\n[solver]\naccuracy = {value}\n")).one_line();
    assert!(solver("0.000000000000001").contains("`accuracy` is 1e-15, but"));
    assert!(solver("-1").contains("`accuracy` is -1, but must be positive"));
}

#[test]
fn nan_and_infinities_are_refused_in_every_number_of_every_experiment() {
    for file in presets().iter().chain(film_presets()).chain(examples()) {
        let experiment = Experiment::from_text(file.name, file.text).unwrap();
        for number in experiment.numbers() {
            for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let set = experiment.set(&[(&number.path, value)]);
                assert!(set.is_err(), "{} {} = {value}", file.name, number.path);
            }
        }
    }
}

#[test]
fn a_unit_system_that_suits_no_quantity_is_one_mistake() {
    let finding = only(&format!("units = \"dimensionless\"\n{DRY}"));
    let words = ["but its 11 quantities have units", "expected \"SI\""];
    check(&finding, 1, "\"dimensionless\"", &words);
    assert_eq!(finding.other_line(), Some(line_of("young_modulus") + 1));
    let plain = "[striker]\nspeed = 1\n[[beads]]\nradius = 1\nmass = 1\nmaterial = \"a\"\n\
                 [materials.a]\nyoung_modulus = 1\npoisson_ratio = 0\n\
                 [[contacts]]\nlaws = [\"elastic_hertz\"]\n";
    let finding = only(plain);
    let words = ["none of the 4 quantities", "units = \"dimensionless\""];
    check(&finding, 2, "1", &words);
}

#[test]
fn a_unit_missing_beside_others_is_a_mistake_of_its_own() {
    let text = DRY.replace("= \"6.35 mm\"", "= 6.35").replace("= \"8.54 g\"", "= 8.54");
    let mistakes = Experiment::from_text("test.toml", &text).unwrap_err();
    assert_eq!(mistakes.findings().len(), 2, "{mistakes}");
}
