//! Any recording, record by record.

use crate::records::cut::from_sample;
use crate::records::error::RecordError;
use crate::records::format::Format;
use crate::records::options::{Parts, ReadOptions};
use crate::records::record::Record;
use crate::records::{check, csv, hdf5, numpy, series, tdms, wav};
use std::path::{Path, PathBuf};

/// What a format's reader gives: records until nothing sensible is left.
pub(crate) type Raw = Box<dyn Iterator<Item = Result<Record, RecordError>>>;

/// The records of a file, one at a time: a file larger than memory is never read
/// whole.
///
/// A record that is no good is an error in its place; the good ones are still
/// given.
pub struct Records {
    records: Raw,
    parts: Parts,
    channels_were_told: bool,
    length: Option<usize>,
    file: PathBuf,
    given: usize,
}

/// Most records of a file: an array of more rows is one of something else.
const MOST_RECORDS: usize = 100_000;

impl std::fmt::Debug for Records {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Records").finish_non_exhaustive()
    }
}

impl Iterator for Records {
    type Item = Result<Record, RecordError>;

    fn next(&mut self) -> Option<Self::Item> {
        let record = self.records.next()?;
        self.given += 1;
        if self.given > MOST_RECORDS {
            self.records = Box::new(std::iter::empty());
            let detail = format!(
                "more than {MOST_RECORDS} records; --rows says what the rows of an array are, and \
                 parts of a file can be measured one by one"
            );
            return Some(Err(RecordError::malformed(
                &self.file,
                "a recording",
                detail,
            )));
        }
        Some(record.and_then(|record| self.judged(record)))
    }
}

impl Records {
    fn judged(&mut self, record: Record) -> Result<Record, RecordError> {
        let mut record = check::sound(record, self.parts)?;
        if !self.channels_were_told {
            record.notes.extend(two_channels(&record));
        }
        check::as_long(record, self.parts, &mut self.length)
    }
}

/// Which of two channels was taken for which.
fn two_channels(record: &Record) -> Option<String> {
    let [sensor, wall] = record.channels.as_slice() else {
        return None;
    };
    let (sensor, wall) = (&sensor.name, &wall.name);
    if series::SEPARATE == [sensor.as_str(), wall.as_str()] {
        return None;
    }
    Some(format!(
        "{sensor:?} was taken for the sensor bead's channel, {wall:?} for the wall's; if it is \
         the other way round: --channel {wall:?} --channel {sensor:?}, if one sums both sensors: \
         --channel and its name alone"
    ))
}

/// Reads the records of a file of any [`Format`].
///
/// A file that cannot be read at all gives one error and nothing else.
#[must_use]
pub fn read(file: &Path, options: &ReadOptions) -> Records {
    let records = open(file, options).unwrap_or_else(|error| Box::new(std::iter::once(Err(error))));
    Records {
        records: match options.parts.most() {
            Some(most) => divided(records, most, options.parts),
            None => records,
        },
        parts: options.parts,
        channels_were_told: !options.channels.is_empty(),
        length: None,
        file: file.to_owned(),
        given: 0,
    }
}

fn open(file: &Path, options: &ReadOptions) -> Result<Raw, RecordError> {
    match Format::of(file)? {
        Format::Hdf5 => hdf5::open(file, options),
        Format::Text => csv::open(file, options),
        Format::Npy => numpy::open_npy(file, options),
        Format::Npz => numpy::open_npz(file, options),
        Format::Wav => wav::open(file, options),
        Format::Tdms => tdms::open(file, options),
    }
}

/// Divides what a format's reader gives longer than asked: rows of tables, which
/// it reads whole. Shots are then numbered through the file.
fn divided(records: Raw, most: usize, parts: Parts) -> Raw {
    let mut shots = 0;
    Box::new(records.flat_map(move |record| -> Raw {
        let record = match record {
            Ok(record) if record.len() > most => record,
            other => return Box::new(std::iter::once(other)),
        };
        let count = record.len().div_ceil(most);
        let first = shots;
        shots += count as u64;
        Box::new((0..count).map(move |number| {
            let mut part = record.part(number * most, most);
            if let Parts::Pieces(_) = parts {
                part.first_sample = (number * most) as u64;
                part.source = from_sample(part.source, part.first_sample);
            } else {
                part.shot = Some(first + number as u64 + 1);
                part.source = format!("{}, part {}", part.source, number + 1);
            }
            Ok(part)
        }))
    }))
}
