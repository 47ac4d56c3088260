//! Our own files: one HDF5 file a series.

mod layout;
mod read;
mod truth;
mod verify;
mod write;

pub(crate) use read::open;
pub use truth::truth;
pub use verify::verify;
pub use write::{Channels, SeriesInfo, SeriesWriter, ShotRow};
