//! NumPy arrays: one in an NPY, several in an NPZ.

mod array;
mod npz;
mod order;
mod place;

pub(crate) use npz::open as open_npz;

use crate::channels::interval_s;
use crate::error::RecordError;
use crate::options::ReadOptions;
use crate::read::Raw;
use array::Array;
use place::Place;
use std::path::Path;

/// Opens one array.
pub(crate) fn open_npy(file: &Path, options: &ReadOptions) -> Result<Raw, RecordError> {
    let place = Place {
        file: file.to_owned(),
        start: 0,
        size: u64::MAX,
        deflated: false,
    };
    let array = Array::open(place, None)?;
    let interval_s = interval_s(file, None, options)?;
    array.records(interval_s, options)
}
