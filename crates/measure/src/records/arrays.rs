//! Arrays of numbers, alone or several by name in one file: samples, times, rates and speeds.

use crate::error::{MeasureError, Result, file_name};
use crate::records::interval::{interval_s, other_interval, seconds_assumed};
use crate::records::options::{
    MOST_CHANNELS, MOST_COLUMNS, Parts, ReadOptions, Rows, ambiguous, chosen, list, numbered,
};
use crate::records::read::{Raw, or_error};
use crate::records::record::Record;
use crate::records::stored::Head;
use crate::records::text::seconds;
use indexmap::IndexMap;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::rc::Rc;

/// Names, in any case, of numbers that are an interval in s, and a rate in Hz.
pub(crate) const INTERVALS: &[&str] =
    &["dt", "interval", "interval_s", "sampling_interval", "sampling_interval_s", "tinterval"];
pub(crate) const RATES: &[&str] =
    &["fs", "rate", "rate_hz", "sample_rate", "sample_rate_hz", "sampling_rate", "samplerate"];
/// Two intervals that differ by more are not one that was rounded.
const SAME: f64 = 1e-3;
/// Share by which intervals of one array may differ.
const JITTER: f64 = 1e-2;
/// So many samples are not looked at one by one, for which numbers are about them.
const MOST_CHOSEN: usize = 64;
/// Name of a single number that is an interval in s, if below [`LONGEST_S`]; else of times.
const PERIOD: &str = "ts";
const LONGEST_S: f64 = 1.0;
/// Names of arrays of times without a unit, and in s.
const TIMES: &[&str] = &["t", "time", "times", PERIOD];
const TIMES_S: &[&str] = &["time_s", "t_s"];
const SPEEDS: &[&str] = &["speed", "speeds", "speed_m_s", "speeds_m_s", "v0"];
/// Words in names of groups that are channels, not shots; so are single letters from the first on,
/// with or without a number.
#[rustfmt::skip]
const CHANNELS: &[&str] = &[
    "adc", "ai", "bead", "ch", "chan", "channel", "channels", "input", "kanal", "probe", "sensor", "wall",
];
const LETTERS: &[&str] = &["a", "b", "c", "d"];
/// Names, before a number, of arrays that are shots.
const SHOTS: &[&str] = &["arr", "shot", "record", "rec", "run", "segment", "seg", "event", "trial"];

pub(crate) const TIMES_SEEN: usize = 4096;

/// Fewer numbers may rise evenly by chance.
const LEAST_TIMES: usize = 32;

/// Share of a step by which times may be off even ones, besides single precision's own rounding;
/// and the most that both may be.
const EVEN: f64 = 1e-3;
const ROUNDED: f64 = 0.4;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Axes {
    pub shots: Option<usize>,
    pub channels: Option<usize>,
    pub time: usize,
}

impl Axes {
    /// The axes of an array of this shape, if it can be one of samples.
    fn new(shape: &[usize], rows: Rows) -> Option<Self> {
        let (shots, channels, time) = match (shape, rows) {
            (&[_], _) => (None, None, 0),
            (&[a, b], Rows::Auto) if a <= b => (Some(0), None, 1),
            (&[_, _], Rows::Shots) => (Some(0), None, 1),
            (&[_, _], Rows::Channels) => (None, Some(0), 1),
            (&[_, _], Rows::Moments) => (Some(1), None, 0),
            (&[_, _], Rows::Auto | Rows::Times) => (None, Some(1), 0),
            (&[_, _, _], _) => (Some(0), Some(1), 2),
            _ => return None,
        };
        Some(Self { shots, channels, time })
    }
}

pub(crate) struct SampleTable {
    pub axes: Axes,
    pub chosen: Vec<usize>,
    pub head: Head,
}

