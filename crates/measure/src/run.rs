//! Recordings into shots, over threads, in the order in which they came.

use crate::level::AtLevel;
use crate::records::{Parts, ReadOptions, Record, read};
use crate::several::{Content, content};
use crate::signal::{Bandwidth, Method, QualityFlag, SignalOptions};
use crate::speeds::Speeds;
use crate::{Example, Level, MeasureError, Shot, ShotList};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// Samples that are read before they are measured together: enough for all
/// threads, and some 100 MB at most.
const BATCH: usize = 1 << 22;

/// Samples of a recording that are looked through for a level at a time.
const PIECE: usize = 1 << 20;

/// How recordings are read and measured.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// What files leave open.
    pub reading: ReadOptions,
    /// How recordings that hold several shots are cut, unless `reading` does.
    pub cutting: Cut,
    /// How pulses are found and picked. Without a high-pass of its own, that of which a
    /// recording tells is taken out of it.
    pub measuring: SignalOptions,
    /// Whether the droop of such a high-pass stays in the recording.
    pub keep_droop: bool,
    /// Whether maxima stay as they are behind the low-pass that a recording states.
    pub keep_low_pass: bool,
    /// Speeds and cases of files.
    pub list: Option<ShotList>,
    /// Standard error of speeds in m/s where nobody else tells one.
    pub speed_error_m_s: Option<f64>,
}

/// How recordings that hold several shots are cut.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Cut {
    /// Where several shots are plain in one record.
    #[default]
    Plain,
    /// Never: a record is a shot.
    Never,
    /// Where they pass a level.
    Level(Level),
}

/// What came of a set of recordings.
#[derive(Debug, Default)]
pub struct Measurement {
    /// Every record that could be read, in order; some without times.
    pub shots: Vec<Shot>,
    /// What could not be read.
    pub refused: Vec<MeasureError>,
    /// What was taken for granted, and of which files.
    pub notes: Vec<Note>,
    /// The amplifier's low-pass that maxima were corrected for.
    pub bandwidth: Option<Bandwidth>,
    /// What the list of shots and the recordings do not find in each other.
    pub unmatched: Vec<String>,
    /// The first good shot of every case, with its samples.
    pub examples: Vec<Example>,
}

/// Something that was taken for granted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// What, and how to say otherwise.
    pub text: String,
    /// Of which files, in order.
    pub files: Vec<PathBuf>,
}

/// Who follows a measurement, from any thread.
pub trait Watch: Sync {
    /// A record is done.
    fn seen(&self) {}

    /// Whether to break off; what was measured until then counts for nothing.
    fn stopped(&self) -> bool {
        false
    }
}

/// Nobody.
impl Watch for () {}

type Read = Box<dyn Iterator<Item = Result<Record, (PathBuf, MeasureError)>>>;

/// Reads and measures recordings while somebody may watch.
///
/// Holds two batches of records at a time, one being read while the other is
/// measured: a recording may be larger than memory. Results do not depend on the
/// number of threads.
#[must_use]
pub fn measure(files: &[PathBuf], options: &Options, watch: &dyn Watch) -> Measurement {
    let mut measurement = Measurement {
        bandwidth: options.measuring.bandwidth,
        ..Measurement::default()
    };
    let records = files.iter().flat_map(|file| records(file, options));
    let mut records = records.take_while(|_| !watch.stopped());
    let mut refused = Vec::new();
    let mut speeds = Speeds::default();
    let mut batch = gather(&mut records, &mut refused);
    while !batch.is_empty() {
        let mut done = Vec::new();
        // Readers stay in this thread; the others measure meanwhile.
        let next = rayon::in_place_scope(|scope| {
            scope.spawn(|_| done = measured(&batch, options, watch));
            gather(&mut records, &mut refused)
        });
        for (shots, record) in done.into_iter().zip(batch) {
            speeds.hear(&record);
            measurement.keep(shots, &record, options);
        }
        batch = next;
    }
    let (of_files, refused): (Vec<PathBuf>, Vec<MeasureError>) = refused.into_iter().unzip();
    speeds.deal(&mut measurement, options, &of_files);
    measurement.refused.splice(0..0, refused);
    measurement.note_spikes();
    if let Some(list) = &options.list {
        measurement.unmatched = list.unmatched(files, &measurement.shots);
    }
    measurement
}

/// The records of a file, cut at a level if one is given.
fn records(file: &Path, options: &Options) -> Read {
    let of = file.to_owned();
    let refused = move |error: MeasureError| (of.clone(), error);
    match options.cutting {
        Cut::Level(level) => {
            let pieces = ReadOptions {
                parts: Parts::Pieces(PIECE),
                ..options.reading.clone()
            };
            let cut = AtLevel::new(read(file, &pieces), level);
            Box::new(cut.map(move |record| record.map_err(&refused)))
        }
        _ => {
            let records = read(file, &options.reading);
            Box::new(records.map(move |record| record.map_err(&refused)))
        }
    }
}

/// The next records that can be read, as many as are measured together.
fn gather(
    records: &mut dyn Iterator<Item = Result<Record, (PathBuf, MeasureError)>>,
    refused: &mut Vec<(PathBuf, MeasureError)>,
) -> Vec<Record> {
    let mut batch = Vec::new();
    let mut waiting = 0;
    while waiting < BATCH {
        match records.next() {
            None => break,
            Some(Err(error)) => refused.push(error),
            Some(Ok(record)) => {
                waiting += record.len() * record.channels.len();
                batch.push(record);
            }
        }
    }
    batch
}

