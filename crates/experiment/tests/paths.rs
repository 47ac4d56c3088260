//! Named numbers: found, read, set.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::{Experiment, PathError, examples, film_presets, preset, presets};
use hertzchain_chain::{BeadPair, Start};

#[test]
fn every_number_of_every_file_is_found_by_its_path_and_can_be_set_to_itself() {
    for file in presets().iter().chain(film_presets()).chain(examples()) {
        let experiment = preset(file.name).unwrap();
        let numbers = experiment.numbers();
        assert!(numbers.len() > 5, "{}: {numbers:?}", file.name);
        let before = format!("{:?}", experiment.chain(None).unwrap().0);
        for number in numbers {
            let value = number.value.unwrap();
            assert_eq!(experiment.get(&number.path).unwrap(), value);
            let same = experiment.set(&[(&number.path, value)]).unwrap();
            assert_eq!(format!("{:?}", same.chain(None).unwrap().0), before, "{}", number.path);
        }
    }
}

#[test]
fn paths_are_keys_joined_by_points_and_laws_by_name() {
    let pump = preset("pump").unwrap();
    for (path, value, unit) in [
        ("materials.aisi316.young_modulus", 213e9, "Pa"),
        ("materials.pump-oil.poisson_ratio.exponent", -0.274, "1"),
        ("materials.pump-oil.shear_viscosity.prefactor", 81405.3, "Pa s"),
        ("contacts[0].laws.damping_cubic.coefficient", 77.0, "kg s/m^2"),
        ("striker.speed", 0.5, "m/s"),
        ("beads[0].radius", 0.00635, "m"),
        ("sensors.bead", 7.0, "1"),
    ] {
        let number = pump.numbers().into_iter().find(|n| n.path == path).unwrap();
        assert_eq!((number.value, number.unit.as_str()), (Some(value), unit));
    }
}

#[test]
fn an_end_of_a_path_is_enough_where_it_fits_one_number() {
    let pump = preset("pump").unwrap();
    assert_eq!(pump.get("damping_cubic.coefficient").unwrap(), 77.0);
    assert_eq!(pump.get("coefficient").unwrap(), 77.0);
    assert_eq!(pump.get("pump-oil.young_modulus").unwrap(), 216e9);
    let error = pump.get("young_modulus").unwrap_err().to_string();
    assert!(
        error.contains("materials.aisi316.young_modulus") && error.contains("pump-oil"),
        "{error}"
    );
    let error = pump.get("damping_cubic.coeficient").unwrap_err().to_string();
    assert!(error.contains("did you mean `contacts[0].laws.damping_cubic.coefficient`"), "{error}");
    assert!(matches!(pump.get("track.incline"), Err(PathError::NotGiven { .. })));
}

#[test]
fn what_the_file_leaves_out_can_be_set_too() {
    let dry = preset("dry").unwrap();
    let set = dry
        .set(&[
            ("track.incline", 0.01),
            ("damping_viscoelastic.relaxation_time", 2e-7),
            ("elastic_hertz.stiffness", 5e9),
            ("striker.mass", 0.02),
            ("solver.accuracy", 1e-9),
        ])
        .unwrap();
    let (chain, _) = set.chain(None).unwrap();
    assert_eq!(chain.incline_rad, 0.01);
    assert_eq!(set.solver().accuracy, 1e-9);
    assert!(matches!(chain.start, Start::Striker { bead, .. } if bead.mass_kg == 0.02));
    let pair = BeadPair {
        left: chain.beads[0].material,
        right: chain.beads[0].material,
        radius_m: 0.003,
        mass_kg: 0.004,
    };
    let k = |at: usize| chain.sections[0].laws[at].coefficients(&pair).unwrap();
    // The damping's K is that of the contact.
    assert_eq!((k(0), k(1)[0]), (vec![5e9], 1.5 * 2e-7 * 5e9));
    assert_eq!(
        dry.get("track.incline").unwrap_err().to_string(),
        "`track.incline` is not given in the file"
    );
}

#[test]
fn a_place_for_a_number_is_known_before_the_file_fills_it() {
    let dry = preset("dry").unwrap();
    let stiffness = dry.place("elastic_hertz.stiffness").unwrap();
    assert_eq!(stiffness.path, "contacts[0].laws.elastic_hertz.stiffness");
    assert_eq!((stiffness.value, stiffness.unit.as_str()), (None, "N/m^(3/2)"));
    let cubic = dry.place("coefficient").unwrap();
    assert_eq!(cubic.value, Some(77.0));
    assert!(dry.places().contains(&cubic));
    assert!(dry.place("beads[0].count").unwrap().is_count);
    assert!(dry.place("hardness").is_err());
}