impl SampleTable {
    pub(crate) fn new(
        file: &Path,
        part: Option<String>,
        shape: &[usize],
        interval_s: f64,
        options: &ReadOptions,
    ) -> Result<Self> {
        if shape.contains(&0) {
            return Err(MeasureError::empty(file_name(file)));
        }
        let axes = Axes::new(shape, options.rows_of(shape)).ok_or_else(|| {
            let detail = format!("of {} axes, {shape:?}, is no table of samples", shape.len());
            MeasureError::malformed(file, "an array", detail)
        })?;
        let size = |axis: Option<usize>| axis.map_or(1, |axis| shape[axis]);
        let (rows, frames) = (size(axes.shots), shape[axes.time]);
        let names = numbered(size(axes.channels));
        let chosen = match names.len() {
            1 if options.channels.is_empty() => vec![0],
            _ => chosen(file, &names, options)?,
        };
        let note = match axes.shots.filter(|_| options.rows == Rows::Auto) {
            Some(1) => Some(format!(
                "each of the {rows} columns, of {frames} samples, was taken for a shot; --rows \
                 times or --channel says that they are channels"
            )),
            Some(0) if rows == 2 => Some(format!(
                "each of the 2 rows, of {frames} samples, was taken for a shot; --rows channels \
                 says that they are two sensors of one"
            )),
            _ => None,
        };
        let head = Head {
            file: file.to_owned(),
            part,
            names: chosen.iter().map(|index| names[*index].clone()).collect(),
            interval_s,
            rows,
            frames,
            note,
        };
        Ok(Self { axes, chosen, head })
    }
}

/// A step between numbers in s; `None` of counts, which have no unit.
pub(crate) fn step_s(step: f64, options: &ReadOptions) -> Option<f64> {
    let counts = step == 1.0 && options.time_unit_s.is_none();
    (!counts).then(|| step * options.time_unit_s.unwrap_or(1.0))
}

/// The step of numbers that rise evenly; those in single precision are rounded.
pub(crate) fn even_step(values: &[f64]) -> Option<f64> {
    let (first, last) = (values.first()?, values.last()?);
    let step = mean_step(values)?;
    let rounding = f64::from(f32::EPSILON) * first.abs().max(last.abs());
    let most = (EVEN * step + rounding).min(ROUNDED * step);
    let even = |(i, value): (usize, &f64)| (value - first - i as f64 * step).abs() <= most;
    let all = values.len() >= LEAST_TIMES && step > 0.0 && values.iter().enumerate().all(even);
    all.then_some(step)
}

fn mean_step(times: &[f64]) -> Option<f64> {
    let steps = times.len().checked_sub(1).filter(|steps| *steps > 0)?;
    Some((times.last()? - times.first()?) / steps as f64)
}

/// A file of named arrays. Names may be paths.
pub(crate) trait Arrays {
    fn file(&self) -> &Path;

    fn names(&self) -> Vec<String>;

    fn shape(&self, name: &str) -> Result<Vec<usize>>;

    fn values(&self, name: &str) -> Result<Vec<f64>>;

    fn records(&self, name: &str, interval_s: f64, options: &ReadOptions) -> Result<Raw>;

    /// The unit that an array states beside its name.
    fn unit(&self, _name: &str) -> Option<String> {
        None
    }

    /// Intervals that attributes of arrays of these names state: as such, and by a rate.
    fn stated_s(&self, _names: &[String]) -> [Vec<f64>; 2] {
        [const { Vec::new() }; 2]
    }

    /// The same of attributes of anything in the file, if they agree.
    fn stated_anywhere_s(&self) -> [Option<f64>; 2] {
        [None; 2]
    }

    /// Error of a file that ends early, which is reported before a rate is asked for.
    fn cut_short(&self) -> Option<MeasureError> {
        None
    }
}

/// The records of a file of named arrays.
///
/// One array is shots or channels by its axes. Several are shots if they are called so, else
/// channels.
pub(crate) fn open(arrays: Rc<dyn Arrays>, options: &ReadOptions) -> Result<Raw> {
    let names = arrays.names();
    let all_speeds = names.iter().filter(|name| is(SPEEDS, name)).map(|name| arrays.values(name));
    let speeds = all_speeds.collect::<Result<Vec<_>, _>>()?.concat();
    let known = [INTERVALS, RATES, TIMES, TIMES_S, SPEEDS].concat();
    let mut samples = names.clone();
    samples.retain(|name| {
        // Single numbers beside them are whatever they are.
        let single = |shape: Vec<usize>| shape.iter().all(|size| *size == 1);
        !is(&known, name) && !arrays.shape(name).is_ok_and(single)
    });
    if samples.is_empty() {
        return Err(no_samples(arrays.file(), &names));
    }
    let groups = Groups::of(&names, &samples, options);
    let mut stated = Stated::of_all(&*arrays, (&names, &samples), &groups, options)?;
    let mut read = options.clone();
    if let Some((others, step)) = time_column(&*arrays, &samples, options) {
        read = others;
        if stated.interval_s.is_none() {
            stated.interval_s = step_s(step, options);
            let assumed = stated.interval_s.and_then(|_| seconds_assumed("", None, options));
            stated.note = stated.note.or(assumed);
        }
    }
    let note = stated.note.clone();
    let (records, recordings) = of_samples(&arrays, samples, (Rc::new(groups), stated), &read)?;
    Ok(with_speeds(records, speeds, recordings, note))
}

