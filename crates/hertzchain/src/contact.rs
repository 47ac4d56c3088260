//! Hertz's contact of two bodies at the peak of a pulse.

use hertzchain_chain::BeadPair;
use hertzchain_experiment::Units;
use hertzchain_sim::{Plan, Shot};
use serde::Serialize;

/// The wall contact at its largest force: circle and pressure of elastic spheres [Hertz1881].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct HertzContact {
    /// Radius of the circle, a² = R* (F/K)^(2/3).
    pub(crate) radius_m: f64,
    /// Largest pressure, p₀ = 3 F/(2 π a²).
    pub(crate) pressure_pa: f64,
    /// Yield strength of the balls below which they yield at this force.
    pub(crate) yield_strength_pa: f64,
}

impl HertzContact {
    /// Of a shot; `None` without a wall pulse, material or unit.
    pub(crate) fn of_wall(units: Units, plan: &Plan, shot: &Shot) -> Option<Self> {
        let force_n = shot.passage.as_ref().ok()?.wall.value;
        let pair = plan.chain.pair(plan.chain.beads.len())?;
        (units == Units::Si).then(|| Self::new(&pair, force_n)).flatten()
    }

    fn new(pair: &BeadPair, force_n: f64) -> Option<Self> {
        /// Spheres of ν = 0.3 yield first, below the surface, where p₀ is so many times the
        /// yield strength [Thornton1997].
        const FIRST_YIELD: f64 = 1.6;
        let overlap_m = (force_n / pair.hertz_stiffness()).powf(2.0 / 3.0);
        let radius_m = (pair.radius_m * overlap_m).sqrt();
        let pressure_pa = 1.5 * force_n / (std::f64::consts::PI * radius_m * radius_m);
        let yield_strength_pa = pressure_pa / FIRST_YIELD;
        let is_known = pressure_pa.is_finite() && pressure_pa > 0.0;
        is_known.then_some(Self { radius_m, pressure_pa, yield_strength_pa })
    }
}

#[cfg(test)]
#[path = "tests/contact.rs"]
mod tests;
