//! What was seen on rigs.

use super::design::Rig;
use super::spread::deviation;
use crate::claims::{Branch, SPEED_SCATTER_M_S};
use hertzchain_measure::signal::power_law;
use hertzchain_sim::rig::Shot;

/// Shots of equal speed, with taps before each and without.
#[derive(Clone, Debug)]
pub struct AtSpeed {
    /// The speed in m/s.
    pub speed_m_s: f64,
    /// Shots without taps.
    pub loose: Vec<Shot>,
    /// Shots with taps.
    pub tapped: Vec<Shot>,
}

/// All that was seen on one rig.
#[derive(Clone, Debug)]
pub struct Observed {
    /// The rig.
    pub rig: Rig,
    /// Series by speed, slowest first.
    pub speeds: Vec<AtSpeed>,
}

/// All that claims are evaluated on.
#[derive(Clone, Debug, Default)]
pub struct Evidence {
    /// The dry rigs in the design's order: what claims are evaluated on.
    pub rigs: Vec<Observed>,
    /// The others, each of which is evaluated alone.
    pub wet: Vec<Observed>,
}

impl Evidence {
    /// What was seen on each of the rigs alone.
    pub fn alone(&self) -> impl Iterator<Item = Self> + '_ {
        let all = self.rigs.iter().chain(&self.wet);
        all.map(|observed| Self {
            rigs: vec![observed.clone()],
            wet: Vec::new(),
        })
    }
}

/// A time of flight of a shot in s; not a number if it has none.
#[must_use]
pub(super) fn tof_s(shot: &Shot, branch: Branch) -> f64 {
    match branch {
        Branch::Incident => shot.incident_s,
        Branch::Reflected => shot.reflected_s,
    }
}

/// Velocity of the striker when it went, in m/s; 0 if it stayed.
#[must_use]
pub fn rebound_m_s(shot: &Shot) -> f64 {
    match shot.rebound_m_s.is_nan() {
        true => 0.0,
        false => shot.rebound_m_s,
    }
}

/// Largest of a row's gaps in m.
#[must_use]
pub(super) fn largest_m(gaps_m: &[f64]) -> f64 {
    gaps_m.iter().copied().fold(0.0, f64::max)
}

/// What shots have, where it is a number.
#[must_use]
pub(super) fn each(shots: &[Shot], of: impl Fn(&Shot) -> f64) -> Vec<f64> {
    shots.iter().map(of).filter(|v| v.is_finite()).collect()
}

/// Times of flight of the wave loop are no surer than this, in s: no spread is
/// taken to be smaller.
const SURE_S: f64 = 0.2e-9;

/// Standard deviation in s of a time of flight of shots of equal speed; not a
/// number where fewer than two shots have one.
#[must_use]
pub fn spread_s(shots: &[Shot], branch: Branch) -> f64 {
    let spread_s = deviation(&each(shots, |shot| tof_s(shot, branch)));
    // Not `max`, which prefers any number to none.
    if spread_s < SURE_S { SURE_S } else { spread_s }
}

impl Observed {
    /// Series with what the striker's ± 0.003 m/s adds to a time of flight, in
    /// s: |dT/dv| of a power law through the means of tapped shots.
    pub fn with_scatter_s(&self, branch: Branch) -> impl Iterator<Item = (&AtSpeed, f64)> {
        let mean_s = |at: &AtSpeed| mean(&each(&at.tapped, |shot| tof_s(shot, branch)));
        let means_s: Vec<f64> = self.speeds.iter().map(mean_s).collect();
        let speeds: Vec<f64> = self.speeds.iter().map(|at| at.speed_m_s).collect();
        let law = power_law(&speeds, &means_s, None);
        let exponent = law.map_or(f64::NAN, |law| law.exponent);
        let scatter = move |(at, mean_s): (_, f64)| {
            let at: &AtSpeed = at;
            (
                at,
                (exponent * mean_s / at.speed_m_s).abs() * SPEED_SCATTER_M_S,
            )
        };
        self.speeds.iter().zip(means_s).map(scatter)
    }
}

/// Mean of numbers; not a number if there are none.
#[must_use]
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
