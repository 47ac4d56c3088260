//! Why a shot has no result.

use hertzchain_chain::ChainError;
use hertzchain_chain::observe::Tracer;
use hertzchain_chain::wave::SolveError;

/// Why a shot has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StudyError {
    /// The chain can't be set up.
    #[error(transparent)]
    Chain(#[from] ChainError),
    /// The motion can't be computed as asked.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// It was broken off.
    #[error("the computation was broken off")]
    Stopped,
    /// An accuracy no result can have.
    #[error("an accuracy of {0} makes no sense; expected a number between 1e-13 and 1e-2")]
    Accuracy(f64),
    /// A duration or step that is not a positive number.
    #[error("{what} = {value} s must be positive and finite")]
    Time {
        /// Which time.
        what: &'static str,
        /// What it is, in s.
        value: f64,
    },
    /// A trace that fills the memory.
    #[error(
        "a trace with {sensors} sensors, a sample every {interval_s:e} s, has more than {most} numbers \
         {time_s:.3e} s after the start of the shot; sample less often, fewer sensors or a shorter shot",
        most = Tracer::MOST_NUMBERS
    )]
    LongTrace {
        /// How many sensors are sampled.
        sensors: usize,
        /// Time between samples in s.
        interval_s: f64,
        /// How far the shot had come, in s.
        time_s: f64,
    },
    /// Signals that fill the memory.
    #[error(
        "the sensors have shown more than is kept of a shot after {steps:.1e} steps, {time_s:.3e} s after \
         its start; give a shorter duration (--duration), a longer step or less accuracy"
    )]
    LongSignal {
        /// How far the shot had come, in s.
        time_s: f64,
        /// Steps until then.
        steps: f64,
    },
    /// The sensor bead is not part of the chain.
    #[error("sensor bead {bead} is outside the chain of {beads} beads")]
    SensorOutside {
        /// The sensor bead.
        bead: usize,
        /// Number of beads.
        beads: usize,
    },
    /// Halving a fixed step does not get there.
    #[error(
        "{method} does not reach an accuracy of {accuracy:e}: halving its step down to {step_s:.3e} s \
         still changes the result by {change:.1e}, last seen at t = {time_s:.4e} s in contact {contact}; \
         ask for less accuracy or use the adaptive solver"
    )]
    NotConverged {
        /// The method.
        method: &'static str,
        /// Accuracy asked for.
        accuracy: f64,
        /// Last step in s.
        step_s: f64,
        /// Last relative change.
        change: f64,
        /// Time of the last pulse that was picked in s, or the end of the shot.
        time_s: f64,
        /// Contact in which it was picked.
        contact: usize,
    },
    /// A fixed step would get there, but not in reasonable time.
    #[error(
        "{method} does not reach an accuracy of {accuracy:e} in reasonable time: it would take about \
         {steps:.0e} steps of {step_s:.0e} s, since halving the step divides the error only by 2^{order:.1}, \
         seen at t = {time_s:.4e} s in contact {contact}; ask for less accuracy, give a step, or use the \
         adaptive solver"
    )]
    TooManySteps {
        /// The method.
        method: String,
        /// Accuracy asked for.
        accuracy: f64,
        /// Number of steps that it would take.
        steps: f64,
        /// Their length in s.
        step_s: f64,
        /// Observed order of convergence.
        order: f64,
        /// Time of the last pulse that was picked in s, or the end of the shot.
        time_s: f64,
        /// Contact in which it was picked.
        contact: usize,
    },
}
