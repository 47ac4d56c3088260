//! The paper's chain, for tests.
#![allow(dead_code, reason = "each test file uses its own part")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

pub mod ensemble;
pub mod random_shots;

use hertzchain_chain::laws::{DampingCubic, DampingViscoelastic, ElasticHertz, Law, law};
use hertzchain_chain::observe::{Passage, Passages};
use hertzchain_chain::wave::{Limits, Method, Outcome, run};
use hertzchain_chain::*;
use std::sync::Arc;

pub const STEEL: Material = Material {
    young_modulus_pa: 213e9,
    poisson_ratio: 0.3,
    shear_viscosity_pa_s: 3.2e4,
    bulk_viscosity_pa_s: 3.2e4,
    yield_strength_pa: None,
};

pub const BALL: Bead = Bead { radius_m: 6.35e-3, mass_kg: 8.54e-3, material: STEEL };

pub fn hertz() -> Arc<dyn Law> {
    law(ElasticHertz { stiffness: None })
}

pub fn viscoelastic() -> Arc<dyn Law> {
    law(DampingViscoelastic { relaxation_time_s: None, stiffness: None })
}

pub fn cubic() -> Arc<dyn Law> {
    law(DampingCubic { coefficient_kg_s_m2: 77.0 })
}

/// `beads` equal balls between an equal striker and a fixed half-bead.
pub fn row(beads: usize, speed_m_s: f64, laws: Vec<Arc<dyn Law>>) -> Chain {
    Chain {
        beads: vec![BALL; beads],
        start: Start::Striker { bead: BALL, speed_m_s },
        initial: vec![],
        push: Push::None,
        far: FarEnd::HalfBead { radius_m: BALL.radius_m, material: STEEL },
        sections: vec![Section { contacts: 0..=beads, laws, material: None }],
        gaps: vec![],
        incline_rad: 0.0,
        gravity_m_s2: 9.80665,
        suspension_m: None,
        tension: Tension::Allowed,
    }
}

pub fn shoot_with(chain: &Chain, method: &Method) -> (Passage, Outcome) {
    let system = System::new(chain).unwrap();
    let mut passages = Passages::new(7.min(system.beads()), system.contacts() - 1, true);
    let limits = Limits { budget: true, ..Limits::until(1.0) };
    let outcome = run(&system, method, limits, &mut [&mut passages]).unwrap();
    (passages.passage().unwrap(), outcome)
}

pub fn shoot(chain: &Chain, tolerance: f64) -> (Passage, Outcome) {
    shoot_with(chain, &Method::dormand_prince(tolerance))
}

/// A number that another program computed: `bench/reference/numbers.json`.
pub fn reference(case: &str, quantity: &str) -> f64 {
    let text = include_str!("../../../../bench/reference/numbers.json");
    let cases: serde_json::Value = serde_json::from_str(text).unwrap();
    let named = |value: &serde_json::Value, key: &str, name: &str| value[key] == *name;
    let case = cases.as_array().unwrap().iter().find(|c| named(c, "case", case)).unwrap();
    let results = case["results"].as_array().unwrap();
    let result = results.iter().find(|r| named(r, "quantity", quantity)).unwrap();
    result["value"].as_f64().unwrap()
}

/// Asserts that two numbers agree to a relative tolerance.
#[track_caller]
pub fn close(value: f64, expected: f64, relative: f64) {
    let error = (value - expected).abs();
    assert!(
        error <= relative * expected.abs(),
        "{value} is not {expected} to {relative:e}: {:e}",
        error / expected.abs()
    );
}

/// K = m = 1 with one elastic law: for numbers without units.
pub fn unit_row(beads: usize, speed: f64, far: FarEnd) -> Chain {
    let bead = Bead { radius_m: 1.0, mass_kg: 1.0, material: Material::RIGID };
    let laws = vec![law(ElasticHertz { stiffness: Some(1.0) })];
    Chain {
        beads: vec![bead; beads],
        start: Start::Striker { bead, speed_m_s: speed },
        far,
        sections: vec![Section { contacts: 0..=beads, laws, material: None }],
        ..row(beads, speed, vec![])
    }
}

/// Runs a shot for a fixed time.
pub fn run_for(chain: &Chain, tolerance: f64, duration_s: f64) -> Outcome {
    let system = System::new(chain).unwrap();
    let limits = Limits { budget: true, ..Limits::until(duration_s) };
    run(&system, &Method::dormand_prince(tolerance), limits, &mut []).unwrap()
}