#[test]
fn an_unfit_value_is_a_report_at_its_place_in_the_file() {
    let dry = preset("dry").unwrap();
    let Err(PathError::Mistakes(mistakes)) = dry.set(&[("beads[0].mass", -1.0)]) else {
        panic!("a mistake")
    };
    let finding = &mistakes.findings()[0];
    assert_eq!(finding.text(), "\"8.54 g\"");
    assert!(finding.one_line().contains("`mass` is -1 kg, but must be positive"));
    assert!(dry.set(&[("beads[0].count", 39.5)]).is_err());
    assert!(dry.with_speed(0.0).is_err() && dry.with_speed(f64::NAN).is_err());
    assert_eq!(dry.with_speed(1.2).unwrap().speed_m_s(), Some(1.2));
}

#[test]
fn text_is_read_as_in_the_file() {
    let dry = preset("dry").unwrap();
    let set = dry.set_text(&[("radius", "5 mm"), ("poisson_ratio", "0.25")]).unwrap();
    assert_eq!(
        (set.get("beads[0].radius").unwrap(), set.get("poisson_ratio").unwrap()),
        (0.005, 0.25)
    );
    let error = dry.set_text(&[("radius", "5")]).unwrap_err().to_string();
    assert!(error.contains("`radius` has no unit"), "{error}");
}

#[test]
fn printed_digits_tell_what_rounding_hides() {
    let pump = preset("pump").unwrap();
    let half = |path: &str| {
        let number = pump.numbers().into_iter().find(|n| n.path.ends_with(path));
        number.unwrap().half_digit
    };
    assert_eq!(half("pump-oil.young_modulus"), 0.5e9);
    assert_eq!(half("poisson_ratio.prefactor"), 0.0005);
    assert_eq!(half("shear_viscosity.exponent"), 0.0005);
    assert_eq!(half("shear_viscosity.prefactor"), 0.05);
    assert_eq!(half("liquid.density"), 0.5);
}

#[test]
fn overrides_do_not_touch_the_experiment_they_start_from() {
    let dry = preset("dry").unwrap();
    let text = format!("{:?}", dry.chain(None).unwrap().0);
    let _changed = dry.set(&[("poisson_ratio", 0.2)]).unwrap();
    assert_eq!(format!("{:?}", dry.chain(None).unwrap().0), text);
    let file = Experiment::from_text("dry.toml", dry.text()).unwrap();
    assert_eq!(format!("{:?}", file.chain(None).unwrap().0), text);
}

#[test]
fn a_case_that_was_chosen_stays_when_numbers_are_set() {
    let paper = preset("paper").unwrap();
    let gear = paper.case("gear").unwrap().unwrap();
    let slower = gear.with_speed(0.3).unwrap();
    let laws = |experiment: &crate::Experiment| {
        let (chain, _) = experiment.chain(Some(0.3)).unwrap();
        format!("{:?}", chain.sections)
    };
    assert_eq!(laws(&slower), laws(&gear));
    assert_ne!(laws(&slower), laws(&paper.case("dry").unwrap().unwrap()));
}

#[test]
fn the_number_of_a_stiffness_is_kept_in_the_unit_of_an_exponent_that_is_set_alone() {
    let row = preset("exponent-section").unwrap();
    let stiffness = "contacts[1].laws.elastic_power.stiffness";
    let followers = row.followers("exponent").unwrap();
    assert_eq!(followers.len(), 1);
    assert_eq!((followers[0].path.as_str(), followers[0].unit.as_str()), (stiffness, "N/m^2"));
    assert_eq!(row.followers(stiffness).unwrap(), []);
    let set = row.set(&[("exponent", 1.9)]).unwrap();
    let written = row.set_text(&[("exponent", "1.9")]).unwrap();
    for changed in [&set, &written] {
        assert_eq!(changed.get("exponent").unwrap(), 1.9);
        let place = changed.place(stiffness).unwrap();
        assert_eq!((place.value, place.unit.as_str()), (Some(2.5e12), "N/m^1.9"));
    }
    // Both at once: the text is checked against the exponent that is to be.
    let both = [("exponent", "1.9"), (stiffness, "3e12 N/m^1.9")];
    assert_eq!(row.set_text(&both).unwrap().get(stiffness).unwrap(), 3e12);
    let wrong = [("exponent", "1.9"), (stiffness, "3e12 N/m^2")];
    assert!(row.set_text(&wrong).is_err());
}
