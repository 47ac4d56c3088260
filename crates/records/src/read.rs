//! Any recording, record by record.

use crate::error::RecordError;
use crate::format::Format;
use crate::options::ReadOptions;
use crate::record::Record;
use crate::{check, csv, numpy, series, tdms, wav};
use std::path::Path;

/// What a format's reader gives: records until nothing sensible is left.
pub(crate) type Raw = Box<dyn Iterator<Item = Result<Record, RecordError>>>;

/// The records of a file, one at a time: a file larger than memory is never read
/// whole.
///
/// A record that is no good is an error in its place; the good ones are still
/// given.
pub struct Records {
    records: Raw,
    length: Option<usize>,
}

impl std::fmt::Debug for Records {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Records").finish_non_exhaustive()
    }
}

impl Iterator for Records {
    type Item = Result<Record, RecordError>;

    fn next(&mut self) -> Option<Self::Item> {
        let record = self.records.next()?;
        let record = record.and_then(check::sound);
        Some(record.and_then(|record| check::as_long(record, &mut self.length)))
    }
}

/// Reads the records of a file of any [`Format`].
///
/// A file that cannot be read at all gives one error and nothing else.
#[must_use]
pub fn read(file: &Path, options: &ReadOptions) -> Records {
    let records = open(file, options).unwrap_or_else(|error| Box::new(std::iter::once(Err(error))));
    Records {
        records,
        length: None,
    }
}

fn open(file: &Path, options: &ReadOptions) -> Result<Raw, RecordError> {
    match Format::of(file)? {
        Format::Hdf5 => series::open(file, options),
        Format::Text => csv::open(file, options),
        Format::Npy => numpy::open_npy(file, options),
        Format::Npz => numpy::open_npz(file, options),
        Format::Wav => wav::open(file, options),
        Format::Tdms => tdms::open(file, options),
    }
}
