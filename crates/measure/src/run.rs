//! Recordings into shots, over threads, in the order in which they came.

use crate::error::file_name;
use crate::level::shots_at_level;
use crate::records::{Parts, ReadOptions, Record, Records, read};
use crate::separation::{Content, content};
use crate::signal::{Bandwidth, Estimate, Method, QualityFlag, SignalOptions};
use crate::{Example, Level, MeasureError, Shot, ShotList};
use indexmap::IndexMap;
use rayon::prelude::*;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// Samples that are read before they are measured together: enough for all threads, and some
/// 100 MB at most.
const BATCH: usize = 1 << 22;

/// Samples of a recording that are searched for a level at a time.
const PIECE: usize = 1 << 20;

/// Samples about pulses that shots hold, some 250 MB: later shots hold none, and keep their own picks.
const MOST_HELD: usize = 1 << 26;

/// Widths of pulses of balls, in s: others are probably in another unit of time.
const WIDTHS_S: RangeInclusive<f64> = 1e-6..=5e-3;

/// How recordings are read and measured.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// What files leave open.
    pub reading: ReadOptions,
    /// How recordings that hold several shots are cut, unless `reading` does.
    pub cutting: Cut,
    /// How pulses are found and picked. Without a high-pass of its own, the one that a recording
    /// states is corrected.
    pub measuring: SignalOptions,
    /// Whether the droop of such a high-pass stays in the recording.
    pub keep_droop: bool,
    /// Whether maxima stay as they are behind the low-pass that a recording states.
    pub keep_low_pass: bool,
    /// Speeds and cases of files.
    pub list: Option<ShotList>,
    /// Standard error of speeds in m/s where neither file nor list states one.
    pub speed_error_m_s: Option<f64>,
    /// Most flagged shots whose samples are kept.
    pub most_flagged: usize,
}

/// How recordings that hold several shots are cut.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Cut {
    /// Where several shots are plain in one record.
    #[default]
    Plain,
    /// Never: a record is a shot, flagged where it holds several.
    Never,
    /// Where they pass a level.
    Level(Level),
}

/// What came of a set of recordings.
#[derive(Clone, Debug, Default)]
pub struct Measurement {
    /// Every record that could be read, in order; some without times.
    pub shots: Vec<Shot>,
    /// What could not be read.
    pub refused: Vec<MeasureError>,
    /// Assumptions, and of which files.
    pub notes: Vec<Note>,
    /// The amplifier's low-pass that maxima were corrected for.
    pub bandwidth: Option<Bandwidth>,
    /// What the list of shots and the recordings do not find in each other.
    pub unmatched: Vec<String>,
    /// The first good shot of every case, with its samples.
    pub examples: Vec<Example>,
    /// The first flagged shots, with their samples, as many as were asked for.
    pub flagged: Vec<Example>,
    /// Samples about pulses that its shots hold, for one shape of all shots of a speed.
    pub samples_held: usize,
}

/// An assumption.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// What, and how to say otherwise.
    pub text: String,
    /// Of which files, in order.
    pub files: Vec<PathBuf>,
}

/// Progress of a measurement, from any thread.
pub trait Watch: Sync {
    /// A record is done.
    fn seen(&self) {}

    /// Whether to break off; what was measured until then counts for nothing.
    fn stopped(&self) -> bool {
        false
    }
}

impl Watch for () {}

/// A record, or why there is none and in which file.
type Read = Result<Record, (PathBuf, MeasureError)>;

/// A shot, and where it begins and ends in a record that was cut.
type Done = (Shot, Option<(usize, usize)>);

/// Reads and measures recordings.
///
/// Holds two batches of records at a time, one being read while the other is measured: a recording
/// may be larger than memory. Results do not depend on the number of threads.
pub fn measure(files: &[PathBuf], options: &Options, watch: &dyn Watch) -> Measurement {
    let records = files.iter().flat_map(|file| cut(file, options, |how| read(file, how)));
    let mut measurement = measured_one_by_one(records, options, watch);
    if let Some(list) = &options.list {
        measurement.unmatched = list.unmatched(files, &measurement.shots);
    }
    measurement
}

/// Measures records in memory, as those of files: each is a shot, or a recording of several that is
/// cut. Their `file` is a name.
pub fn measure_records(records: Vec<Record>, options: &Options, watch: &dyn Watch) -> Measurement {
    let records = records.into_iter().flat_map(|record| {
        let file = record.file.clone();
        cut(&file, options, |how| Records::of(record, how))
    });
    measured_one_by_one(records, options, watch)
}

