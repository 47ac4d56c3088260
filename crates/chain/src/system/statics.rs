//! Rest: static overlaps from loads, and what follows from the elastic terms.

use super::System;
use crate::chain::ChainError;
use crate::laws::Closed;

/// One contact at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticContact {
    /// Static overlap in m, minus the gap where open.
    pub overlap_m: f64,
    /// Load in N.
    pub force_n: f64,
    /// Slope of the elastic force there in N/m: the stiffness that small waves see.
    pub stiffness_n_m: f64,
}

impl System {
    /// A contact at rest.
    pub fn static_contact(&self, contact: usize) -> StaticContact {
        let overlap = self.offset_m[contact];
        StaticContact {
            overlap_m: overlap,
            force_n: self.static_force_n[contact],
            stiffness_n_m: if overlap > 0.0 { stiffness(self, contact, overlap) } else { 0.0 },
        }
    }
}

/// Slope of the elastic force by a central difference whose step balances
/// rounding (1e-16) and curvature: right to about 1e-10. Where the load has yielded a contact, small
/// waves see how it unloads.
fn stiffness(system: &System, contact: usize, overlap: f64) -> f64 {
    let step = 1e-5 * overlap;
    let force = |at: f64| force_at_rest(system, contact, at, overlap);
    (force(overlap + step) - force(overlap - step)) / (2.0 * step)
}

/// Force at rest of one contact in N: what all its terms give at zero rate, and its bridge.
pub(super) fn elastic_force(system: &System, contact: usize, overlap: f64) -> f64 {
    force_at_rest(system, contact, overlap, overlap)
}

/// The same at an overlap in m after a largest one.
fn force_at_rest(system: &System, contact: usize, overlap: f64, largest: f64) -> f64 {
    let closed = Closed { largest: largest.max(0.0), ..Closed::new(overlap.max(0.0), 0.0) };
    let force = system.unclipped_force(contact, closed);
    match system.bridged.is_empty() {
        true => force,
        false => force + system.pull_at_rest_n(contact, overlap),
    }
}

/// A factor of 16 within which a rising function passes a level, looked for
/// outward from the micrometre at which contacts live.
fn bracket(rising: impl Fn(f64) -> f64, level: f64) -> Option<(f64, f64)> {
    let mut high = 1e-6;
    while rising(high) < level {
        high *= 16.0;
        if high > 1e300 {
            return None;
        }
    }
    while high > 1e-300 && rising(high / 16.0) >= level {
        high /= 16.0;
    }
    Some((high / 16.0, high))
}

/// Where a rising function passes a level, by bisection down to a relative
/// width; width 0 means to the last bit.
fn invert(rising: impl Fn(f64) -> f64, level: f64, width: f64) -> Option<f64> {
    let (mut low, mut high) = bracket(&rising, level)?;
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high || high - low <= width * high {
            return Some(high);
        }
        if rising(middle) < level { low = middle } else { high = middle }
    }
}

/// Overlap at which the elastic terms of a contact carry a load.
pub(super) fn static_overlap(
    system: &System,
    contact: usize,
    load_n: f64,
) -> Result<f64, ChainError> {
    let force = |overlap| elastic_force(system, contact, overlap);
    if load_n == 0.0 && (system.bridged.is_empty() || force(0.0) >= 0.0) {
        return Ok(0.0);
    }
    invert(force, load_n, 0.0).ok_or_else(|| {
        ChainError::Equilibrium(format!(
            "contact {contact} must carry {load_n} N, but none of its laws is elastic"
        ))
    })
}

/// Time in s, overlap over speed, in which a pair of some mass that meets at a
/// speed is stopped by the elastic terms, if that is shorter than a time known;
/// under preload no longer than 1/ω of the pair.
pub(super) fn shorter_time(
    system: &System,
    contact: usize,
    (mass_kg, speed_m_s): (f64, f64),
    known_s: f64,
) -> f64 {
    let kinetic = 0.5 * mass_kg * speed_m_s * speed_m_s;
    let energy = |overlap| system.stored_energy(contact, overlap);
    // What has not stopped it by then takes longer, and need not be found.
    let turning = match energy(known_s * speed_m_s) <= kinetic {
        true => known_s,
        // A scale: a thousandth is near enough.
        false => invert(energy, kinetic, 1e-3).map_or(known_s, |overlap| overlap / speed_m_s),
    };
    let shorter = turning.min(known_s);
    let preloaded = system.static_contact(contact).stiffness_n_m;
    if preloaded > 0.0 { shorter.min((mass_kg / preloaded).sqrt()) } else { shorter }
}
