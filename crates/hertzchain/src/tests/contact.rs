use super::*;
use crate::options::{Accuracy, ShotOptions};
use crate::shot::PreparedShot;
use hertzchain_chain::{Material, Sensor};
use hertzchain_experiment::{Experiment, preset};

#[test]
fn pressure_and_radius_are_those_of_hertz() {
    let steel = Material::elastic(213e9, 0.3);
    let pair = BeadPair { left: steel, right: steel, radius_m: 3.175e-3, mass_kg: 4.27e-3 };
    let found = HertzContact::new((3, &pair), 10.0).unwrap();
    // a³ = 3 F R*/(4 E*) and p₀³ = 6 F E*²/(π³ R*²), E* = Y/(2 (1 − ν²)).
    let modulus = 213e9 / (2.0 * 0.91);
    let radius: f64 = 0.75 * 10.0 * 3.175e-3 / modulus;
    let radius = radius.cbrt();
    let pressure = (60.0 * modulus * modulus / (3.175e-3f64.powi(2))).cbrt() / std::f64::consts::PI;
    // Roots and powers round in the last digits.
    assert!((found.radius_m / radius - 1.0).abs() < 1e-12, "{found:?}");
    assert!((found.pressure_pa / pressure - 1.0).abs() < 1e-12, "{found:?}");
    assert!((found.yield_strength_pa * 1.6 / pressure - 1.0).abs() < 1e-12, "{found:?}");
}

#[test]
fn contacts_yield_first_where_the_pressure_is_1_6_times_the_yield_strength_of_the_weaker_ball() {
    let steel = Material { yield_strength_pa: Some(205e6), ..Material::elastic(213e9, 0.3) };
    let hard = Material { yield_strength_pa: Some(2e9), ..steel };
    let pair = BeadPair { left: hard, right: steel, radius_m: 3.175e-3, mass_kg: 4.27e-3 };
    let force_n = first_yield_n(&pair).unwrap();
    let found = HertzContact::new((0, &pair), force_n).unwrap();
    assert_eq!(found.material_yield_strength_pa, Some(205e6));
    // Roots and powers round in the last digits.
    assert!((found.pressure_pa / (1.6 * 205e6) - 1.0).abs() < 1e-12, "{found:?}");
    let unknown = BeadPair { left: Material::RIGID, right: Material::elastic(1e9, 0.3), ..pair };
    assert_eq!(first_yield_n(&unknown), None);
}

/// The largest force of each contact of a shot, sampled closely.
fn traced_n(prepared: PreparedShot<'_>) -> (HertzContact, Vec<f64>) {
    let mut prepared = prepared;
    let chain = &prepared.plan.chain;
    let contacts = (0..=chain.beads.len()).filter(|contact| chain.pair(*contact).is_some());
    let contacts = contacts.map(Sensor::Contact).collect();
    prepared.plan = prepared.plan.watching(contacts, Some(1e-7));
    let shot = prepared.run().unwrap();
    let most_n = |column: &Vec<f64>| column.iter().fold(0.0, |most: f64, force| most.max(*force));
    let traced = shot.trace.as_ref().unwrap().columns.iter().map(most_n).collect();
    (HertzContact::hardest(shot.units, &shot.plan, &shot).unwrap(), traced)
}

#[test]
fn the_hardest_contact_of_the_dry_row_is_the_strikers_with_the_force_of_its_trace() {
    let (row, options) = (preset("dry").unwrap(), ShotOptions::at(0.5));
    let (hardest, traced) = traced_n(PreparedShot::new(&row, &options).unwrap());
    assert_eq!(hardest.contact, 0);
    // A peak between samples is higher by less than this, and so is what a parabola leaves out.
    assert!((hardest.force_n / traced[0] - 1.0).abs() < 1e-3, "{hardest:?} {traced:?}");
    assert!(traced[1..].iter().all(|other| *other < hardest.force_n), "{traced:?}");
}

#[test]
fn losses_press_no_contact() {
    let row = preset("dry").unwrap();
    let hardest = |accuracy| {
        let mut options = ShotOptions::at(3.0);
        options.how.accuracy = Some(Accuracy(accuracy));
        let prepared = PreparedShot::new(&row, &options).unwrap();
        let shot = prepared.run().unwrap();
        HertzContact::hardest(shot.units, &shot.plan, &shot).unwrap()
    };
    let exact = hardest(1e-8);
    // At touch the cubic law gives the striker's contact more force than any overlap does.
    assert_eq!(exact.contact, 1);
    for accuracy in [1e-4, 1e-6] {
        let found = hardest(accuracy);
        assert!((found.force_n / exact.force_n - 1.0).abs() < 10.0 * accuracy, "{found:?}");
    }
}

#[test]
fn the_hardest_contact_of_a_taper_is_one_of_its_thin_end() {
    let row = preset("tapered").unwrap();
    let options = ShotOptions::default();
    let prepared = PreparedShot::new(&row, &options).unwrap();
    let chain = prepared.plan.chain.clone();
    let (hardest, traced) = traced_n(prepared);
    let pressure_pa = |(contact, force_n): (usize, &f64)| {
        let pair = chain.pair(contact);
        pair.and_then(|pair| HertzContact::new((contact, &pair), *force_n)).map(|c| c.pressure_pa)
    };
    let all: Vec<f64> = traced.iter().enumerate().filter_map(pressure_pa).collect();
    let highest = all.iter().copied().fold(0.0, f64::max);
    assert!(hardest.contact > 0, "{hardest:?}");
    // Pressures at the ends of steps are compared.
    assert!((hardest.pressure_pa / highest - 1.0).abs() < 3e-3, "{hardest:?} {all:?}");
}

#[test]
fn check_states_yield_strengths_and_the_force_of_first_yield() {
    let text = "materials.steel = { young_modulus = \"210 GPa\", poisson_ratio = 0.3, density = \"7850 kg/m^3\", \
                yield_strength = \"205 MPa\" }\nbeads = [{ count = 9, radius = \"5 mm\", material = \"steel\" }]\n\
                striker = { speed = \"1 m/s\" }\ncontacts = [{ laws = [\"elastic_hertz\"] }]\n\
                sensors = { bead = 4 }\n";
    let row = Experiment::from_text("steel.toml", text).unwrap();
    let found = crate::describe::check(&row, &crate::options::CheckOptions::default()).unwrap();
    let text = serde_json::to_string(&found.groups).unwrap();
    assert!(text.contains("yield_strength_pa\":205000000.0"), "{text}");
    assert!(text.contains("force of first yield"), "{text}");
}
