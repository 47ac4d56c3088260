use super::*;
use hertzchain_chain::Material;

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
