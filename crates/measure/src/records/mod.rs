//! Records on disk: the samples of a rig's sensors.
//!
//! Writes series of a virtual campaign as HDF5 ([`SeriesWriter`]) and reads recordings of any
//! program, one record at a time ([`read`]): HDF5, MATLAB's, text, NPY and NPZ, WAV and LabVIEW TDMS.

mod archive;
mod arrays;
mod files;
#[cfg(feature = "hdf5")]
mod hdf5;
mod interval;
mod mat;
mod numpy;
mod options;
mod read;
mod record;
#[cfg(feature = "hdf5")]
mod series;
mod stored;
mod stream;
mod tdms;
mod text;
mod wav;

pub use self::{
    files::{
        Files, no_formula, peek, remove_copies, remove_left_behind, seekable, text,
        without_controls, write_whole,
    },
    options::{Parts, ReadOptions, Rows},
    read::{Records, is_recording, read},
    record::{Channel, Record},
    stream::{SampleKind, StreamFormat, stream_pieces, write_npy},
};
#[cfg(feature = "hdf5")]
pub use self::{
    hdf5::ColumnFile,
    series::{SeriesChannels, SeriesInfo, SeriesWriter, ShotRow, truth, untriggered, verify},
};
