//! What sensors on a chain see: signals, their maxima, times of flight.

mod passage;
mod separation;
mod signal;
mod tracer;

pub use passage::RETURN_WITHIN;
pub use passage::{Flank, Passage, PassageError, Passages};
pub use separation::{Apart, Separation};
pub(crate) use signal::KEPT;
pub use signal::{Maximum, Signal, Stretch};
pub use tracer::{Trace, Tracer};
