//! Converged values, and proof that they are.

use crate::case::{Case, speeds_m_s};
use crate::ours::{End, shot};
use anyhow::{Context, ensure};
use std::cell::RefCell;
use std::collections::HashMap;

/// Tolerance of the converged runs.
const TIGHT: f64 = 1e-12;

/// Converged ToFs of one case, computed when first asked for.
pub struct Converged {
    case: Case,
    known: RefCell<HashMap<u64, (f64, f64)>>,
}

impl Converged {
    /// Nothing known yet.
    pub fn new(case: Case) -> Self {
        let known = RefCell::default();
        Self { case, known }
    }

    /// At some speeds: incident and reflected in s.
    pub fn tofs_s(&self, speeds_m_s: &[f64]) -> Vec<(f64, f64)> {
        let mut known = self.known.borrow_mut();
        let mut one = |speed: &f64| {
            let tight = || shot(self.case, *speed, TIGHT, End::WhenPassed);
            *known.entry(speed.to_bits()).or_insert_with(tight)
        };
        speeds_m_s.iter().map(&mut one).collect()
    }
}

/// Largest relative errors of the incident and the reflected ToF; NaN if one is missing.
pub fn errors(tofs: &[(f64, f64)], converged: &[(f64, f64)]) -> (f64, f64) {
    let worst = |errors: &mut dyn Iterator<Item = f64>| {
        errors.fold(
            0.0,
            |most: f64, e| if e > most || e.is_nan() { e } else { most },
        )
    };
    let pairs = || tofs.iter().zip(converged);
    (
        worst(&mut pairs().map(|(a, b)| (a.0 / b.0 - 1.0).abs())),
        worst(&mut pairs().map(|(a, b)| (a.1 / b.1 - 1.0).abs())),
    )
}

/// Compares with the numbers of another program, and shots that end early
/// with shots that wait for the whole window.
pub fn check(reference: &str) -> anyhow::Result<()> {
    let known = [
        (Case::Dry, 0.5, "rig/dry_0.5"),
        (Case::HertzViscoelastic, 0.5, "rig/hertz_viscoelastic_0.5"),
        (Case::Hertz, 1.0, "rig/hertz_1"),
        (Case::Pump, 0.5, "rig/pump_0.5"),
        (Case::Gear, 0.5, "rig/gear_0.5"),
        (Case::Motor, 1.0, "rig/motor_1.0"),
    ];
    for (case, speed, name) in known {
        let value = shot(case, speed, TIGHT, End::WhenPassed);
        let other = (
            number(reference, name, "tof_incident_s")?,
            number(reference, name, "tof_reflected_s")?,
        );
        let (incident, reflected) = errors(&[value], &[other]);
        println!("{name}: {incident:.1e}, {reflected:.1e} from another program's converged values");
        // The other program's own errors reach some 1e-9.
        ensure!(
            incident.max(reflected) < 2e-8,
            "{name} does not agree: {value:?}, {other:?}"
        );
    }
    for case in Case::ALL {
        for speed in speeds_m_s(5) {
            let early = shot(case, speed, 1e-10, End::WhenPassed);
            let late = shot(case, speed, 1e-10, End::WholeWindow);
            ensure!(early == late, "{case:?} at {speed} m/s ends too early");
        }
    }
    Ok(())
}

/// A number of `bench/reference/numbers.json`.
fn number(reference: &str, case: &str, quantity: &str) -> anyhow::Result<f64> {
    let cases: serde_json::Value = serde_json::from_str(reference)?;
    let all = cases.as_array().context("a list of cases")?;
    let case = all
        .iter()
        .find(|c| c["case"] == *case)
        .context("the case")?;
    let results = case["results"].as_array().context("its results")?;
    let result = results
        .iter()
        .find(|r| r["quantity"] == *quantity)
        .context("the quantity")?;
    result["value"].as_f64().context("its value")
}
