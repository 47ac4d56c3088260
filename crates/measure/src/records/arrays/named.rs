//! Several arrays by name: samples, and what else is named as what it is.

use super::clock::{Clock, clock};
use crate::records::arrays::Axes;
use crate::records::channels::{chosen, list};
use crate::records::error::RecordError;
use crate::records::interval::{interval_s, seconds_taken};
use crate::records::options::{Parts, ReadOptions, Rows};
use crate::records::read::Raw;
use crate::records::record::Record;
use std::path::Path;
use std::rc::Rc;

/// Names of numbers that are an interval in s.
pub(crate) const INTERVALS: &[&str] = &[
    "dt",
    "interval",
    "interval_s",
    "sampling_interval",
    "sampling_interval_s",
];
/// Names of numbers that are a rate in Hz.
pub(crate) const RATES: &[&str] = &[
    "fs",
    "rate",
    "rate_hz",
    "sample_rate",
    "sampling_rate",
    "samplerate",
];
/// Names of arrays of times that name no unit.
const TIMES: &[&str] = &["t", "time", "times"];
/// Names of arrays of times in s.
const TIMES_S: &[&str] = &["time_s", "t_s"];
/// Names of arrays of speeds in m/s, one a shot.
const SPEEDS: &[&str] = &["speed", "speeds", "speed_m_s", "speeds_m_s", "v0"];
/// Arrays that are called so, and a number, are shots.
const SHOTS: &[&str] = &["arr", "shot", "record", "rec", "run", "segment", "seg"];

/// A file of named arrays. Names may be paths.
pub(crate) trait Arrays {
    fn file(&self) -> &Path;

    /// Names of all arrays of numbers.
    fn names(&self) -> Vec<String>;

    /// How long each axis is.
    fn shape(&self, name: &str) -> Result<Vec<usize>, RecordError>;

    /// All numbers of a small array.
    fn values(&self, name: &str) -> Result<Vec<f64>, RecordError>;

    /// The records of an array of samples.
    fn records(
        &self,
        name: &str,
        interval_s: f64,
        options: &ReadOptions,
    ) -> Result<Raw, RecordError>;

    /// Sampling interval in s that the file states beside its arrays.
    fn stated_s(&self) -> Option<f64> {
        None
    }
}

/// The records of a file of named arrays.
///
/// One array is shots or channels by its axes. Several are shots if they are
/// called so, else channels.
pub(crate) fn open(arrays: Rc<dyn Arrays>, options: &ReadOptions) -> Result<Raw, RecordError> {
    let file = arrays.file();
    let names = arrays.names();
    let of = |known: &[&str]| names.iter().find(|name| known.contains(&last(name)));
    let values = |known| of(known).map(|name| arrays.values(name)).transpose();
    let (times, times_s) = (values(TIMES)?, values(TIMES_S)?);
    let nameless_s = times
        .and_then(step)
        .map(|step| step * options.time_unit_s.unwrap_or(1.0));
    let first = |values: Option<Vec<f64>>| values?.first().copied();
    let stated_s = first(values(INTERVALS)?)
        .or(first(values(RATES)?).map(f64::recip))
        .or_else(|| arrays.stated_s())
        .or(times_s.and_then(step));
    let note = match stated_s {
        Some(_) => None,
        None => of(TIMES).and_then(|name| seconds_taken(name, None, options)),
    };
    let stated_s = stated_s.or(nameless_s);
    let speeds = values(SPEEDS)?.unwrap_or_default();
    let known = [INTERVALS, RATES, TIMES, TIMES_S, SPEEDS].concat();
    // Single numbers beside them are whatever they are.
    let several = |name: &str| arrays.shape(name).map_or(true, |shape| !shape.is_empty());
    let samples = names
        .iter()
        .filter(|name| !known.contains(&last(name)) && several(name));
    let samples: Vec<String> = samples.cloned().collect();
    let clock = only_column(&*arrays, &samples, options);
    let (read, own_s, own_note) = match clock {
        Some(clock) => (clock.options, clock.interval_s, clock.note),
        None => (options.clone(), None, None),
    };
    let note = note.or(own_note.filter(|_| stated_s.is_none()));
    let interval_s = interval_s(file, stated_s.or(own_s), options)?;
    let (records, recordings) = of_samples(&arrays, samples, interval_s, &read)?;
    let speeds = Speeds {
        told: speeds,
        recordings,
    };
    Ok(with_speeds(records, speeds, note))
}

/// Times among the columns of the only array of samples.
fn only_column(arrays: &dyn Arrays, samples: &[String], options: &ReadOptions) -> Option<Clock> {
    let [one] = samples else { return None };
    if options.channels.contains(one) {
        return None;
    }
    let open = |options: &ReadOptions| arrays.records(one, 1.0, options);
    clock(&arrays.shape(one).ok()?, options, &open)
}

/// The last part of a path.
fn last(name: &str) -> &str {
    name.rsplit('/').next().unwrap_or(name)
}

/// Recordings in one array.
fn rows(arrays: &dyn Arrays, name: &str, options: &ReadOptions) -> Result<usize, RecordError> {
    let shape = arrays.shape(name)?;
    let axes = Axes::of(&shape, options.rows_of(&shape));
    let rows = axes.and_then(|axes| shape.get(axes.shots?));
    Ok(rows.copied().unwrap_or(1))
}

