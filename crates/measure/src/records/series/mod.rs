//! Our own files: one HDF5 file a series.

mod layout;
mod read;
mod truth;
mod verify;
mod write;

pub(crate) use layout::SEPARATE;
pub use read::untriggered;
pub(crate) use read::{attribute_number, column, is_ours, open};
pub use truth::truth;
pub use verify::verify;
pub use write::{Channels, SeriesInfo, SeriesWriter, ShotRow};
pub(crate) use write::{describe, unit};