fn measured_one_by_one(
    records: impl Iterator<Item = Read>,
    options: &Options,
    watch: &dyn Watch,
) -> Measurement {
    let mut measurement = Measurement::default();
    let mut records = records.take_while(|_| !watch.stopped());
    let (mut refused, mut speeds) = (Vec::new(), IndexMap::new());
    let mut batch = gather(&mut records, &mut refused);
    while !batch.is_empty() {
        let mut done = Vec::new();
        // Readers stay in this thread; the others measure meanwhile.
        let next = rayon::in_place_scope(|scope| {
            scope.spawn(|_| done = measured(&batch, options, watch));
            gather(&mut records, &mut refused)
        });
        for (shots, record) in done.into_iter().zip(batch) {
            if !record.speeds_m_s.is_empty() {
                speeds.entry(record.file.clone()).or_insert_with(|| record.speeds_m_s.clone());
            }
            measurement.add(shots, &record, options);
        }
        batch = next;
    }
    let (of_files, refused): (Vec<PathBuf>, Vec<MeasureError>) = refused.into_iter().unzip();
    for (file, speeds_m_s) in speeds {
        // Shots of equal length keep their numbers where others were refused, maybe the last ones.
        let missing = match options.reading.parts {
            Parts::Shots(_) => of_files.iter().filter(|other| **other == file).count(),
            _ => 0,
        };
        measurement.assign_speeds(&file, &speeds_m_s, missing as u64, options);
    }
    measurement.refused.splice(0..0, refused);
    measurement.drop_shifted_speeds(options);
    measurement.note_repairs();
    measurement
}

/// The records of a recording, cut at a level if one is given.
fn cut(
    file: &Path,
    options: &Options,
    read: impl FnOnce(&ReadOptions) -> Records,
) -> Box<dyn Iterator<Item = Read>> {
    let of = file.to_owned();
    let refused = move |error: MeasureError| (of.clone(), error);
    let Cut::Level(level) = options.cutting else {
        let records = read(&options.reading);
        return Box::new(records.map(move |record| record.map_err(&refused)));
    };
    let pieces = ReadOptions { parts: Parts::Pieces(PIECE), ..options.reading.clone() };
    let cut = shots_at_level(read(&pieces), level);
    Box::new(cut.map(move |record| record.map_err(&refused)))
}

