//! The photogate: tells the striker's speed, and when it passes.

use crate::rig::chance::Chance;
use hertzchain_experiment::Photogate;

/// What the gate tells of one shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passing {
    /// Measured speed in m/s.
    pub speed_m_s: f64,
    /// When the striker passed, in s; 0 is the first touch, so that this is
    /// negative.
    pub time_s: f64,
}

impl Passing {
    /// Of a striker with this true speed, whose way from the gate to bead 1 is
    /// longer by `misplaced_m`.
    #[must_use]
    pub fn of(gate: &Photogate, speed_m_s: f64, misplaced_m: f64, chance: &mut Chance) -> Self {
        // A striker is never put beyond bead 1.
        let way_m = (gate.way_m + misplaced_m).max(0.0);
        Self {
            speed_m_s: speed_m_s + gate.error_m_s * chance.normal(),
            time_s: -way_m / speed_m_s,
        }
    }
}