fn is(known: &[&str], name: &str) -> bool {
    known.contains(&&*last(name).to_lowercase())
}

/// What numbers and attributes state of the interval between samples.
#[derive(Clone, Debug, Default)]
struct Stated {
    interval_s: Option<f64>,
    note: Option<String>,
}

impl Stated {
    /// What a file states for all of its samples: no array of a single shot has a say in that of others, nor one
    /// of another group where those about the samples say it.
    fn of_all(
        arrays: &dyn Arrays,
        (names, samples): (&[String], &[String]),
        groups: &Groups,
        options: &ReadOptions,
    ) -> Result<Self> {
        let singles = shots(samples, options).filter(|found| !found.1);
        let singles: HashSet<String> =
            singles.map(|found| found.0.concat()).into_iter().flatten().collect();
        let is_shared = |name: &&String| !singles.contains(*name) && !groups.has(name);
        let shared: Vec<String> = names.iter().filter(is_shared).cloned().collect();
        let is_chosen = |name: &&String| {
            let mut chosen = options.channels.iter();
            options.channels.is_empty() || chosen.any(|of| of == *name || of == last(name))
        };
        let chosen: Vec<&String> = samples.iter().filter(is_chosen).collect();
        let all: HashSet<&String> = samples.iter().collect();
        let about: HashSet<&str> =
            chosen.iter().map(|name| above(name).next().unwrap_or_default()).collect();
        let is_about = |name: &&String| {
            let group = above(name).next().unwrap_or_default();
            let is_other = all.contains(name) && !chosen.contains(name);
            !is_other && (group.is_empty() || about.contains(group))
        };
        let near: Vec<String> = match chosen.len() {
            0..MOST_CHOSEN => shared.iter().filter(is_about).cloned().collect(),
            _ => shared.clone(),
        };
        let mut found = Self::of(arrays, &near, options)?;
        if found.interval_s.is_none() {
            found = Self::of(arrays, &shared, options)?;
        }
        if found.interval_s.is_none() {
            let [interval_s, rate_s] = arrays.stated_anywhere_s();
            found.interval_s = interval_s.or(rate_s);
            found.note = both(rate_s, interval_s, options).or(found.note);
        }
        Ok(found)
    }

    /// What a shot's own arrays state, else what is stated for all.
    fn of_shot(&self, arrays: &dyn Arrays, own: &[String], options: &ReadOptions) -> Result<Self> {
        let found = Self::of(arrays, own, options)?;
        Ok(if found.interval_s.is_some() { found } else { self.clone() })
    }