/// A shot, and where it begins and ends in a record that was cut.
type Done = (Shot, Option<(usize, usize)>);

fn measured(batch: &[Record], options: &Options, watch: &dyn Watch) -> Vec<Vec<Done>> {
    let searched = options.cutting == Cut::Plain && options.reading.parts == Parts::Whole;
    let one = |record: &Record| {
        let volts = volts(record);
        let found = match searched {
            true => content(&volts),
            false => Content::One,
        };
        if let Content::Plain(ranges) = found {
            let part = |(from, to)| {
                let part = record.part(from, to - from);
                let volts = self::volts(&part);
                (Shot::of(&part, &volts, options), Some((from, to)))
            };
            return ranges.into_iter().map(part).collect();
        }
        let shot = Shot {
            holds_several: found == Content::Mixed,
            ..Shot::of(record, &volts, options)
        };
        vec![(shot, None)]
    };
    let watched = |record: &Record| {
        if watch.stopped() {
            return Vec::new();
        }
        let done = one(record);
        watch.seen();
        done
    };
    batch.par_iter().map(watched).collect()
}

/// The corner in Hz of the high-pass whose droop is taken out because the recording tells of it.
pub(crate) fn told_high_pass_hz(record: &Record, options: &Options) -> Option<f64> {
    let nobody_says = options.measuring.high_pass_s.is_none() && !options.keep_droop;
    record.high_pass_hz.filter(|hz| nobody_says && *hz > 0.0)
}

/// The amplifier's low-pass that maxima are corrected for because the recording states it.
pub(crate) fn stated_bandwidth(record: &Record, options: &Options) -> Option<Bandwidth> {
    let measuring = &options.measuring;
    let asked = measuring.bandwidth.is_some() || options.keep_low_pass;
    let low_pass = record.low_pass.filter(|_| !asked)?;
    (measuring.method == Method::Maximum).then_some(Bandwidth {
        corner_hz: low_pass.corner_hz,
        order: low_pass.order,
    })
}

/// Every channel of a record in V.
fn volts(record: &Record) -> Vec<Vec<f64>> {
    let channels = record.channels.iter();
    channels.map(|channel| channel.samples.volts()).collect()
}

impl Measurement {
    fn keep(&mut self, shots: Vec<Done>, record: &Record, options: &Options) {
        for note in &record.notes {
            self.note(note, &record.file);
        }
        if let Some(corner_hz) = told_high_pass_hz(record, options) {
            self.note(
                &format!(
                    "states that its amplifier had a high-pass of {corner_hz} Hz, whose droop is \
                     corrected; --ac-coupling states another corner, 0 leaves the droop"
                ),
                &record.file,
            );
        }
        if let Some(bandwidth) = stated_bandwidth(record, options) {
            self.bandwidth.get_or_insert(bandwidth);
            let Bandwidth { corner_hz, order } = bandwidth;
            self.note(
                &format!(
                    "states that its amplifier had a low-pass of {corner_hz} Hz, order {order}, \
                     which maxima are corrected for; --low-pass states another corner, 0 leaves \
                     times as they are"
                ),
                &record.file,
            );
        }
        if shots.len() > 1 {
            self.note(
                "several shots with quiet between them were cut apart; --whole keeps a record one \
                 shot, --level and --shot-samples cut otherwise",
                &record.file,
            );
        }
        let several = shots.len() > 1;
        for (mut shot, range) in shots {
            if several {
                let of_file = self.shots.iter().rev();
                let before = of_file.take_while(|before| before.file == shot.file);
                let number = before.count() as u64 + 1;
                shot.shot = Some(number);
                shot.source = format!("{}, shot {number}", record.source);
            }
            shot.name(record.speed_error_m_s, options);
            if shot.flight.is_ok() && !self.has_example(&shot.case) {
                self.examples.push(Example::of(&shot, record, range));
            }
            self.shots.push(shot);
        }
    }

    fn note(&mut self, text: &str, file: &Path) {
        let known = self.notes.iter_mut().find(|note| note.text == text);
        match known {
            Some(note) if note.files.last().is_some_and(|last| last == file) => {}
            Some(note) => note.files.push(file.to_owned()),
            None => self.notes.push(Note {
                text: text.to_owned(),
                files: vec![file.to_owned()],
            }),
        }
    }

    /// How many samples were no part of the signal, and in which files.
    fn note_spikes(&mut self) {
        let of = |shot: &Shot| {
            let counts = shot.doubts.iter().map(|doubt| match doubt {
                QualityFlag::Spikes(samples) => *samples,
                _ => 0,
            });
            counts.sum::<usize>()
        };
        let spiked = self.shots.iter().filter(|shot| of(shot) > 0);
        let (shots, samples) = (
            spiked.clone().count(),
            spiked.clone().map(of).sum::<usize>(),
        );
        let files: Vec<PathBuf> = spiked.map(|shot| shot.file.clone()).collect();
        let text = format!(
            "{samples} samples of spikes in {shots} shots were replaced by what their neighbours \
             say; the flags of these shots count them"
        );
        for file in files {
            self.note(&text, &file);
        }
    }

    fn has_example(&self, case: &str) -> bool {
        self.examples
            .iter()
            .any(|example| example.shot.case == case)
    }
}