/// The records of arrays of samples, and how many recordings they are of.
fn of_samples(
    arrays: &Rc<dyn Arrays>,
    samples: Vec<String>,
    interval_s: f64,
    options: &ReadOptions,
) -> Result<(Raw, usize), RecordError> {
    let file = arrays.file();
    // Columns of an array that is itself chosen are not chosen from.
    let free = ReadOptions {
        channels: Vec::new(),
        ..options.clone()
    };
    if let [one] = samples.as_slice() {
        let named = options.channels.contains(one);
        let options = if named { &free } else { options };
        let recordings = rows(&**arrays, one, options)?;
        return Ok((arrays.records(one, interval_s, options)?, recordings));
    }
    let are_shots = samples.iter().all(|name| is_shot(last(name)));
    if are_shots && options.rows != Rows::Channels && options.channels.is_empty() {
        let each = samples.iter().map(|name| rows(&**arrays, name, options));
        let recordings = match options.parts {
            // Shots of equal length come one by one, whatever array they are of.
            Parts::Shots(_) => 0,
            _ => each.sum::<Result<usize, RecordError>>()?,
        };
        let all = one_by_one(arrays.clone(), samples, interval_s, free);
        return Ok((all, recordings));
    }
    let chosen = chosen(file, &samples, options)?;
    let chosen: Vec<&String> = chosen.iter().filter_map(|i| samples.get(*i)).collect();
    if options.channels.is_empty() {
        // Tables may as well be of different chains.
        for name in &chosen {
            if arrays.shape(name)?.len() > 1 {
                return Err(RecordError::WhichChannel {
                    file: crate::records::error::name(file),
                    count: samples.len(),
                    there: list(&samples),
                });
            }
        }
    }
    let recordings = chosen.first().map(|name| rows(&**arrays, name, options));
    let recordings = recordings.unwrap_or(Ok(0))?;
    Ok((
        side_by_side(arrays, &chosen, interval_s, &free)?,
        recordings,
    ))
}

/// The even step of times.
fn step(times: Vec<f64>) -> Option<f64> {
    let steps = times.len().checked_sub(1).filter(|steps| *steps > 0)?;
    Some((times.last()? - times.first()?) / steps as f64)
}

fn is_shot(name: &str) -> bool {
    let stem = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let word = stem.trim_end_matches(['_', '-', ' ']).to_lowercase();
    stem.len() < name.len() && SHOTS.contains(&word.as_str())
}

/// Arrays of which each holds one channel of every shot.
fn side_by_side(
    arrays: &Rc<dyn Arrays>,
    names: &[&String],
    interval_s: f64,
    options: &ReadOptions,
) -> Result<Raw, RecordError> {
    let open = |name: &&String| {
        let records = arrays.records(name, interval_s, options)?;
        Ok((name.to_string(), records))
    };
    let opened: Result<Vec<(String, Raw)>, RecordError> = names.iter().map(open).collect();
    let (mut opened, file) = (opened?, arrays.file().to_owned());
    Ok(Box::new(std::iter::from_fn(move || {
        let next = opened
            .iter_mut()
            .map(|(name, records)| Some((name, records.next()?)));
        let next: Vec<_> = next.collect();
        if next.iter().all(Option::is_none) {
            return None;
        }
        Some(joined(&file, next))
    })))
}

/// One shot of channels that came one by one.
fn joined(
    file: &Path,
    channels: Vec<Option<(&mut String, Result<Record, RecordError>)>>,
) -> Result<Record, RecordError> {
    let unlike = |detail: String| RecordError::malformed(file, "arrays", detail);
    let mut joined: Option<Record> = None;
    for channel in channels {
        let (name, record) =
            channel.ok_or_else(|| unlike("not every channel has as many shots".to_owned()))?;
        let mut record = record?;
        let (Some(mut channel), true) = (record.channels.pop(), record.channels.is_empty()) else {
            return Err(unlike(format!(
                "{name:?} has columns of its own: choose it alone"
            )));
        };
        channel.name.clone_from(name);
        joined.get_or_insert(record).channels.push(channel);
    }
    joined.ok_or_else(|| unlike("without channels".to_owned()))
}

/// The records of one array after the other.
fn one_by_one(
    arrays: Rc<dyn Arrays>,
    samples: Vec<String>,
    interval_s: f64,
    options: ReadOptions,
) -> Raw {
    let mut shot = 0;
    let records = samples.into_iter().flat_map(move |name| {
        let opened = arrays.records(&name, interval_s, &options);
        opened.unwrap_or_else(|error| Box::new(std::iter::once(Err(error))))
    });
    Box::new(records.map(move |record| {
        shot += 1;
        record.map(|record| Record {
            shot: Some(shot),
            ..record
        })
    }))
}

/// Speeds that a file tells.
struct Speeds {
    told: Vec<f64>,
    /// How many recordings there are.
    recordings: usize,
}

impl Speeds {
    /// That of a recording, by its number from 0: one is that of all.
    fn of(&self, recording: usize) -> Option<f64> {
        let speed = match self.told.as_slice() {
            [one] => Some(one),
            told if told.len() == self.recordings => told.get(recording),
            _ => None,
        };
        speed.copied().filter(|speed| speed.is_finite())
    }

    /// All of them where they are of shots that are still to be cut out.
    fn of_shots(&self) -> Vec<f64> {
        match self.told.len() {
            0 | 1 => Vec::new(),
            count if count == self.recordings => Vec::new(),
            _ => self.told.clone(),
        }
    }
}

/// Speeds in the order of the recordings; pieces of one have the same.
fn with_speeds(records: Raw, speeds: Speeds, note: Option<String>) -> Raw {
    let mut begun = 0_usize;
    Box::new(records.map(move |record| {
        let goes_on = record.as_ref().is_ok_and(|record| record.first_sample > 0);
        begun += usize::from(!goes_on);
        record.map(|record| Record {
            speed_m_s: speeds.of(begun.saturating_sub(1)),
            speeds_m_s: speeds.of_shots(),
            notes: note.clone().into_iter().collect(),
            ..record
        })
    }))
}