    /// What arrays of these names state, and their attributes.
    fn of(arrays: &dyn Arrays, names: &[String], options: &ReadOptions) -> Result<Self> {
        let file = arrays.file();
        let values = |known: &[&str]| -> Result<Vec<Vec<f64>>> {
            names.iter().filter(|name| is(known, name)).map(|name| arrays.values(name)).collect()
        };
        let one = |of: Vec<f64>| one_interval(file, of, options);
        let single = |found: &Vec<f64>| found.len() == 1 && found[0] < LONGEST_S;
        let steps = |times: Vec<Vec<f64>>, unit_s: f64| -> Vec<f64> {
            times.iter().filter_map(|times| Some(mean_step(times)? * unit_s)).collect()
        };
        let [by_interval_s, by_rate_s] = arrays.stated_s(names);
        let rates = values(RATES)?.into_iter().map(steadied).collect::<Vec<_>>().concat();
        let intervals = values(INTERVALS)?.into_iter().map(steadied).collect::<Vec<_>>().concat();
        let period_s = values(&[PERIOD])?.into_iter().filter(single).flatten().collect();
        let stated = [
            one(by_interval_s)?,
            one(by_rate_s)?,
            one(intervals)?,
            one(rates.iter().map(|rate| rate.recip()).collect())?,
            one(period_s)?,
        ];
        let named = names.iter().find(|name| is(TIMES, name));
        let unit_s = named.and_then(|name| seconds(&arrays.unit(name)?));
        let mut of_times = steps(values(TIMES_S)?, 1.0);
        of_times.extend(steps(values(TIMES)?, unit_s.or(options.time_unit_s).unwrap_or(1.0)));
        let taken = match stated.into_iter().flatten().next() {
            Some(stated) => Some(stated),
            None => one(of_times.clone())?,
        };
        let all = stated.into_iter().chain(of_times.into_iter().map(Some));
        let contradiction = all.filter_map(|other| both(other, taken, options)).next();
        let is_assumed =
            stated.iter().all(Option::is_none) && !names.iter().any(|it| is(TIMES_S, it));
        let assumed = || seconds_assumed(named?, unit_s, options).filter(|_| is_assumed);
        Ok(Self { interval_s: taken, note: contradiction.or_else(assumed) })
    }

    /// The interval in s, with what the options say.
    fn found_s(&self, arrays: &dyn Arrays, options: &ReadOptions) -> Result<f64> {
        let found = interval_s(arrays.file(), self.interval_s, options);
        found.map_err(|error| arrays.cut_short().unwrap_or(error))
    }
}

/// The arrays in each shot's group, those of its own groups included.
struct Groups(HashMap<String, Vec<String>>);

impl Groups {
    fn of(names: &[String], samples: &[String], options: &ReadOptions) -> Self {
        let shots = shots(samples, options).filter(|found| found.1);
        let first = shots.iter().flat_map(|found| &found.0).filter_map(|shot| shot.first());
        let parents = first.filter_map(|first| Some(above(first).next()?.to_owned()));
        let mut groups: HashMap<String, Vec<String>> =
            parents.map(|group| (group, Vec::new())).collect();
        for name in names.iter().filter(|_| !groups.is_empty()).collect::<Vec<_>>() {
            if let Some(group) = above(name).find(|group| groups.contains_key(*group)) {
                groups.entry(group.to_owned()).or_default().push(name.clone());
            }
        }
        Self(groups)
    }

    /// Whether an array is in a shot's group.
    fn has(&self, name: &str) -> bool {
        !self.0.is_empty() && above(name).any(|group| self.0.contains_key(group))
    }

    /// The arrays that are a shot's own: those of its group, or it alone.
    fn own<'a>(&'a self, shot: &'a [String], is_group: bool) -> &'a [String] {
        let first = shot.first().filter(|_| is_group);
        let group = first.and_then(|first| self.0.get(above(first).next()?));
        group.map_or(shot, Vec::as_slice)
    }
}

/// The groups that an array is in, from the nearest on.
fn above(name: &str) -> impl Iterator<Item = &str> {
    name.rmatch_indices('/').map(|(at, _)| &name[..at])
}

/// The note on two intervals that are not the same.
fn both(other_s: Option<f64>, taken_s: Option<f64>, options: &ReadOptions) -> Option<String> {
    let (other, taken) = other_s.zip(taken_s)?;
    let differ = options.rate_hz.is_none() && (other / taken - 1.0).abs() > SAME;
    differ.then(|| other_interval(other, taken))
}

/// The mean of numbers of one array that differ by no more than a clock's jitter; else all of them.
fn steadied(values: Vec<f64>) -> Vec<f64> {
    let Some(&first) = values.first().filter(|first| **first > 0.0) else {
        return values;
    };
    let is_steady = values.iter().all(|value| (value / first - 1.0).abs() < JITTER);
    if is_steady { vec![values.iter().sum::<f64>() / values.len() as f64] } else { values }
}

