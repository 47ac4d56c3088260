//! What goes into a shot and what comes out of it.

use super::dense::Piece;
use super::energy::Budget;

/// What an observer wants next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// More steps.
    Continue,
    /// It has seen enough.
    Finished,
}

/// Sees every accepted step of a shot.
pub trait Observer {
    /// One accepted step.
    fn step(&mut self, piece: &Piece<'_>) -> Flow;
}

/// What a shot cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Force passes over the moving part of the chain.
    pub force_passes: u64,
    /// Accepted steps.
    pub steps: u64,
    /// Steps redone because their error was too large.
    pub rejected: u64,
    /// Steps redone to end at an opening or closing.
    pub located: u64,
    /// Bodies summed over force passes; in an ensemble all of the chain's.
    pub bodies_passed: u64,
}

/// How a shot ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Time reached in s.
    pub time_s: f64,
    /// Whether an observer ended it before the longest duration.
    pub finished: bool,
    /// Velocities of all bodies in m/s, 0 the striker, N+1 the far end.
    pub velocity_m_s: Vec<f64>,
    /// Displacements of all bodies in m.
    pub displacement_m: Vec<f64>,
    /// Contacts that a liquid bridge joins, as in [`State`](crate::settle::State).
    pub bridged: Vec<bool>,
    /// Energy terms at the end, when a budget was asked for.
    pub budget: Option<Budget>,
    /// The contact of the highest Hertz pressure and its force in N at its largest overlap, with the one at
    /// rest, when a budget was asked for.
    pub hardest: Option<(usize, f64)>,
    /// What it cost.
    pub work: Work,
}

/// Why a shot could not be computed as asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// Steps became too small to go on.
    #[error(
        "the solver cannot reach the asked accuracy: at t = {} its step has shrunk to {}, {}",
        time(*time_s),
        time(*step_s),
        shrunk(*time_s, *step_s, *contact)
    )]
    StepTooSmall {
        /// When, in s.
        time_s: f64,
        /// Step in s.
        step_s: f64,
        /// Contact next to the body with the largest error.
        contact: usize,
    },
    /// A number stopped being finite.
    #[error(
        "the motion is not finite any more: after t = {} the speed or the place of body {body} (0 is the \
         striker), next to contact {contact}, is beyond all numbers. Probable reasons: {}. {}",
        time(*time_s),
        reasons(*step_s),
        remedy(*step_s)
    )]
    NotFinite {
        /// Last good time in s.
        time_s: f64,
        /// Body whose speed or place it is.
        body: usize,
        /// Contact next to it.
        contact: usize,
        /// The fixed step in s, if steps are fixed.
        step_s: Option<f64>,
    },
    /// More force passes than allowed.
    #[error(
        "gave up at t = {} after {force_passes} force passes: the last step was {}, set by contact \
         {contact}; ask for a shorter duration, a longer step or less accuracy, or look at that contact's laws",
        time(*time_s),
        time(*step_s)
    )]
    TooMuchWork {
        /// Time reached in s.
        time_s: f64,
        /// Passes done.
        force_passes: u64,
        /// Last step in s.
        step_s: f64,
        /// Contact next to the body with the largest error.
        contact: usize,
    },
    /// A fixed step in which a whole contact could come and go.
    #[error(
        "a step of {} is longer than a contact lasts, about {}; a fiftieth of that is a sensible step",
        time(*step_s),
        time(*contact_time_s)
    )]
    StepTooLong {
        /// Step in s.
        step_s: f64,
        /// Contact time in s.
        contact_time_s: f64,
    },
    /// A setting with which nothing can be computed.
    #[error("{what} = {value} must be positive and finite")]
    Setting {
        /// Which one.
        what: &'static str,
        /// What it is.
        value: f64,
    },
    /// A chain, a sensor or a setting with which nothing can be computed.
    #[error("{0}")]
    Refused(String),
    /// With equal steps, or on the way to rest, a number stopped being finite.
    #[error("{0}")]
    Diverged(String),
    /// With equal steps, or on the way to rest, steps become too many.
    #[error("{why}")]
    TooManySteps {
        /// Time reached in s.
        time_s: f64,
        /// In words.
        why: String,
    },
    /// No rest within the longest time.
    #[error("{why}")]
    StillMoving {
        /// Time in s.
        time_s: f64,
        /// In words.
        why: String,
    },
    /// The computation was cancelled.
    #[error("the shot was broken off")]
    BrokenOff,
    /// Rounding alone is larger than the error asked for.
    #[error(
        "a tolerance of {tolerance:e} per step cannot be reached in double precision; \
         the least is {least:e}"
    )]
    TooTight {
        /// Tolerance asked for.
        tolerance: f64,
        /// Least tolerance.
        least: f64,
    },
}

/// Sizes of times that have a name.
const PREFIXES: [(f64, &str); 5] =
    [(1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns"), (1e-12, "ps")];

/// A time in s for people: five digits, with a prefix.
fn time(time_s: f64) -> String {
    let named = PREFIXES.iter().find(|(size, _)| time_s.abs() >= *size);
    match named {
        Some((size, unit)) if time_s < 1e5 => {
            let value = time_s / size;
            let decimals = 4_usize.saturating_sub(value.abs().log10().floor().max(0.0) as usize);
            format!("{value:.decimals$} {unit}")
        }
        _ if time_s == 0.0 => "0 s".to_owned(),
        _ => format!("{time_s:.2e} s"),
    }
}

/// Why a step has become too small, and what to do.
fn shrunk(time_s: f64, step_s: f64, contact: usize) -> String {
    match time_s + step_s > time_s {
        true => format!(
            "because of contact {contact}; ask for less accuracy or look at that contact's laws"
        ),
        false => {
            "less than two such times differ by in double precision; ask for a shorter duration \
                  or less accuracy"
                .to_owned()
        }
    }
}

fn reasons(step_s: Option<f64>) -> &'static str {
    match step_s {
        Some(_) => "the fixed step is too long for a stiff contact or a strong damping",
        None => {
            "a law whose force grows without bound (a large damping coefficient, a high power) or \
             bodies of very unlike masses"
        }
    }
}

fn remedy(step_s: Option<f64>) -> String {
    match step_s {
        Some(step_s) => format!(
            "A tenth of the step, {}, or the adaptive solver, may help; else look at that contact's laws",
            time(0.1 * step_s)
        ),
        None => "Look at that contact's laws and at the masses beside it".to_owned(),
    }
}

/// What to compute beside the motion, and when to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Longest duration in s.
    pub duration_s: f64,
    /// Keep an energy budget.
    pub budget: bool,
    /// Step the whole chain, also where nothing moves.
    pub whole_chain: bool,
    /// Largest accepted error per step of what only creeps and rattles beside a
    /// pulse in a long chain, if larger than the method's: a pulse repeats its
    /// error in every bead that it passes, the others do not.
    pub slow_tolerance: Option<f64>,
    /// Keep the first step after a contact has closed below the tolerance also where its force begins as √t,
    /// which the method's error estimate does not see: for chains with such damping laws, gaps or cut forces.
    pub careful_closings: bool,
    /// Most force passes; when `None`, far more than any sensible shot of this
    /// duration needs.
    pub force_passes: Option<u64>,
}

impl Limits {
    /// Until a time, with all else as usual.
    pub fn until(duration_s: f64) -> Self {
        Self {
            duration_s,
            budget: false,
            whole_chain: false,
            slow_tolerance: None,
            careful_closings: false,
            force_passes: None,
        }
    }
}

#[cfg(test)]
#[path = "tests/outcome.rs"]
mod tests;
