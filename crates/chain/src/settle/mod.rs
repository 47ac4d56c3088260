//! Between shots: beads ring, fly, slide on the track and come to rest.
//!
//! Contacts feel all laws of the chain, the push and the incline act as in a
//! shot, and every body that can move rubs on the track: at most μ m g cos α,
//! sliding or sticking. The scheme is nonsmooth time stepping: contact forces
//! are explicit in a leapfrog, friction is an impulse clamped so that it can
//! stop a body but never turn it round [Moreau1988]. A stuck body has the
//! velocity 0 exactly, so a chain in which all are stuck stays as it is for
//! ever. Steps follow the stiffest contact; `docs/explanation/numerics.md` has the
//! measured accuracy.
//!
//! Friction is ours, the paper has none. Rolling is not modelled, and laws with a
//! state add nothing: contacts with a film are dry between shots. Liquid bridges pull.

mod columns;
mod pace;
mod run;
mod state;

pub use state::State;

use crate::system::System;
use crate::wave::SolveError;
use run::Relaxation;

/// How a chain comes to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlowPhase {
    /// Coulomb coefficient μ between a body and the track, 0 or more.
    pub friction_coefficient: f64,
    /// Time in s during which every body must stick for the chain to be at rest.
    pub stuck_for_s: f64,
    /// Longest time in s that this may take.
    pub longest_s: f64,
    /// The striker is taken away where it is this far from bead 1, in m, and
    /// not coming back by itself; it is put at twice that at least.
    pub withdrawn_at_m: f64,
    /// Step as a fraction of the shortest period of the contacts as they are
    /// now; up to 1/4. The default, 1/20, gives peaks of a pulse to 1 or 2 %,
    /// times of flight to about 1e-3, and ends of a tap that scatter like those
    /// of any shorter step; errors fall with its square.
    pub step: f64,
}

impl Default for SlowPhase {
    fn default() -> Self {
        Self {
            friction_coefficient: 0.05,
            stuck_for_s: 1e-3,
            longest_s: 5.0,
            withdrawn_at_m: 1e-3,
            step: 0.05,
        }
    }
}

/// The striker as it was taken away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Withdrawn {
    /// When, in s.
    pub time_s: f64,
    /// Its velocity in m/s then; negative is away from the chain.
    pub velocity_m_s: f64,
}

/// A chain at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// When the last body came to rest, in s from the start of the slow phase.
    pub time_s: f64,
    /// How many of the contacts 1..=N, without the striker's, are closed.
    pub closed_contacts: usize,
    /// Gap in m of every contact 0..=N; 0 where closed, where no contact is,
    /// and at the striker's once it is withdrawn.
    pub gaps_m: Vec<f64>,
    /// When and how fast the striker was withdrawn, if it was.
    pub withdrawn: Option<Withdrawn>,
    /// Steps taken, each one force pass.
    pub steps: u64,
}

/// Lets a chain come to rest from a state, and leaves it there with all
/// velocities 0.
///
/// `seen` is called at every step with the time in s from the start, the state
/// and the forces in N of contacts 0..=N then.
///
/// What a law remembers of a contact begins anew, as it does in a shot: after a
/// phase in which an elastic–plastic contact has yielded, its dent is
/// forgotten, and the state is not one of rest for the next phase.
///
/// # Errors
/// See [`SolveError`]; the state is then the last one reached.
pub fn settle(
    system: &System,
    state: &mut State,
    slow: &SlowPhase,
    seen: &mut dyn FnMut(f64, &State, &[f64]),
) -> Result<Rest, SolveError> {
    check(system, state, slow)?;
    Relaxation::new(system, slow, state).run(seen)
}

/// Longest step that is stable for sure, as a fraction of the shortest period:
/// a leapfrog's limit is 1/π.
const LONGEST_STEP: f64 = 0.25;

fn must_be(what: &str, value: f64, expected: &str) -> SolveError {
    SolveError::Refused(format!("{what} = {value} must be {expected}"))
}

pub(super) fn not_finite(time_s: f64, body: usize) -> SolveError {
    SolveError::Diverged(format!(
        "the motion is not finite any more: after t = {time_s:e} s the speed or the place of body {body} \
         (0 is the striker) is beyond all numbers; look at the laws of the contacts beside it, \
         and at the state it started from"
    ))
}

fn check_settings(slow: &SlowPhase) -> Result<(), SolveError> {
    let friction = slow.friction_coefficient;
    if !(friction >= 0.0 && friction.is_finite()) {
        let what = "friction coefficient";
        return Err(must_be(what, friction, "0 or more, and finite"));
    }
    for (what, value) in [
        ("time of sticking in s", slow.stuck_for_s),
        ("longest time to rest in s", slow.longest_s),
        ("distance of withdrawal in m", slow.withdrawn_at_m),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(must_be(what, value, "positive and finite"));
        }
    }
    match slow.step > 0.0 && slow.step <= LONGEST_STEP {
        true => Ok(()),
        false => {
            let what = "step as a fraction of the shortest period";
            Err(must_be(what, slow.step, "above 0 and at most 0.25"))
        }
    }
}

fn check(system: &System, state: &State, slow: &SlowPhase) -> Result<(), SolveError> {
    check_settings(slow)?;
    let refused = |why: String| Err(SolveError::Refused(why));
    for (restless, what) in
        [(system.periodic, "a ring"), (system.motion.is_some(), "a driven chain")]
    {
        if restless {
            return refused(format!(
                "{what} does not come to rest between shots: only chains with two ends of their own do"
            ));
        }
    }
    if system.is_in_state() {
        let why = "a chain made from a state is for one shot: friction is frozen in its balance. \
             Settle the chain itself, from the state after the shot";
        return refused(why.to_owned());
    }
    let (displacements, velocities) = (state.displacement_m.len(), state.velocity_m_s.len());
    let bodies = system.bodies();
    if displacements != bodies || velocities != bodies {
        return refused(format!(
            "a state of {displacements} displacements and {velocities} velocities does not fit a chain of \
             {bodies} bodies, the striker and the far end among them"
        ));
    }
    match state.first_not_finite() {
        Some(body) => Err(not_finite(0.0, body)),
        None => Ok(()),
    }
}
