//! A switch changes what it says and nothing else.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::{Experiment, Pick, Reading, preset, presets};
use hertzchain_chain::{Chain, FarEnd, Push, Sensor, Tension};

fn in_reading(name: &str, switches: &[(&str, &str)]) -> Experiment {
    let reading = switches
        .iter()
        .try_fold(Reading::default(), |reading, (switch, option)| reading.with(switch, option));
    preset(name).unwrap().with_reading(&reading.unwrap()).unwrap()
}

fn chain(name: &str, switches: &[(&str, &str)]) -> Chain {
    in_reading(name, switches).chain(Some(0.3)).unwrap().0
}

/// The chain as text, but for one part.
fn rest(mut chain: Chain, part: &str) -> String {
    let default = chain_default();
    match part {
        "push" => chain.push = default.push,
        "incline" => chain.incline_rad = default.incline_rad,
        "tension" => chain.tension = default.tension,
        "far" => chain.far = default.far,
        "sections" => chain.sections = default.sections,
        "beads" => {
            chain.beads = default.beads;
            chain.sections = default.sections;
        }
        _ => panic!("{part}"),
    }
    format!("{chain:?}")
}

fn chain_default() -> Chain {
    chain("pump", &[])
}

fn changes_only(part: &str, switches: &[(&str, &str)]) -> Chain {
    let changed = chain("pump", switches);
    assert_ne!(format!("{changed:?}"), format!("{:?}", chain_default()));
    assert_eq!(rest(changed.clone(), part), format!("{:?}", chain_default()));
    changed
}

/// Range, law names and whether a material is set, of each section.
fn sections(chain: &Chain) -> Vec<(usize, usize, Vec<&'static str>, bool)> {
    chain
        .sections
        .iter()
        .map(|s| {
            let names = s.laws.iter().map(|law| law.info().name).collect();
            (*s.contacts.start(), *s.contacts.end(), names, s.material.is_some())
        })
        .collect()
}

const DRY: [&str; 3] = ["elastic_hertz", "damping_viscoelastic", "damping_cubic"];
const WET: [&str; 2] = ["elastic_hertz", "damping_viscoelastic"];

#[test]
fn every_option_of_every_switch_can_be_chosen_by_name_in_every_preset() {
    for file in presets() {
        for switch in Reading::switches() {
            assert_eq!(Reading::default().get(switch.name), Some(switch.options[0]));
            for option in switch.options {
                let experiment = in_reading(file.name, &[(switch.name, option)]);
                assert_eq!(experiment.reading().get(switch.name), Some(*option));
                experiment.chain(Some(1.0)).unwrap();
                let text = format!("[reading]\n{} = \"{option}\"\n", switch.name);
                let bare = file.text.split("[reading]").next().unwrap();
                let read = Experiment::from_text("test.toml", &format!("{bare}\n{text}")).unwrap();
                let expected = format!("{:?}", experiment.chain(Some(1.0)).unwrap().0);
                assert_eq!(format!("{:?}", read.chain(Some(1.0)).unwrap().0), expected);
            }
        }
    }
}

#[test]
fn the_default_reading_is_the_file_as_written() {
    let pump = chain_default();
    assert_eq!(sections(&pump), [(0, 6, DRY.to_vec(), false), (7, 40, WET.to_vec(), true)]);
    assert_eq!(pump.push, Push::None);
    assert_eq!((pump.incline_rad, pump.tension), (0.0, Tension::Allowed));
    assert_eq!(Reading::default().to_string(), "default reading");
}

#[test]
fn surroundings_change_alone() {
    let spring = changes_only("push", &[("preload", "spring")]);
    assert!(matches!(spring.push, Push::Spring { force_n, .. } if force_n == 0.24));
    let constant = changes_only("push", &[("preload", "constant")]);
    assert_eq!(constant.push, Push::Constant { force_n: 0.24 });
    let half = changes_only("incline", &[("incline", "0.5 deg")]);
    assert_eq!(half.incline_rad, 0.5f64.to_radians());
    let clipped = changes_only("tension", &[("tension", "clipped")]);
    assert_eq!(clipped.tension, Tension::Clipped);
}

#[test]
fn the_wall_changes_alone() {
    let heavy = changes_only("far", &[("stop", "4.5 kg")]);
    assert!(matches!(heavy.far, FarEnd::Stop { mass_kg, .. } if mass_kg == 4.5));
    let plane = changes_only("far", &[("wall_shape", "plane")]);
    assert!(matches!(plane.far, FarEnd::Plane { .. }));
    let both = changes_only("far", &[("wall_shape", "plane"), ("stop", "4.5 kg")]);
    assert!(matches!(both.far, FarEnd::PlaneStop { mass_kg, .. } if mass_kg == 4.5));
}

