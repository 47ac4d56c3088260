//! Several arrays in a ZIP: samples, and what else is named as what it is.

use super::array::Array;
use crate::channels::{chosen, interval_s};
use crate::error::{RecordError, name};
use crate::options::{ReadOptions, Rows};
use crate::read::Raw;
use crate::record::{Channel, Record};
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use zip::{CompressionMethod, ZipArchive};

/// Names of arrays that hold one interval in s.
const INTERVALS: &[&str] = &[
    "dt",
    "interval",
    "interval_s",
    "sampling_interval",
    "sampling_interval_s",
];
/// Names of arrays that hold one rate in Hz.
const RATES: &[&str] = &[
    "fs",
    "rate",
    "rate_hz",
    "sample_rate",
    "sampling_rate",
    "samplerate",
];
/// Names of arrays of times in s.
const TIMES: &[&str] = &["t", "time", "times", "time_s", "t_s"];
/// Names of arrays of speeds in m/s, one a shot.
const SPEEDS: &[&str] = &["speed", "speeds", "speed_m_s", "speeds_m_s", "v0"];
/// One-dimensional arrays that are called so, and a number, are shots.
const SHOTS: &[&str] = &["arr", "shot", "record", "rec", "run", "segment", "seg"];

/// An array in the file.
#[derive(Clone, Debug)]
struct Entry {
    name: String,
    start: u64,
    size: u64,
    deflated: bool,
}

/// Opens an archive of arrays.
pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw, RecordError> {
    let entries = entries(file)?;
    let called = |names: &[&str]| {
        let found = entries
            .iter()
            .find(|entry| names.contains(&entry.name.as_str()));
        found.map(|entry| array(file, entry)?.values()).transpose()
    };
    let stated_s = stated_s(called(INTERVALS)?, called(RATES)?, called(TIMES)?);
    let interval_s = interval_s(file, stated_s, options)?;
    let speeds = called(SPEEDS)?.unwrap_or_default();
    let known = [INTERVALS, RATES, TIMES, SPEEDS].concat();
    let rest = entries
        .iter()
        .filter(|entry| !known.contains(&entry.name.as_str()));
    let samples: Vec<Entry> = rest.cloned().collect();
    if samples.is_empty() {
        return Err(RecordError::Empty {
            source_name: name(file),
        });
    }
    let shapes: Vec<usize> = samples
        .iter()
        .map(|entry| Ok(array(file, entry)?.shape.len()))
        .collect::<Result<_, RecordError>>()?;
    let shots = samples.iter().all(|entry| is_shot(&entry.name));
    let alone = samples.len() == 1;
    let records = match shapes.iter().all(|axes| *axes == 1) {
        true if !alone && (!shots || options.rows == Rows::Channels) => {
            channels(file, &samples, interval_s, options)?
        }
        several_shots => {
            // Shots of one axis each have no columns to choose from.
            let free = ReadOptions {
                channels: match several_shots {
                    true => Vec::new(),
                    false => options.channels.clone(),
                },
                ..options.clone()
            };
            one_by_one(file.to_owned(), samples, interval_s, free)
        }
    };
    Ok(with_speeds(records, speeds))
}

fn stated_s(
    interval: Option<Vec<f64>>,
    rate: Option<Vec<f64>>,
    times: Option<Vec<f64>>,
) -> Option<f64> {
    let first = |values: Option<Vec<f64>>| values?.first().copied();
    let step = |times: Vec<f64>| {
        let steps = times.len().checked_sub(1).filter(|steps| *steps > 0)?;
        Some((times.last()? - times.first()?) / steps as f64)
    };
    let of_rate = || first(rate).map(f64::recip);
    first(interval)
        .or_else(of_rate)
        .or_else(|| times.and_then(step))
}

fn is_shot(name: &str) -> bool {
    let stem = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let stem_is_shot = SHOTS.contains(
        &stem
            .trim_end_matches(['_', '-', ' '])
            .to_lowercase()
            .as_str(),
    );
    stem.len() < name.len() && stem_is_shot
}

