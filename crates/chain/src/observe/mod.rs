//! What sensors on a chain see: signals, their maxima, times of flight.

mod passage;
mod separation;
mod signal;
mod tracer;

pub use self::{
    passage::{Competing, Passage, PassageError, Passages, Pulse, RETURN_WITHIN, WALL_WITHIN},
    separation::{Apart, Separation},
    signal::{Maximum, Shape, Signal, Stretch},
    tracer::{Trace, Tracer},
};
pub(crate) use signal::{LEAST_SHARE, least_n_s};
