//! Recordings into shots, over threads, in the order in which they came.

use crate::{Example, Shot, ShotList};
use hertzchain_records::{ReadOptions, Record, RecordError, read};
use hertzchain_signal::Measuring;
use rayon::prelude::*;
use std::path::PathBuf;

/// Samples that are read before they are measured together: enough for all
/// threads, and some 100 MB at most.
const BATCH: usize = 1 << 22;

/// How recordings are read and measured.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// What files leave open.
    pub reading: ReadOptions,
    /// How pulses are found and picked.
    pub measuring: Measuring,
    /// Speeds and cases of files.
    pub list: Option<ShotList>,
    /// Standard error of speeds in m/s where nobody else tells one.
    pub speed_error_m_s: Option<f64>,
}

/// What came of a set of recordings.
#[derive(Debug, Default)]
pub struct Measurement {
    /// Every record that could be read, in order; some without times.
    pub shots: Vec<Shot>,
    /// What could not be read.
    pub refused: Vec<RecordError>,
    /// The first good shot of every case, with its samples.
    pub examples: Vec<Example>,
    /// Samples that were read, all channels together.
    pub samples: u64,
}

/// Reads and measures recordings; `seen` is told how many records are done.
///
/// Holds a batch of records at a time: a recording may be larger than memory.
/// Results do not depend on the number of threads.
#[must_use]
pub fn measure(files: &[PathBuf], options: &Options, seen: &mut dyn FnMut(usize)) -> Measurement {
    let mut measurement = Measurement::default();
    for file in files {
        let mut batch = Vec::new();
        let mut waiting = 0;
        for record in read(file, &options.reading) {
            match record {
                Ok(record) => {
                    waiting += record.len() * record.channels.len();
                    batch.push(named(record, options));
                }
                Err(error) => measurement.refused.push(error),
            }
            if waiting >= BATCH {
                seen(batch.len());
                measurement.take(std::mem::take(&mut batch), options);
                waiting = 0;
            }
        }
        seen(batch.len());
        measurement.take(batch, options);
    }
    measurement
}

/// A record with what the list says of it.
fn named(mut record: Record, options: &Options) -> Record {
    let entry = options
        .list
        .as_ref()
        .and_then(|list| list.find(&record.file, record.shot));
    if let Some(entry) = entry {
        record.speed_m_s = entry.speed_m_s.or(record.speed_m_s);
        record.speed_error_m_s = entry.speed_error_m_s.or(record.speed_error_m_s);
        record.case = entry.case.clone().or(record.case);
    }
    record.speed_error_m_s = record.speed_error_m_s.or(options.speed_error_m_s);
    record
}

impl Measurement {
    fn take(&mut self, batch: Vec<Record>, options: &Options) {
        let measured: Vec<(Shot, Option<Vec<Vec<f64>>>)> = batch
            .par_iter()
            .map(|record| {
                let (shot, volts) = Shot::of(record, &options.measuring);
                let worth = shot.flight.is_ok() && !self.has_example(&shot.case);
                (shot, worth.then_some(volts))
            })
            .collect();
        for ((shot, volts), record) in measured.into_iter().zip(batch) {
            self.samples += (record.len() * record.channels.len()) as u64;
            if let Some(volts) = volts.filter(|_| !self.has_example(&shot.case)) {
                self.examples.push(Example {
                    shot: shot.clone(),
                    names: record.channels.into_iter().map(|c| c.name).collect(),
                    volts,
                });
            }
            self.shots.push(shot);
        }
    }

    fn has_example(&self, case: &str) -> bool {
        self.examples
            .iter()
            .any(|example| example.shot.case == case)
    }
}
