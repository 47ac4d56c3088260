//! The striker's actuator: a speed is programmed, about this speed comes out.

use crate::rig::chance::Chance;
use hertzchain_experiment::Actuator;

/// A speed that the actuator cannot be programmed to.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the actuator cannot shoot at {asked_m_s} m/s: expected a speed from {least_m_s} to {most_m_s} m/s"
)]
pub struct OutOfRange {
    /// Speed asked for in m/s.
    pub asked_m_s: f64,
    /// Slowest speed in m/s.
    pub least_m_s: f64,
    /// Fastest speed in m/s.
    pub most_m_s: f64,
}

/// Shots as slow as this share of the slowest do happen by chance; slower
/// ones would not roll to the chain.
const SLOWEST_SHARE: f64 = 0.1;

/// The speed nearest to one asked for that can be programmed, in m/s.
///
/// # Errors
/// A speed outside the actuator's range.
pub fn programmed(actuator: &Actuator, asked_m_s: f64) -> Result<f64, OutOfRange> {
    let (least_m_s, most_m_s) = (actuator.least_speed_m_s, actuator.most_speed_m_s);
    if !(least_m_s..=most_m_s).contains(&asked_m_s) {
        return Err(OutOfRange {
            asked_m_s,
            least_m_s,
            most_m_s,
        });
    }
    Ok((asked_m_s / actuator.resolution_m_s).round() * actuator.resolution_m_s)
}

/// The true speed of one shot in m/s: programmed + spread · normal.
#[must_use]
pub fn fired_m_s(actuator: &Actuator, programmed_m_s: f64, chance: &mut Chance) -> f64 {
    let speed = programmed_m_s + actuator.spread_m_s * chance.normal();
    let slowest_m_s = SLOWEST_SHARE * actuator.least_speed_m_s;
    // Not `max`, which would make a speed of what is not a number.
    match speed < slowest_m_s {
        true => slowest_m_s,
        false => speed,
    }
}

/// How far from its place the striker was put before a shot, in m.
#[must_use]
pub fn misplaced_m(actuator: &Actuator, chance: &mut Chance) -> f64 {
    actuator.placing_m * chance.normal()
}
