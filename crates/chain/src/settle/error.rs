//! Why a chain can't come to rest, for people.

use super::{SlowPhase, State};
use crate::system::System;

/// Longest step that is stable for sure, as a fraction of the shortest period:
/// a leapfrog's limit is 1/π.
const LONGEST_STEP: f64 = 0.25;

/// Why no rest was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SettleError {
    /// A setting with which nothing can be computed.
    #[error("{what} = {value} must be {expected}")]
    Setting {
        /// Which one.
        what: &'static str,
        /// What it is.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// A state of another chain.
    #[error(
        "a state of {displacements} displacements and {velocities} velocities does not fit a chain of \
         {bodies} bodies, the striker and the far end among them"
    )]
    Shape {
        /// Displacements given.
        displacements: usize,
        /// Velocities given.
        velocities: usize,
        /// Bodies of the chain.
        bodies: usize,
    },
    /// A chain that has no rest between shots.
    #[error("{0} does not come to rest between shots: only chains with two ends of their own do")]
    Restless(&'static str),
    /// A chain made for one shot from a state.
    #[error(
        "a chain made from a state is for one shot: friction is frozen in its balance. \
         Settle the chain itself, from the state after the shot"
    )]
    InState,
    /// Time is over.
    #[error(
        "not at rest after {time_s:.3} s: body {body} (0 is the striker) still moves at {speed_m_s:.2e} m/s. \
         Allow more time, or look at friction: a coefficient of 0 stops nothing, and on an incline \
         a bead slides where the coefficient is below the tangent of the angle"
    )]
    StillMoving {
        /// Time in s.
        time_s: f64,
        /// The fastest body.
        body: usize,
        /// Its speed in m/s.
        speed_m_s: f64,
    },
    /// Steps are so short that rest is out of reach.
    #[error(
        "gave up at t = {time_s:e} s after {steps} steps: the last one was {step_s:e} s, set by the stiffest \
         contact; look at the contacts' laws and at the lightest bead"
    )]
    TooManySteps {
        /// Time reached in s.
        time_s: f64,
        /// Steps taken.
        steps: u64,
        /// Last step in s.
        step_s: f64,
    },
    /// A number stopped being finite.
    #[error(
        "the motion is not finite any more: after t = {time_s:e} s the speed or the place of body {body} \
         (0 is the striker) is beyond all numbers; look at the laws of the contacts beside it, \
         and at the state it started from"
    )]
    NotFinite {
        /// Time in s.
        time_s: f64,
        /// Body.
        body: usize,
    },
}

fn positive(what: &'static str, value: f64) -> Result<(), SettleError> {
    match value > 0.0 && value.is_finite() {
        true => Ok(()),
        false => Err(SettleError::Setting {
            what,
            value,
            expected: "positive and finite",
        }),
    }
}

fn check_settings(slow: &SlowPhase) -> Result<(), SettleError> {
    let friction = slow.friction_coefficient;
    if !(friction >= 0.0 && friction.is_finite()) {
        return Err(SettleError::Setting {
            what: "friction coefficient",
            value: friction,
            expected: "0 or more, and finite",
        });
    }
    positive("time of sticking in s", slow.stuck_for_s)?;
    positive("longest time to rest in s", slow.longest_s)?;
    positive("distance of withdrawal in m", slow.withdrawn_at_m)?;
    match slow.step > 0.0 && slow.step <= LONGEST_STEP {
        true => Ok(()),
        false => Err(SettleError::Setting {
            what: "step as a fraction of the shortest period",
            value: slow.step,
            expected: "above 0 and at most 0.25",
        }),
    }
}

pub(super) fn check(system: &System, state: &State, slow: &SlowPhase) -> Result<(), SettleError> {
    check_settings(slow)?;
    if system.periodic {
        return Err(SettleError::Restless("a ring"));
    }
    if system.motion.is_some() {
        return Err(SettleError::Restless("a driven chain"));
    }
    if system.is_in_state() {
        return Err(SettleError::InState);
    }
    check_state(system, state)
}

fn check_state(system: &System, state: &State) -> Result<(), SettleError> {
    let (displacements, velocities) = (state.displacement_m.len(), state.velocity_m_s.len());
    let bodies = system.bodies();
    if displacements != bodies || velocities != bodies {
        return Err(SettleError::Shape {
            displacements,
            velocities,
            bodies,
        });
    }
    match state.first_not_finite() {
        Some(body) => Err(SettleError::NotFinite { time_s: 0.0, body }),
        None => Ok(()),
    }
}