/// The one interval in s that several numbers state; unlike ones are not those of one recording.
pub(crate) fn one_interval(
    file: &Path,
    mut of: Vec<f64>,
    options: &ReadOptions,
) -> Result<Option<f64>> {
    of.retain(|step| step.is_finite() && *step > 0.0);
    let Some(&first) = of.first() else {
        return Ok(None);
    };
    let other = of.iter().find(|step| (*step / first - 1.0).abs() > SAME);
    match other.filter(|_| options.rate_hz.is_none()) {
        Some(other) => Err(MeasureError::Rate(
            file_name(file),
            format!(
                "states intervals between samples of {} and of {} µs, and not which samples have which; \
                 expected groups of the same datasets with one each, or --rate for all",
                1e6 * first,
                1e6 * other
            ),
        )),
        None => Ok(Some(first)),
    }
}

/// Times among few columns, or few rows, of the only array of samples: the first, if it rises
/// evenly, as no signal does. How the others are to be read, and the step of the times.
fn time_column(
    arrays: &dyn Arrays,
    samples: &[String],
    options: &ReadOptions,
) -> Option<(ReadOptions, f64)> {
    let [one] = samples else { return None };
    let &[first, second] = arrays.shape(one).ok()?.as_slice() else {
        return None;
    };
    let (columns, long) = (first.min(second), first.max(second));
    let rows = match first <= second {
        true => Rows::Channels,
        false => Rows::Times,
    };
    let may_be = (2..=MOST_COLUMNS).contains(&columns) && long >= LEAST_TIMES;
    let free = options.rows == Rows::Auto || options.rows == rows;
    let wanted = |name: &String| name == "1" || name == one;
    if !may_be || !free || options.channels.iter().any(wanted) {
        return None;
    }
    let looking = ReadOptions {
        rows,
        channels: vec!["1".to_owned()],
        parts: Parts::Pieces(TIMES_SEEN),
        ..options.clone()
    };
    let record = arrays.records(one, 1.0, &looking).ok()?.next()?.ok()?;
    let step = even_step(&record.channels.first()?.volts)?;
    let are_chosen = !options.channels.is_empty() || columns > MOST_CHANNELS + 1;
    let others = ReadOptions {
        rows,
        channels: match are_chosen {
            true => options.channels.clone(),
            false => numbered(columns).split_off(1),
        },
        ..options.clone()
    };
    Some((others, step))
}

pub(crate) fn no_samples(file: &Path, names: &[String]) -> MeasureError {
    let mut detail = "holds no samples".to_owned();
    if !names.is_empty() {
        detail += &format!(", only {}", list(names));
    }
    if file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mat")) {
        detail += "; arrays, structs and cells of numbers are read, not objects nor tables: save their \
                   numbers as arrays";
    }
    MeasureError::Samples(file_name(file), detail)
}

pub(crate) fn last(name: &str) -> &str {
    name.rsplit('/').next().unwrap_or(name)
}

fn rows(arrays: &dyn Arrays, name: &str, options: &ReadOptions) -> Result<usize> {
    let shape = arrays.shape(name)?;
    let axes = Axes::new(&shape, options.rows_of(&shape));
    let rows = axes.and_then(|axes| shape.get(axes.shots?));
    Ok(rows.copied().unwrap_or(1))
}

