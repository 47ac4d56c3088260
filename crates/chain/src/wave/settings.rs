//! Settings with which no shot can be computed, and bounds on work.

use super::Control;
use super::outcome::{Limits, SolveError};
use crate::system::System;

/// Below this the rounding of a step is larger than its error.
const LEAST_TOLERANCE: f64 = 5e-15;

/// Refuses settings with which no shot can be computed.
pub(super) fn check(control: Control, limits: &Limits, system: &System) -> Result<(), SolveError> {
    let setting = |what, value| Err(SolveError::Setting { what, value });
    if limits.duration_s.is_nan() || limits.duration_s < 0.0 {
        return setting("duration in s", limits.duration_s);
    }
    match control {
        Control::Adaptive { tolerance } if tolerance < LEAST_TOLERANCE => {
            Err(SolveError::TooTight { tolerance, least: LEAST_TOLERANCE })
        }
        Control::Adaptive { tolerance } if tolerance.is_nan() || tolerance >= 1.0 => {
            setting("tolerance (below 1)", tolerance)
        }
        Control::Fixed { step_s } if !(step_s > 0.0 && step_s.is_finite()) => {
            setting("step in s", step_s)
        }
        Control::Fixed { .. } if system.has_states => Err(SolveError::Refused(
            "a law whose contacts have a state, as film_entrained, needs adaptive steps".to_owned(),
        )),
        Control::Fixed { step_s } if step_s > system.scales().time_s => {
            Err(SolveError::StepTooLong { step_s, contact_time_s: system.scales().time_s })
        }
        _ => Ok(()),
    }
}

/// Ten thousand force passes a contact time, where a shot at 1e-12 needs a
/// thousand, and ten million for the shortest shot.
pub(super) fn most_passes(system: &System, limits: &Limits) -> u64 {
    let contact_times = limits.duration_s / system.scales().time_s;
    limits.force_passes.unwrap_or(10_000_000_u64.saturating_add((1e4 * contact_times) as u64))
}
