//! Records on disk: what a rig's sensors gave, sampled and digitised.
//!
//! Writes series of a virtual campaign as HDF5 ([`SeriesWriter`]) and reads
//! anybody's recordings, one record at a time ([`read`]): HDF5, CSV,
//! NPY and NPZ, WAV and LabVIEW TDMS. Knows nothing of chains.
//!
//! The reader never opens the true values that a virtual campaign keeps beside
//! its samples, so that no analysis peeks by accident.

mod arrays;
mod channels;
mod check;
mod checksum;
mod csv;
mod cut;
mod encoding;
mod error;
mod format;
mod hdf5;
mod input;
mod interval;
mod numbers;
mod numpy;
mod options;
mod plain;
mod read;
mod record;
mod series;
mod table;
mod tdms;
mod wav;
mod whole;

pub use error::RecordError;
pub use format::Format;
pub use input::{peek, remove_copies, seekable, text};
pub use options::{Parts, ReadOptions, Rows};
pub use plain::{no_formula, without_controls};
pub use read::{Records, read};
pub use record::{Channel, LowPass, Record, Samples};
pub use series::{Channels, SeriesInfo, SeriesWriter, ShotRow, truth, untriggered, verify};
pub use table::Table;
pub use whole::{Files, remove_left_behind, write_whole};