/// The records of arrays of samples, and the number of their recordings.
fn of_samples(
    arrays: &Rc<dyn Arrays>,
    samples: Vec<String>,
    (groups, stated): (Rc<Groups>, Stated),
    options: &ReadOptions,
) -> Result<(Raw, usize)> {
    let file = arrays.file();
    // Columns of an array that is itself chosen are not chosen from.
    let free = ReadOptions { channels: Vec::new(), ..options.clone() };
    if let [one] = samples.as_slice() {
        let is_it = |channel: &String| channel == one || channel == last(one);
        let options = match options.channels.iter().any(is_it) {
            true => &free,
            false => options,
        };
        let recordings = rows(&**arrays, one, options)?;
        let interval_s = stated.found_s(&**arrays, options)?;
        return Ok((arrays.records(one, interval_s, options)?, recordings));
    }
    if let Some((shots, are_groups)) = shots(&samples, options) {
        let each = samples.iter().map(|name| rows(&**arrays, name, options));
        let recordings = match options.parts {
            _ if are_groups => shots.len(),
            // Shots of equal length come one by one, whatever array they are of.
            Parts::Shots(_) => 0,
            _ => each.sum::<Result<usize>>()?,
        };
        let note = groups_assumed(&shots).filter(|_| are_groups);
        let all =
            shot_by_shot(arrays.clone(), shots, (groups, stated), options.clone(), are_groups);
        return Ok((with_note(all, note), recordings));
    }
    let interval_s = stated.found_s(&**arrays, options)?;
    let chosen = chosen(file, &samples, options)?;
    let chosen: Vec<&String> = chosen.iter().filter_map(|i| samples.get(*i)).collect();
    for name in &chosen {
        // Tables may as well be of different chains; MATLAB's columns have a second axis of size 1.
        let axes = arrays.shape(name)?.into_iter().filter(|size| *size > 1);
        if options.channels.is_empty() && axes.count() > 1 {
            return Err(ambiguous(file, &samples));
        }
    }
    let recordings = chosen.first().map(|name| rows(&**arrays, name, &free));
    let recordings = recordings.unwrap_or(Ok(0))?;
    let records = side_by_side(arrays, &chosen, interval_s, &free)?;
    Ok((records, recordings))
}

/// Whether a name is that of a shot, or of a cell of MATLAB.
fn is_shot(name: &str) -> bool {
    let (stem, number) = numbered_name(name);
    if name.ends_with('}') {
        return true;
    }
    let word = stem.trim_end_matches(['_', '-', ' ']).to_lowercase();
    number.is_some() && SHOTS.contains(&word.as_str())
}

fn is_channel(name: &str) -> bool {
    let name = name.to_lowercase();
    let mut words = name.split(|letter: char| !letter.is_alphabetic());
    words.any(|word| CHANNELS.contains(&word)) || LETTERS.contains(&numbered_name(&name).0)
}

/// A name without its number at the end, which may stand in brackets.
fn numbered_name(name: &str) -> (&str, Option<u64>) {
    let name = name.trim_end_matches(['}', ')']);
    let stem = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
    (stem, name[stem.len()..].parse().ok())
}

/// Arrays of each group, in the order of the groups' names and numbers, where every group is a shot:
/// more than one, with arrays of the same names, and none called as channels are.
fn shot_groups(samples: &[String]) -> Option<Vec<Vec<String>>> {
    let mut groups: IndexMap<&str, Vec<&str>> = IndexMap::new();
    for name in samples {
        let (group, own) = name.rsplit_once('/')?;
        groups.entry(group).or_default().push(own);
    }
    let own = groups.first()?.1.clone();
    let alike = |of: &Vec<&str>| of.len() == own.len() && of.iter().all(|name| own.contains(name));
    let are_channels = groups.keys().any(|group| is_channel(last(group)));
    if groups.len() < 2 || are_channels || !groups.values().all(alike) {
        return None;
    }
    groups.sort_by_cached_key(|group, _| {
        let (stem, number) = numbered_name(group);
        (stem.to_lowercase(), number)
    });
    let path = |group: &&str| own.iter().map(|own| format!("{group}/{own}")).collect();
    Some(groups.keys().map(path).collect())
}

/// The note on groups that are shots but are not called so.
fn groups_assumed(groups: &[Vec<String>]) -> Option<String> {
    let first = groups.iter().filter_map(|group| group.first());
    let names: Vec<String> =
        first.filter_map(|name| Some(name.rsplit_once('/')?.0.to_owned())).collect();
    let is_called = |name: &String| is_shot(last(name)) || numbered_name(last(name)).0.is_empty();
    let example = groups.first()?.first()?;
    (!names.iter().all(is_called)).then(|| {
        format!(
            "each of its {} groups, which have the same datasets, was taken for a shot ({}); channels \
             are chosen by their whole names, such as --channel {example}",
            names.len(),
            list(&names)
        )
    })
}

fn with_note(records: Raw, note: Option<String>) -> Raw {
    Box::new(records.map(move |record| {
        let mut record = record?;
        record.notes.extend(note.clone());
        Ok(record)
    }))
}