/// One-dimensional arrays side by side.
fn channels(
    file: &Path,
    samples: &[Entry],
    interval_s: f64,
    options: &ReadOptions,
) -> Result<Raw, RecordError> {
    let names: Vec<String> = samples.iter().map(|entry| entry.name.clone()).collect();
    let mut record: Option<Record> = None;
    for index in chosen(file, &names, options)? {
        let Some(entry) = samples.get(index) else {
            continue;
        };
        let free = ReadOptions {
            channels: Vec::new(),
            shot_samples: None,
            ..options.clone()
        };
        let mut one = array(file, entry)?.records(interval_s, &free)?;
        let Some(one) = one.next().transpose()? else {
            continue;
        };
        let source = name(file);
        let record = record.get_or_insert_with(|| Record {
            source,
            channels: Vec::new(),
            ..one.clone()
        });
        record
            .channels
            .extend(one.channels.into_iter().map(|channel| Channel {
                name: entry.name.clone(),
                ..channel
            }));
    }
    Ok(Box::new(record.into_iter().map(Ok)))
}

/// The records of one array after the other.
fn one_by_one(file: PathBuf, samples: Vec<Entry>, interval_s: f64, options: ReadOptions) -> Raw {
    let several = samples.len() > 1;
    let mut shot = 0;
    let records = samples.into_iter().flat_map(move |entry| {
        let opened = array(&file, &entry).and_then(|array| array.records(interval_s, &options));
        opened.unwrap_or_else(|error| Box::new(std::iter::once(Err(error))))
    });
    Box::new(records.map(move |record| {
        shot += 1;
        record.map(|record| Record {
            shot: record.shot.or(several.then_some(shot)),
            ..record
        })
    }))
}

/// Speeds in the order of the records.
fn with_speeds(records: Raw, speeds: Vec<f64>) -> Raw {
    let mut number = 0;
    Box::new(records.map(move |record| {
        let speed = match speeds.as_slice() {
            [one] => Some(*one),
            several => several.get(number).copied(),
        };
        number += 1;
        record.map(|record| Record {
            speed_m_s: speed.filter(|speed| speed.is_finite()),
            ..record
        })
    }))
}

fn entries(file: &Path) -> Result<Vec<Entry>, RecordError> {
    let opened = File::open(file).map_err(|cause| RecordError::reading(file, cause))?;
    let refused = |error: zip::result::ZipError| {
        RecordError::malformed(file, "NPZ", format!("cut short or damaged ({error})"))
    };
    let mut archive = ZipArchive::new(BufReader::new(opened)).map_err(refused)?;
    let mut entries = Vec::new();
    for index in 0..archive.len() {
        let entry = archive.by_index_raw(index).map_err(refused)?;
        let Some(name) = entry
            .name()
            .map_err(refused)?
            .strip_suffix(".npy")
            .map(str::to_owned)
        else {
            continue;
        };
        let deflated = match entry.compression() {
            CompressionMethod::Stored => false,
            method if method == CompressionMethod::DEFLATE => true,
            method => {
                let detail = format!("{name} is compressed by {method:?}; use savez_compressed");
                return Err(RecordError::malformed(file, "NPZ", detail));
            }
        };
        let start = entry.data_start().ok_or_else(|| {
            RecordError::malformed(file, "NPZ", format!("{name} has no place in the file"))
        })?;
        entries.push(Entry {
            name,
            start,
            size: entry.compressed_size(),
            deflated,
        });
    }
    Ok(entries)
}

fn array(file: &Path, entry: &Entry) -> Result<Array, RecordError> {
    let refused = |cause| RecordError::reading(file, cause);
    let mut opened = File::open(file).map_err(refused)?;
    opened.seek(SeekFrom::Start(entry.start)).map_err(refused)?;
    let bytes = BufReader::with_capacity(1 << 16, opened).take(entry.size);
    let reader: Box<dyn Read> = match entry.deflated {
        true => Box::new(flate2::read::DeflateDecoder::new(bytes)),
        false => Box::new(bytes),
    };
    Array::open(file, Some(entry.name.clone()), reader)
}
