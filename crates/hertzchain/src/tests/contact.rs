use super::*;
use crate::options::ShotOptions;
use crate::shot::PreparedShot;
use hertzchain_chain::{Material, Sensor};
use hertzchain_experiment::preset;

#[test]
fn pressure_and_radius_are_those_of_hertz() {
    let steel = Material::elastic(213e9, 0.3);
    let pair = BeadPair { left: steel, right: steel, radius_m: 3.175e-3, mass_kg: 4.27e-3 };
    let found = HertzContact::new(&pair, 10.0).unwrap();
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
fn the_hardest_contact_of_the_dry_row_is_the_strikers_with_the_force_of_its_trace() {
    let row = preset("dry").unwrap();
    let options = ShotOptions::at(0.5);
    let mut prepared = PreparedShot::new(&row, &options).unwrap();
    let contacts = (0..=row.beads()).map(Sensor::Contact).collect();
    prepared.plan = prepared.plan.watching(contacts, Some(2e-7));
    let shot = prepared.run().unwrap();
    let most_n = |column: &Vec<f64>| column.iter().fold(0.0, |most: f64, force| most.max(*force));
    let columns = &shot.trace.as_ref().unwrap().columns;
    let (contact, force_n, _) = HertzContact::of_row(shot.units, &shot.plan, &shot).unwrap();
    assert_eq!(contact, 0);
    let hardest_n = columns.iter().map(most_n).fold(0.0, f64::max);
    // A peak between the places at which steps are looked at is higher by less than this.
    assert!((force_n / hardest_n - 1.0).abs() < 1e-3, "{force_n} {hardest_n}");
    assert!(force_n > most_n(columns.last().unwrap()));
}