/// Arrays of each shot, where samples are those of several: in groups, which is said, or one by one.
fn shots(samples: &[String], options: &ReadOptions) -> Option<(Vec<Vec<String>>, bool)> {
    // Channels by their whole paths are of no group.
    let by_path = options.channels.iter().any(|channel| samples.contains(channel));
    if let Some(groups) = shot_groups(samples).filter(|_| !by_path) {
        return Some((groups, true));
    }
    let called = samples.len() > 1 && samples.iter().all(|name| is_shot(last(name)));
    let may_be = called && options.rows != Rows::Channels && options.channels.is_empty();
    may_be.then(|| (samples.iter().map(|name| vec![name.clone()]).collect(), false))
}

/// The records of one shot's arrays after the other's, numbered.
fn shot_by_shot(
    arrays: Rc<dyn Arrays>,
    shots: Vec<Vec<String>>,
    (groups, stated): (Rc<Groups>, Stated),
    options: ReadOptions,
    are_groups: bool,
) -> Raw {
    let open = move |shot: Vec<String>| {
        let own = stated.of_shot(&*arrays, groups.own(&shot, are_groups), &options)?;
        let note = own.note.clone().filter(|_| own.interval_s != stated.interval_s);
        let (records, _) = of_samples(&arrays, shot, (groups.clone(), own), &options)?;
        Ok(with_note(records, note))
    };
    let records = shots.into_iter().flat_map(move |shot| or_error(open(shot)));
    Box::new((1..).zip(records).map(|(number, record)| {
        let mut record = record?;
        record.shot = Some(number);
        Ok(record)
    }))
}

/// Arrays of which each holds one channel of every shot.
fn side_by_side(
    arrays: &Rc<dyn Arrays>,
    names: &[&String],
    interval_s: f64,
    options: &ReadOptions,
) -> Result<Raw> {
    let open = |name: &&String| {
        let records = arrays.records(name, interval_s, options)?;
        Ok((name.to_string(), records))
    };
    let opened: Result<Vec<(String, Raw)>> = names.iter().map(open).collect();
    let (mut opened, file) = (opened?, arrays.file().to_owned());
    Ok(Box::new(std::iter::from_fn(move || {
        let next = opened.iter_mut();
        let next: Vec<_> = next.map(|(name, of)| (name.clone(), of.next())).collect();
        let any = next.iter().any(|(_, record)| record.is_some());
        any.then(|| joined(&file, next))
    })))
}

fn joined(file: &Path, channels: Vec<(String, Option<Result<Record>>)>) -> Result<Record> {
    let unlike = |detail: &str| MeasureError::malformed(file, "arrays", detail);
    let mut joined: Option<Record> = None;
    for (name, record) in channels {
        let missing = || unlike("not every channel has as many shots");
        let mut record = record.ok_or_else(missing)??;
        let (Some(mut channel), true) = (record.channels.pop(), record.channels.is_empty()) else {
            let detail = format!("{name:?} has columns of its own: choose it alone");
            return Err(unlike(&detail));
        };
        channel.name = last(&name).to_owned();
        joined.get_or_insert(record).channels.push(channel);
    }
    joined.ok_or_else(|| unlike("without channels"))
}

/// Assigns recordings the speeds of the file in order; pieces of one have the same, and a single
/// speed is that of all. Speeds of shots that are still to be cut out go with every record.
fn with_speeds(records: Raw, speeds: Vec<f64>, recordings: usize, note: Option<String>) -> Raw {
    let matched = speeds.len() == recordings;
    let mut begun = 0_usize;
    Box::new(records.map(move |record| {
        let goes_on = record.as_ref().is_ok_and(|record| record.first_sample > 0);
        begun += usize::from(!goes_on);
        let speed = match speeds.as_slice() {
            [one] => Some(one),
            all if matched => all.get(begun.saturating_sub(1)),
            _ => None,
        };
        let mut record = record?;
        record.speed_m_s = speed.copied().filter(|speed| speed.is_finite());
        if !matched && speeds.len() > 1 {
            record.speeds_m_s.clone_from(&speeds);
        }
        record.notes.extend(note.clone());
        Ok(record)
    }))
}

#[cfg(test)]
#[path = "tests/arrays.rs"]
mod tests;
