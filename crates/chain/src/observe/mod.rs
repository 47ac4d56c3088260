//! What sensors on a chain see: signals, their maxima, times of flight.

mod passage;
mod separation;
mod signal;
mod tracer;

pub(crate) use passage::WALL_WITHIN;
pub use passage::{Competing, Flank, Passage, PassageError, Passages, Pulse, RETURN_WITHIN};
pub use separation::{Apart, Separation};
pub(crate) use signal::{LEAST_SHARE, least_n_s};
pub use signal::{Maximum, Shape, Signal, Stretch};
pub use tracer::{Trace, Tracer};