/// The next records that can be read, as many as are measured together.
fn gather(
    records: &mut dyn Iterator<Item = Read>,
    refused: &mut Vec<(PathBuf, MeasureError)>,
) -> Vec<Record> {
    let (mut batch, mut waiting) = (Vec::new(), 0);
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

fn measured(batch: &[Record], options: &Options, watch: &dyn Watch) -> Vec<Vec<Done>> {
    let cuts = options.cutting == Cut::Plain && options.reading.parts == Parts::Whole;
    let one = |record: &Record| {
        let found = content(&record.channels);
        if let (true, Content::Plain(ranges)) = (cuts, &found) {
            let part = |&(from, to): &(usize, usize)| {
                let part = record.part(from, to - from);
                (Shot { is_cut: true, ..Shot::measure(&part, options) }, Some((from, to)))
            };
            return ranges.iter().map(part).collect();
        }
        let mut shot = Shot::measure(record, options);
        shot.holds_several = found != Content::One;
        shot.is_cut = matches!(options.cutting, Cut::Level(_));
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

/// The corner in Hz of the high-pass that is corrected because the recording states it.
pub(crate) fn stated_high_pass_hz(record: &Record, options: &Options) -> Option<f64> {
    let is_free = options.measuring.high_pass_s.is_none() && !options.keep_droop;
    record.high_pass_hz.filter(|hz| is_free && *hz > 0.0)
}

/// The amplifier's low-pass that maxima are corrected for because the recording states it.
fn stated_bandwidth(record: &Record, options: &Options) -> Option<Bandwidth> {
    let measuring = &options.measuring;
    let is_free = measuring.bandwidth.is_none() && !options.keep_low_pass;
    let is_maximum = measuring.method == Method::Maximum;
    record.low_pass.filter(|_| is_free && is_maximum)
}

/// The amplifier's low-pass that maxima are corrected for: that of the options, of whose order and
/// kind the recording's stand in, or the recording's.
pub(crate) fn bandwidth(record: &Record, options: &Options) -> Option<Bandwidth> {
    let Some(asked) = options.measuring.bandwidth else {
        return stated_bandwidth(record, options);
    };
    let pole = Bandwidth { order: 1, ..asked };
    let stated = || record.low_pass.map(|of| Bandwidth { corner_hz: asked.corner_hz, ..of });
    Some(if asked.order == 0 { stated().unwrap_or(pole) } else { asked })
}

impl Measurement {
    /// Joins what came of each of these files, as [`measure`] returns it of all of them; examples are
    /// left out.
    pub fn of_files<'a>(
        files: impl IntoIterator<Item = (&'a PathBuf, &'a Self)>,
        list: Option<&ShotList>,
    ) -> Self {
        let (mut all, mut names) = (Self::default(), Vec::new());
        for (file, of_file) in files {
            all.shots.extend(of_file.shots.iter().cloned());
            all.samples_held += of_file.samples_held;
            all.refused.extend(of_file.refused.iter().cloned());
            for Note { text, files } in &of_file.notes {
                files.iter().for_each(|file| all.note(text, file));
            }
            all.bandwidth = all.bandwidth.or(of_file.bandwidth);
            names.push(file.clone());
        }
        all.unmatched = list.map_or(Vec::new(), |list| list.unmatched(&names, &all.shots));
        all
    }

    fn add(&mut self, shots: Vec<Done>, record: &Record, options: &Options) {
        let several = shots.len() > 1;
        let mut notes = record.notes.clone();
        notes.extend(stated_high_pass_hz(record, options).map(|corner_hz| {
            format!(
                "states that its amplifier had a high-pass of {corner_hz} Hz, whose droop is \
                 corrected; --ac-coupling states another corner, 0 leaves the droop"
            )
        }));
        self.bandwidth = self.bandwidth.or_else(|| bandwidth(record, options));
        notes.extend(stated_bandwidth(record, options).map(|bandwidth| {
            format!(
                "states that its amplifier had a {bandwidth}, which maxima are corrected for; \
                 --low-pass states another corner, 0 leaves times as they are"
            )
        }));
        notes.extend(several.then(|| {
            "several shots with quiet between them were cut apart; --whole keeps a record one shot, \
             which then counts in no mean, --level and --shot-samples cut otherwise"
                .to_owned()
        }));
        notes.iter().for_each(|note| self.note(note, &record.file));
        for (mut shot, range) in shots {
            if several {
                let of_file = self.shots.iter().rev();
                let before = of_file.take_while(|before| before.file == shot.file);
                let number = before.count() as u64 + 1;
                shot.shot = Some(number);
                shot.source = format!("{}, shot {number}", record.source);
            }
            shot.identify(record.speed_error_m_s, options);
            self.hold_samples(&mut shot);
            self.keep_example(&shot, record, range);
            if self.flagged.len() < options.most_flagged && !shot.flags().is_empty() {
                self.flagged.push(Example::new(&shot, record, range));
            }
            self.shots.push(shot);
        }
    }

    /// Keeps a shot with its samples that is the first good one of its case, or the first with a time.
    fn keep_example(&mut self, shot: &Shot, record: &Record, range: Option<(usize, usize)>) {
        if shot.flight.is_err() {
            return;
        }
        match self.examples.iter_mut().find(|example| example.shot.case == shot.case) {
            None => self.examples.push(Example::new(shot, record, range)),
            Some(example) if example.shot.is_dubious() && !shot.is_dubious() => {
                *example = Example::new(shot, record, range);
            }
            Some(_) => {}
        }
    }

    fn hold_samples(&mut self, shot: &mut Shot) {
        let own: usize = shot.samples.iter().flatten().map(|samples| samples.count()).sum();
        if self.samples_held + own <= MOST_HELD {
            self.samples_held += own;
            return;
        }
        shot.samples = [const { None }; 3];
        let text = "holds shots beyond those whose pulses fit in 250 MB: each keeps its own pick, \
                    without the shape of others; measure fewer files at a time";
        self.note(text, &shot.file);
    }

    fn note(&mut self, text: &str, file: &Path) {
        match self.notes.iter_mut().find(|note| note.text == text) {
            Some(note) if note.files.last().is_some_and(|last| last == file) => {}
            Some(note) => note.files.push(file.to_owned()),
            None => self.notes.push(Note { text: text.to_owned(), files: vec![file.to_owned()] }),
        }
    }

    /// Assigns the shots of a file its speeds, in order, once all of them are cut out. Where there
    /// are not as many speeds as shots, those that the list does not name have none.
    fn assign_speeds(&mut self, file: &Path, speeds: &[f64], missing: u64, options: &Options) {
        let number = |shot: &Shot| shot.shot.unwrap_or(1);
        let of_file = |shot: &&mut Shot| shot.file == file;
        let shots: Vec<&mut Shot> = self.shots.iter_mut().filter(of_file).collect();
        let found = shots.iter().map(|shot| number(shot)).max().unwrap_or(0);
        if !(found..=found + missing).contains(&(speeds.len() as u64)) {
            if shots.iter().any(|shot| shot.speed_m_s.is_none()) {
                let s = if found == 1 { "" } else { "s" };
                let detail = format!(
                    "has {} speeds, and {found} shot{s} were found in it: none was given a speed; \
                     say which is which with --shots, or cut it otherwise with --level or \
                     --shot-samples",
                    speeds.len()
                );
                self.refused.push(MeasureError::Shots(file_name(file), detail));
            }
            return;
        }
        let examples = self.examples.iter_mut().chain(&mut self.flagged);
        let examples = examples.map(|example| &mut example.shot);
        for shot in shots.into_iter().chain(examples.filter(of_file)) {
            let speed = speeds.get((number(shot) as usize).saturating_sub(1)).copied();
            let speed = speed.filter(|speed| speed.is_finite());
            shot.speed_m_s = speed.map(|value| Estimate { value, sigma: 0.0 });
            shot.identify(None, options);
        }
    }

    /// Where a recording was cut into fewer shots than the list numbers, it is not known which one is missing, and
    /// the list's speeds could be those of others.
    fn drop_shifted_speeds(&mut self, options: &Options) {
        let (Some(list), false) = (&options.list, options.cutting == Cut::Never) else {
            return;
        };
        let mut found: IndexMap<PathBuf, (u64, bool)> = IndexMap::new();
        for shot in &self.shots {
            let (count, is_cut) = found.entry(shot.file.clone()).or_default();
            (*count, *is_cut) = (*count + 1, *is_cut || shot.is_cut);
        }
        found.retain(|file, (count, is_cut)| *is_cut && list.most_shots(file) > *count);
        for (file, (found, _)) in found {
            let examples = self.examples.iter_mut().chain(&mut self.flagged);
            let examples = examples.map(|example| &mut example.shot);
            let of_file = self.shots.iter_mut().chain(examples).filter(|shot| shot.file == file);
            of_file.for_each(|shot| shot.speed_m_s = None);
            let detail = format!(
                "is cut into {found} shots, and the table of shots has speeds for {}: none was given a speed; \
                 cut it otherwise with --level or --shot-samples, or leave its lines out",
                list.most_shots(&file)
            );
            self.refused.push(MeasureError::Shots(file_name(&file), detail));
        }
    }

    fn note_repairs(&mut self) {
        let of = |shot: &Shot| {
            let counts = shot.doubts.iter().map(|doubt| match doubt {
                QualityFlag::Spikes(samples) => *samples,
                _ => 0,
            });
            counts.sum::<usize>()
        };
        let samples: usize = self.shots.iter().map(of).sum();
        self.note_shots(
            |shot| of(shot) > 0,
            |shots| {
                format!(
                    "{samples} samples of spikes in {shots} shots were replaced by what their \
                 neighbours say; the flags of these shots count them"
                )
            },
        );
        let is_strange = |shot: &Shot| {
            shot.flight.as_ref().is_ok_and(|it| !WIDTHS_S.contains(&it.picks.wall.width_s))
        };
        self.note_shots(is_strange, |shots| {
            format!(
                "pulses of {shots} shots are narrower than 1 µs or wider than 5 ms at half height, where those of \
                 metal balls have 20 to 200 µs: check the rate (--rate) or the unit of times (--time-unit)"
            )
        });
        self.note_shots(
            |shot| shot.doubts.contains(&QualityFlag::Drift),
            |shots| {
                format!(
                    "hum or drift in {shots} shots: a baseline was fitted around their pulses and \
                 subtracted, and stated errors hold what it leaves open"
                )
            },
        );
    }

    fn note_shots(&mut self, is: impl Fn(&Shot) -> bool, text: impl Fn(usize) -> String) {
        let such = self.shots.iter().filter(|shot| is(shot));
        let files: Vec<PathBuf> = such.map(|shot| shot.file.clone()).collect();
        let text = text(files.len());
        files.iter().for_each(|file| self.note(&text, file));
    }
}
