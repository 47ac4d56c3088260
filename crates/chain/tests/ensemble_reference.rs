//! Times of flight of the ensemble loop against an independent integration.

use crate::common::ensemble::*;
use crate::common::*;
use hertzchain_chain::ensemble::{End, Precision, Settings};
use hertzchain_chain::laws::Law;
use hertzchain_chain::*;
use std::sync::Arc;

fn dry() -> Vec<Arc<dyn Law>> {
    vec![hertz(), viscoelastic(), cubic()]
}

/// The paper's oiled chain: effective Young modulus in Pa, factors and
/// exponents of viscosity and Poisson ratio over the speed in m/s.
fn wet(young: f64, eta: (f64, f64), nu: (f64, f64), speed: f64) -> Chain {
    let oil = Material {
        young_modulus_pa: young,
        poisson_ratio: nu.0 * speed.powf(nu.1),
        shear_viscosity_pa_s: eta.0 * speed.powf(eta.1),
        bulk_viscosity_pa_s: eta.0 * speed.powf(eta.1),
        yield_strength_pa: None,
    };
    let section = |contacts, laws, material| Section { contacts, laws, material };
    Chain {
        sections: vec![
            section(0..=6, dry(), None),
            section(7..=40, vec![hertz(), viscoelastic()], Some(oil)),
        ],
        ..row(40, speed, vec![])
    }
}

fn motor(speed: f64) -> Chain {
    wet(193e9, (66177.1, -0.206), (0.360, -0.165), speed)
}

fn gear(speed: f64) -> Chain {
    wet(225e9, (107299.0, -0.640), (0.390, -0.127), speed)
}

fn pump(speed: f64) -> Chain {
    wet(216e9, (81405.3, -0.302), (0.314, -0.274), speed)
}

/// Cases of the independent integration.
fn cases() -> Vec<(&'static str, Chain)> {
    let loaded = |chain: Chain| Chain {
        push: Push::Constant { force_n: 0.24 },
        incline_rad: 0.5_f64.to_radians(),
        far: FarEnd::Stop { radius_m: BALL.radius_m, material: STEEL, mass_kg: 4.5 },
        ..chain
    };
    vec![
        ("rig/hertz_1", row(40, 1.0, vec![hertz()])),
        ("rig/hertz_viscoelastic_0.5", row(40, 0.5, vec![hertz(), viscoelastic()])),
        ("rig/dry_0.075", row(40, 0.075, dry())),
        ("rig/dry_0.5", row(40, 0.5, dry())),
        ("rig/dry_1.0", row(40, 1.0, dry())),
        ("rig/dry_1.23", row(40, 1.23, dry())),
        ("rig/pump_0.5", pump(0.5)),
        ("rig/motor_1.0", motor(1.0)),
        ("rig/gear_0.5", gear(0.5)),
        ("rig/motor_0.075", motor(0.075)),
        ("rig/dry_push_incline_stop_0.5", loaded(row(40, 0.5, dry()))),
    ]
}

/// Relative errors of both times of flight of a case.
fn errors(case: &str, chain: &Chain, step: f64, openings: bool) -> [f64; 2] {
    let system = System::new(chain).unwrap();
    let settings = Settings { openings, ..settings(40) };
    let flown = fire_one(&system, (step, 1e-2), &settings);
    let [incident, reflected] = tofs(&passage(&flown).unwrap());
    [
        (incident / reference(case, "tof_incident_s") - 1.0).abs(),
        (reflected / reference(case, "tof_reflected_s") - 1.0).abs(),
    ]
}

#[test]
fn long_steps_give_times_of_flight_within_1_5e_5_of_an_independent_integration() {
    for (case, chain) in cases() {
        let errors = errors(case, &chain, 0.14, false);
        // The step's own error: 1e-5 over the paper's speeds.
        assert!(errors[0] < 1.5e-5 && errors[1] < 1.5e-5, "{case}: {errors:?}");
    }
}

#[test]
fn short_steps_that_follow_openings_are_within_2e_7_of_an_independent_integration() {
    for (case, chain) in cases() {
        let errors = errors(case, &chain, 0.04, true);
        // The step's own error, 7e-8 over the paper's speeds; 1e-8 of it the reference's.
        assert!(errors[0] < 2e-7 && errors[1] < 2e-7, "{case}: {errors:?}");
    }
}

/// How much a reflected pulse changes when what it leaves behind is let go.
fn left_behind(chain: &Chain, precision: Precision, openings: bool) -> f64 {
    let system = System::new(chain).unwrap();
    let times = |end| {
        let settings = Settings { end, openings, ..settings(40) };
        let step = if openings { 0.04 } else { 0.16 };
        tofs(&passage(&fire_one_in(precision, &system, (step, 1e-2), &settings)).unwrap())
    };
    let [left, kept] = [End::Passed, End::Reflected].map(times);
    assert_eq!(left[0], kept[0]);
    (left[1] / kept[1] - 1.0).abs()
}

#[test]
fn what_a_returning_pulse_leaves_behind_does_not_change_it() {
    for (case, chain) in cases() {
        let double = left_behind(&chain, Precision::Double, true);
        // What fourteen beads leave: 1e-9 with gear oil, whose pulse is the broadest.
        assert!(double < 3e-9, "{case}: {double:e}");
        let single = left_behind(&chain, Precision::Single, false);
        // Eleven leave 7e-7 there.
        assert!(single < 1e-6, "{case}: {single:e}");
    }
}
