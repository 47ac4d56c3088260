//! NumPy arrays: one in an NPY, several in an NPZ.

mod array;
mod npz;

pub(crate) use npz::open as open_npz;

use crate::channels::interval_s;
use crate::error::RecordError;
use crate::options::ReadOptions;
use crate::read::Raw;
use array::Array;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Opens one array.
pub(crate) fn open_npy(file: &Path, options: &ReadOptions) -> Result<Raw, RecordError> {
    let opened = File::open(file).map_err(|cause| RecordError::reading(file, cause))?;
    let array = Array::open(file, None, Box::new(BufReader::new(opened)))?;
    let interval_s = interval_s(file, None, options)?;
    array.records(interval_s, options)
}
