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
    /// Energy terms at the end, when a budget was asked for.
    pub budget: Option<Budget>,
    /// What it cost.
    pub work: Work,
}

/// Why a shot could not be computed as asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// Steps became too small to go on.
    #[error(
        "the solver cannot reach the asked accuracy: at t = {time_s:e} s its step has shrunk to \
         {step_s:e} s, because of contact {contact}; ask for less accuracy or look at that contact's laws"
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
        "the motion is not finite after t = {time_s:e} s near contact {contact}; \
         a smaller step or other law parameters are needed"
    )]
    NotFinite {
        /// Last good time in s.
        time_s: f64,
        /// Contact where it happened.
        contact: usize,
    },
    /// More force passes than allowed.
    #[error(
        "gave up at t = {time_s:e} s after {force_passes} force passes: the last step was \
         {step_s:e} s, set by contact {contact}; ask for a shorter duration or less accuracy, \
         or look at that contact's laws"
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
        "a step of {step_s:e} s is longer than a contact lasts, about {contact_time_s:e} s; \
         a fiftieth of that is a sensible step"
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

/// What to compute beside the motion, and when to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Longest duration in s.
    pub duration_s: f64,
    /// Keep an energy budget.
    pub budget: bool,
    /// Step the whole chain, also where nothing moves.
    pub whole_chain: bool,
    /// Most force passes; when `None`, far more than any sensible shot of this
    /// duration needs.
    pub force_passes: Option<u64>,
}

impl Limits {
    /// Until a time, with all else as usual.
    #[must_use]
    pub fn until(duration_s: f64) -> Self {
        Self {
            duration_s,
            budget: false,
            whole_chain: false,
            force_passes: None,
        }
    }
}
