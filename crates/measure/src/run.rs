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
/// Holds two batches of records at a time, one being read while the other is
/// measured: a recording may be larger than memory. Results do not depend on the
/// number of threads.
#[must_use]
pub fn measure(files: &[PathBuf], options: &Options, seen: &mut dyn FnMut(usize)) -> Measurement {
    let mut measurement = Measurement::default();
    let mut records = files.iter().flat_map(|file| read(file, &options.reading));
    let mut refused = Vec::new();
    let mut batch = gather(&mut records, options, &mut refused);
    while !batch.is_empty() {
        let cases = measurement.cases();
        let mut done = Vec::new();
        // Readers stay in this thread; the others measure meanwhile.
        let next = rayon::in_place_scope(|scope| {
            scope.spawn(|_| done = measured(&batch, &cases, options));
            gather(&mut records, options, &mut refused)
        });
        seen(batch.len());
        measurement.keep(done, batch);
        batch = next;
    }
    measurement.refused = refused;
    measurement
}

/// The next records that can be read, as many as are measured together.
fn gather(
    records: &mut dyn Iterator<Item = Result<Record, RecordError>>,
    options: &Options,
    refused: &mut Vec<RecordError>,
) -> Vec<Record> {
    let mut batch = Vec::new();
    let mut waiting = 0;
    while waiting < BATCH {
        match records.next() {
            None => break,
            Some(Err(error)) => refused.push(error),
            Some(Ok(record)) => {
                waiting += record.len() * record.channels.len();
                batch.push(named(record, options));
            }
        }
    }
    batch
}

/// A shot, and its samples if it may become an example.
type Done = (Shot, Option<Vec<Vec<f64>>>);

fn measured(batch: &[Record], cases: &[String], options: &Options) -> Vec<Done> {
    let one = |record: &Record| {
        let (shot, volts) = Shot::of(record, &options.measuring);
        let worth = shot.flight.is_ok() && !cases.contains(&shot.case);
        (shot, worth.then_some(volts))
    };
    batch.par_iter().map(one).collect()
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
    fn keep(&mut self, done: Vec<Done>, batch: Vec<Record>) {
        for ((shot, volts), record) in done.into_iter().zip(batch) {
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

    /// Cases that have an example.
    fn cases(&self) -> Vec<String> {
        let cases = self.examples.iter().map(|example| &example.shot.case);
        cases.cloned().collect()
    }

    fn has_example(&self, case: &str) -> bool {
        self.examples
            .iter()
            .any(|example| example.shot.case == case)
    }
}
