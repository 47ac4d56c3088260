//! Our own files: one HDF5 file a series.

mod layout;
mod read;
mod truth;
mod write;

pub(crate) use read::{attribute_number, is_ours, open};
pub use truth::truth;
pub use write::{SeriesInfo, SeriesWriter, ShotRow};
