//! NumPy arrays: one in an NPY, several in an NPZ.

mod array;
mod npz;
mod order;
mod place;

pub(crate) use npz::open as open_npz;

use crate::records::arrays::clock;
use crate::records::error::RecordError;
use crate::records::interval::interval_s;
use crate::records::options::ReadOptions;
use crate::records::read::Raw;
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
    let array = Array::open(place.clone(), None)?;
    let look = |options: &ReadOptions| Array::open(place.clone(), None)?.records(1.0, options);
    let clock = clock(&array.shape, options, &look);
    let (read, stated_s, note) = match clock {
        Some(clock) => (clock.options, clock.interval_s, clock.note),
        None => (options.clone(), None, None),
    };
    // Who gives the rate of half a file would only learn then that it is half a file.
    let interval_s =
        interval_s(file, stated_s, options).map_err(|error| array.cut_short().unwrap_or(error))?;
    let records = array.records(interval_s, &read)?;
    Ok(Box::new(records.map(move |record| {
        record.map(|mut record| {
            record.notes.extend(note.clone());
            record
        })
    })))
}
