//! Long waves in a touching row of two kinds of beads by turns.
//!
//! Contacts to the left and to the right of a bead carry S + A and S − A. For
//! slowly varying S the difference A = −(r/2) S′ + … follows S, with
//! r = (m₂ − m₁)/(m₁ + m₂), and the overlap δ(S) = (S/K)^{1/n} obeys, to second
//! order in the gradient,
//!
//! > m̄ ∂²/∂t² [δ + (r²/8) δ″(S) S′²] = S″ + (1 + 3r²)/12 S⁗,   m̄ = (m₁ + m₂)/2,
//!
//! x in beads. For r = 0 this is the long-wave theory of equal beads in strain
//! form \[AhnertPikovsky2009\]; a long-wave theory of dimers that keeps other terms
//! is in \[Porter2008\]. Derived here, and right to 1.5 % of the speed that
//! computed pulses have, for mass ratios from 1 to 20.

use super::Group;
use super::contact;
use hertzchain_chain::{Chain, Start};
use hertzchain_experiment::Units;

/// Simpson intervals of the quadrature: 1e-7 of the speed.
const INTERVALS: u32 = 1000;

/// Midpoints of the energy's integral.
const POINTS: u32 = 100;

/// Halvings of the bracket of the speed, down to rounding.
const HALVINGS: u32 = 60;

/// Speeds of solitary waves in a touching dimer; `None` in any other row.
pub(super) fn long_wave(chain: &Chain, units: Units) -> Option<Group> {
    let beads = &chain.beads;
    let middle = beads.len() / 2;
    let (stiffness, exponent) = contact::elastic(chain, middle)?;
    let row = DimerRow {
        exponent,
        stiffness,
        masses_kg: [beads.get(middle - 1)?.mass_kg, beads.get(middle)?.mass_kg],
    };
    let title = "Solitary wave of a long, unloaded row of two kinds of beads by turns (long waves, to second order)";
    let mut group = Group::new(title);
    let unit = match units {
        Units::Si => "1 N",
        Units::Dimensionless => "1",
    };
    let name = format!("speed at a peak contact force of {unit}");
    group.number(name, row.speed_beads_s(1.0), "beads/s");
    group.number(
        "it grows with the peak force to the power",
        0.5 * (exponent - 1.0) / exponent,
        "",
    );
    if let Start::Striker { bead, speed_m_s } = &chain.start {
        let force = row.peak_force_n(0.5 * bead.mass_kg * speed_m_s * speed_m_s);
        group.number(
            "peak contact force of one pulse with the striker's energy, about",
            force,
            "N",
        );
        let speed = row.speed_beads_s(force);
        group.number("speed of that pulse, about", speed, "beads/s");
    }
    group.text(
        "exact lattice wave",
        "not computed: it exists for certain mass ratios only; others radiate",
    );
    Some(group)
}

/// A touching row of two kinds of beads by turns, contacts F = K δⁿ.
struct DimerRow {
    exponent: f64,
    stiffness: f64,
    masses_kg: [f64; 2],
}

impl DimerRow {
    fn wave(&self) -> DimerWave {
        let [one, other] = self.masses_kg;
        DimerWave::new(self.exponent, (other - one) / (one + other))
    }

    fn overlap_m(&self, force_n: f64) -> f64 {
        (force_n / self.stiffness).powf(self.exponent.recip())
    }

    /// Speed in beads per second at a peak contact force in N.
    fn speed_beads_s(&self, peak_force_n: f64) -> f64 {
        let mean_kg = 0.5 * self.masses_kg.iter().sum::<f64>();
        let stiffness_n_m = peak_force_n / self.overlap_m(peak_force_n);
        (self.wave().squared * stiffness_n_m / mean_kg).sqrt()
    }

    /// Peak contact force in N of the wave with an energy in J: the energy is
    /// the wave's own number times peak force and peak overlap.
    fn peak_force_n(&self, energy_j: f64) -> f64 {
        let n = self.exponent;
        let product = energy_j / self.wave().energy();
        (product * self.stiffness.powf(n.recip())).powf(n / (n + 1.0))
    }
}

/// The wave that starts at rest. Forces are in units of the peak force,
/// overlaps of its static overlap, and `squared` is m̄ V² in these. The wave's
/// equation is linear in S′²:
/// β d(S′²)/dS = 2 (squared δ − S) + squared (r²/4) δ″(S) S′².
struct DimerWave {
    exponent: f64,
    squared: f64,
    spread: f64,
    /// What multiplies δ^{1−n} in the exponent of the integrating factor.
    weight: f64,
}

impl DimerWave {
    /// The speed with which the slope is 0 again at the peak force.
    fn new(exponent: f64, ratio: f64) -> Self {
        let at = |squared: f64| {
            let spread = (1.0 + 3.0 * ratio * ratio) / 12.0;
            Self {
                exponent,
                squared,
                spread,
                weight: squared * ratio * ratio / (4.0 * spread * exponent),
            }
        };
        // Long waves have squares of speed of about 1 in these units.
        let (mut low, mut high) = (0.1, 10.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match at(middle).source(0.0, 1.0, 1.0) > 0.0 {
                true => high = middle,
                false => low = middle,
            }
        }
        at(low)
    }

    /// β S′²/2 gained between two overlaps, as it counts at a third.
    fn source(&self, from: f64, to: f64, at: f64) -> f64 {
        let n = self.exponent;
        // In δ instead of S = δⁿ, which is smooth at rest.
        let integrand = |overlap: f64| match overlap > 0.0 {
            false => 0.0,
            true => {
                let memory = (-self.weight * (overlap.powf(1.0 - n) - at.powf(1.0 - n))).exp();
                (self.squared * overlap - overlap.powf(n)) * n * overlap.powf(n - 1.0) * memory
            }
        };
        let step = (to - from) / f64::from(INTERVALS);
        let pairs = (0..INTERVALS / 2).map(|i| {
            let left = from + 2.0 * f64::from(i) * step;
            integrand(left) + 4.0 * integrand(left + step) + integrand(left + 2.0 * step)
        });
        pairs.sum::<f64>() * step / 3.0
    }

    /// S′ at an overlap, summed from the nearer end, where it is 0.
    fn slope(&self, overlap: f64) -> f64 {
        let gained = match overlap < 0.5 {
            true => self.source(0.0, overlap, overlap),
            false => -self.source(overlap, 1.0, overlap),
        };
        (2.0 * gained / self.spread).max(0.0).sqrt()
    }

    /// Energy of the wave over peak force and peak overlap: beads move with V δ
    /// and contacts hold S δ/(n + 1), each a bead, to leading order.
    fn energy(&self) -> f64 {
        let n = self.exponent;
        let step = f64::from(POINTS).recip();
        let parts = (0..POINTS).map(|i| {
            // δ = 1 − u² has no infinite slope at the peak.
            let u = (f64::from(i) + 0.5) * step;
            let overlap = 1.0 - u * u;
            let density =
                0.5 * self.squared * overlap * overlap + overlap.powf(n + 1.0) / (n + 1.0);
            let slope = self.slope(overlap);
            match slope > 0.0 {
                true => density * n * overlap.powf(n - 1.0) * 2.0 * u / slope,
                false => 0.0,
            }
        });
        2.0 * step * parts.sum::<f64>()
    }
}

#[cfg(test)]
#[path = "tests/dimer.rs"]
mod tests;