#[test]
fn laws_and_wet_contacts_change_alone() {
    let changed = |switches: &[(&str, &str)]| sections(&changes_only("sections", switches));
    let wet = || WET.to_vec();
    let dry = || DRY.to_vec();
    let without = changed(&[("dry_cubic_beside_wet", "without")]);
    assert_eq!(without, [(0, 6, wet(), false), (7, 40, wet(), true)]);
    let contact = changed(&[("contact_6", "wet")]);
    assert_eq!(contact, [(0, 5, dry(), false), (6, 40, wet(), true)]);
    let everywhere = changed(&[("wet_everywhere", "yes")]);
    assert_eq!(everywhere, [(0, 40, wet(), true)]);
    let wall = changed(&[("wall_liquid", "dry")]);
    assert_eq!(wall, [(0, 6, dry(), false), (7, 39, wet(), true), (40, 40, dry(), false)]);
    let always = changed(&[("cubic_gate", "always")]);
    let ungated = vec!["elastic_hertz", "damping_viscoelastic", "damping_cubic_ungated"];
    assert_eq!(always[0].2, ungated);
    let three = changed(&[
        ("wet_everywhere", "yes"),
        ("wall_liquid", "dry"),
        ("dry_cubic_beside_wet", "without"),
    ]);
    assert_eq!(three, [(0, 39, wet(), true), (40, 40, wet(), false)]);
}

#[test]
fn switches_of_wet_contacts_leave_a_dry_chain_alone() {
    let dry = format!("{:?}", chain("dry", &[]));
    for (switch, option) in [
        ("dry_cubic_beside_wet", "without"),
        ("contact_6", "wet"),
        ("wet_everywhere", "yes"),
        ("wall_liquid", "dry"),
        ("poisson", "bounded"),
    ] {
        assert_eq!(format!("{:?}", chain("dry", &[(switch, option)])), dry, "{switch}");
    }
}

#[test]
fn materials_change_alone() {
    let pump = preset("pump").unwrap();
    let bounded = in_reading("pump", &[("poisson", "bounded")]);
    let (chain, warnings) = bounded.chain(Some(0.1)).unwrap();
    assert_eq!(chain.sections[1].material.unwrap().poisson_ratio, 0.5);
    assert!(warnings.is_empty());
    // Far below 0.18 m/s the bound even saves what would exceed 1.
    assert!(bounded.chain(Some(0.005)).is_ok() && pump.chain(Some(0.005)).is_err());
    let zero = chain_of(&in_reading("pump", &[("bulk_viscosity", "zero")]));
    let written = chain_of(&pump);
    let mut oil = written.sections[1].material.unwrap();
    oil.bulk_viscosity_pa_s = 0.0;
    assert_eq!(zero.sections[1].material.unwrap(), oil);
    assert_eq!(zero.beads[0].material.bulk_viscosity_pa_s, 0.0);
    assert_eq!(zero.beads[0].material.shear_viscosity_pa_s, 3.2e4);
}

fn chain_of(experiment: &Experiment) -> Chain {
    experiment.chain(Some(0.3)).unwrap().0
}

#[test]
fn counting_moves_the_ends_the_sensor_and_the_oil() {
    let within = in_reading("pump", &[("striker", "within")]);
    assert_eq!((within.beads(), within.sensor_bead()), (39, 7));
    assert_eq!(sections(&chain_of(&within))[1].1, 39);
    let half = in_reading("pump", &[("half_bead", "within"), ("striker", "within")]);
    assert_eq!(half.beads(), 38);
    assert_eq!(half.sensors(), [Sensor::Bead(7), Sensor::Contact(38)]);
    let counted = in_reading("pump", &[("sensor_counted_from", "striker")]);
    assert_eq!((counted.beads(), counted.sensor_bead()), (40, 6));
    let ranges: Vec<_> = sections(&chain_of(&counted)).iter().map(|s| (s.0, s.1)).collect();
    assert_eq!(ranges, [(0, 5), (6, 40)]);
    let _ = changes_only("beads", &[("half_bead", "within")]);
}

#[test]
fn the_pick_is_read_by_those_who_pick() {
    let before = chain_default();
    let experiment = in_reading("pump", &[("pick", "flank-10")]);
    assert_eq!(experiment.pick(), Pick::Flank10);
    assert_eq!(format!("{:?}", chain_of(&experiment)), format!("{before:?}"));
}

#[test]
fn a_wrong_switch_or_option_names_the_nearest() {
    let error = Reading::default().with("contact6", "wet").unwrap_err().to_string();
    assert!(error.contains("did you mean `contact_6`"), "{error}");
    let error = Reading::default().with("pick", "peek").unwrap_err().to_string();
    assert!(error.contains("did you mean `peak`") && error.contains("flank-50"), "{error}");
}

#[test]
fn a_reading_survives_a_parameter_override_and_goes_back() {
    let wet = in_reading("pump", &[("contact_6", "wet")]);
    let set = wet.set(&[("pump-oil.young_modulus", 200e9)]).unwrap();
    assert_eq!(set.reading(), wet.reading());
    assert_eq!(sections(&chain_of(&set))[1].0, 6);
    let back = set.with_reading(&Reading::default()).unwrap();
    assert_eq!(sections(&chain_of(&back))[1].0, 7);
}
