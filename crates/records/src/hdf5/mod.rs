//! HDF5: series of ours, and other programs' files of datasets.

mod foreign;

use crate::error::RecordError;
use crate::options::ReadOptions;
use crate::read::Raw;
use crate::series;
use rust_hdf5::{H5File, Hdf5Error};
use std::path::Path;

/// Opens a file of either.
pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw, RecordError> {
    let open = H5File::open(file)
        .map_err(|error| RecordError::malformed(file, "HDF5", damaged(&error)))?;
    match series::is_ours(&open) {
        true => series::open(file, &open, options),
        false => foreign::open(file, open, options),
    }
}

/// What the library says, after the likeliest reason.
pub(crate) fn damaged(error: &Hdf5Error) -> String {
    format!("cut short or damaged ({error})")
}
