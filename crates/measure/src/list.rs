//! Speeds and cases of recordings that do not state them: `shots.csv`.

use crate::Shot;
use crate::error::{MeasureError, Result};
use crate::signal::{Picks, PulseKind};
use csv::{ReaderBuilder, StringRecord, Trim};
use std::collections::{HashMap, HashSet};
use std::ffi::OsString;
use std::io::Read;
use std::path::{Path, PathBuf};

/// A table of shots: which file, at which speed.
#[derive(Clone, Debug, PartialEq)]
pub struct ShotList {
    entries: Vec<ListEntry>,
    /// Titles of columns that are not read.
    unread: Vec<String>,
    by_name: HashMap<OsString, Vec<usize>>,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ListEntry {
    line: u64,
    file: String,
    shot: Option<u64>,
    pub case: Option<String>,
    pub speed_m_s: Option<f64>,
    pub speed_error_m_s: Option<f64>,
    /// Whether the user says that it counts, or does not.
    pub counts: Option<bool>,
    /// Times in s after the first sample that the user picked, of the three pulses, and their error.
    pub picks_s: [Option<f64>; 3],
    pub pick_error_s: Option<f64>,
}

/// Titles of the columns, in the order of [`ListColumns`].
const TITLES: [&[&str]; 10] = [
    &["file", "record", "recording"],
    &["shot", "segment"],
    &["case", "oil", "section"],
    &["speed", "speed m s", "v0", "velocity"],
    &["speed error", "speed error m s", "error"],
    &["counts", "count", "use"],
    &["incident pick", "incident pick s"],
    &["wall pick", "wall pick s"],
    &["reflected pick", "reflected pick s"],
    &["pick error", "pick error s"],
];

/// Usual titles of columns beside `file`.
const COLUMNS: &str =
    "shot, case, speed, speed error, counts, incident pick, wall pick, reflected pick, pick error";

struct ListColumns {
    places: [Option<usize>; 10],
    decimal_comma: bool,
}

impl ShotList {
    /// Reads the table's text: commas, or semicolons or tabs with decimal commas. Fields may stand in
    /// quotes.
    ///
    /// # Errors
    /// [`MeasureError::List`] with the line.
    pub fn parse(text: &str) -> Result<Self> {
        let (mut reader, decimal_comma) = reader(text);
        let malformed = |error: csv::Error| MeasureError::List(error.to_string());
        let titles = reader.headers().map_err(malformed)?.clone();
        let columns = ListColumns::new(&titles, decimal_comma)?;
        let (mut entries, mut row) = (Vec::new(), StringRecord::new());
        let mut by_name: HashMap<OsString, Vec<usize>> = HashMap::new();
        while reader.read_record(&mut row).map_err(malformed)? {
            // A record's own position is that before the empty lines above it.
            let line = reader.position().line() - 1;
            // A spreadsheet leaves lines of nothing but delimiters.
            if !row.iter().all(str::is_empty) {
                let entry = columns.entry(&row, line)?;
                let name = Path::new(&entry.file).file_name().unwrap_or_default();
                by_name.entry(name.to_owned()).or_default().push(entries.len());
                entries.push(entry);
            }
        }
        let is_read = |column: &usize| columns.places.contains(&Some(*column));
        let unread = titles.iter().enumerate().filter(|(column, _)| !is_read(column));
        let unread = unread.map(|(_, title)| title.to_owned()).filter(|title| !title.is_empty());
        Ok(Self { entries, unread: unread.collect(), by_name })
    }

    /// Whether a text begins as such a table does: its titles are those of files and of something
    /// else, and what is first in the column of files is no number.
    pub(crate) fn is_begun_by(text: &str) -> bool {
        let (mut reader, _) = reader(text);
        let places = reader.headers().map(places).unwrap_or_default();
        let Some(file) = places[0].filter(|_| places.iter().flatten().count() > 1) else {
            return false;
        };
        let is_number =
            |row: &StringRecord| row.get(file).is_some_and(|it| it.parse::<f64>().is_ok());
        !reader.records().next().is_some_and(|row| row.is_ok_and(|row| is_number(&row)))
    }

    /// The speed of a file's shot and its standard error in m/s, if the table has them.
    pub fn speed(&self, file: &Path, shot: Option<u64>) -> Option<(f64, Option<f64>)> {
        let entry = self.find(file, shot)?;
        Some((entry.speed_m_s?, entry.speed_error_m_s))
    }

    /// The case of a file's shot, if the table has it.
    pub fn case(&self, file: &Path, shot: Option<u64>) -> Option<&str> {
        self.find(file, shot)?.case.as_deref()
    }

    /// The highest number of a file's shot that has a line.
    pub(crate) fn most_shots(&self, file: &Path) -> u64 {
        let lines = file.file_name().and_then(|name| self.by_name.get(name));
        let entries = lines.into_iter().flatten().filter_map(|line| self.entries.get(*line));
        let of_file = entries.filter(|entry| file.ends_with(&entry.file));
        of_file.filter_map(|entry| entry.shot).max().unwrap_or(0)
    }

    /// Whether another list says the same of a shot, and numbers as many of its file.
    pub fn agrees_on(&self, other: &Self, shot: &Shot) -> bool {
        self.find(&shot.file, shot.shot) == other.find(&shot.file, shot.shot)
            && self.most_shots(&shot.file) == other.most_shots(&shot.file)
    }

    pub(crate) fn find(&self, file: &Path, shot: Option<u64>) -> Option<&ListEntry> {
        let lines = self.by_name.get(file.file_name()?)?;
        let mut entries = lines.iter().filter_map(|line| self.entries.get(*line));
        entries.find(|entry| entry.means(file, shot))
    }

    /// What lines and shots do not find in each other, but for files that were refused.
    pub(crate) fn unmatched(&self, files: &[PathBuf], shots: &[Shot]) -> Vec<String> {
        let (mut used, mut unmatched) = (HashSet::new(), self.unread());
        for shot in shots {
            if let Err(error @ MeasureError::List(_)) = &shot.flight {
                unmatched.push(error.to_string());
            }
            match self.find(&shot.file, shot.shot) {
                Some(entry) => drop(used.insert(entry.line)),
                None if shot.speed_m_s.is_some() => {}
                None => unmatched.push(format!("no line is about {}", shot.source)),
            }
        }
        let unused = self.entries.iter().filter(|entry| !used.contains(&entry.line));
        unmatched.extend(unused.filter_map(|entry| entry.unused(files, shots)));
        unmatched
    }

    /// A line on the columns that are not read, if there are any.
    fn unread(&self) -> Vec<String> {
        let more = if self.unread.len() > SHOWN { ", …" } else { "" };
        let shown = self.unread.get(..SHOWN).unwrap_or(&self.unread).join(", ");
        let line = format!("columns that are not read: {shown}{more}; these are: {COLUMNS}");
        Vec::from_iter((!self.unread.is_empty()).then_some(line))
    }
}

/// A reader of a table, and whether commas are decimal in it.
fn reader(text: &str) -> (csv::Reader<impl Read>, bool) {
    let text = text.trim_start_matches('\u{feff}');
    let mut titles = text.lines().map(str::trim);
    let titles = titles.find(|line| !line.is_empty() && !line.starts_with('#'));
    let mut marks = [b';', b'\t'].into_iter();
    let delimiter = marks.find(|mark| titles.is_some_and(|t| t.contains(char::from(*mark))));
    let reader = ReaderBuilder::new()
        .delimiter(delimiter.unwrap_or(b','))
        .comment(Some(b'#'))
        .trim(Trim::All)
        .flexible(true)
        .from_reader(text.as_bytes().chain(b"\n".as_slice()));
    (reader, delimiter.is_some())
}

/// Which columns have which of [`TITLES`].
fn places(titles: &StringRecord) -> [Option<usize>; 10] {
    TITLES.map(|names| called(titles, names).next())
}

/// The columns with one of these titles.
fn called(titles: &StringRecord, names: &[&str]) -> impl Iterator<Item = usize> {
    let plain = |title: &str| {
        let name = title.split(['(', '[']).next().unwrap_or_default();
        name.trim().to_lowercase().replace('_', " ")
    };
    let is = move |title: &str| names.contains(&&*plain(title));
    titles.iter().enumerate().filter(move |(_, title)| is(title)).map(|(column, _)| column)
}

const SHOWN: usize = 6;

impl ListEntry {
    /// By the file's name with as much of its path as the table gives, and the shot's number if the
    /// table numbers shots.
    fn means(&self, file: &Path, shot: Option<u64>) -> bool {
        file.ends_with(&self.file) && (self.shot.is_none() || self.shot == shot)
    }

    /// Error of a time that was picked where a record of this duration has no samples.
    pub(crate) fn pick_outside(&self, source: &str, duration_s: f64) -> Option<MeasureError> {
        let mut picks = PulseKind::ALL.into_iter().zip(self.picks_s);
        let (kind, time_s) = picks.find_map(|(kind, time_s)| {
            Some((kind, time_s.filter(|time_s| *time_s > duration_s)?))
        })?;
        Some(MeasureError::List(format!(
            "the {kind} pick of {time_s} s (line {} of the table of shots) lies outside {source}, which \
             lasts from 0 to {duration_s:.9} s",
            self.line
        )))
    }

    /// Error of pulses, some picked by hand, that do not follow each other as a wave passes.
    pub(crate) fn out_of_order(&self, source: &str, picks: &Picks) -> Option<MeasureError> {
        let time = |kind| picks.pulse(kind).map(|pulse| (kind, pulse.time_s));
        let times: Vec<_> = PulseKind::ALL.into_iter().filter_map(time).collect();
        let pair = times.windows(2).find(|pair| pair[1].1 <= pair[0].1)?;
        let [(before, before_s), (after, after_s)] = [pair[0], pair[1]];
        Some(MeasureError::List(format!(
            "the {after} pulse at {after_s} s is not after the {before} pulse at {before_s} s in {source} \
             (picks of line {} of the table of shots): pulses pass as incident, wall, reflected",
            self.line
        )))
    }

    /// Why no shot found this line; `None` if its file gave none at all.
    fn unused(&self, files: &[PathBuf], shots: &[Shot]) -> Option<String> {
        let Self { line, file, .. } = self;
        if !files.iter().any(|given| given.ends_with(file)) {
            let names = files.iter().filter_map(|file| file.file_name()).take(SHOWN);
            let shown: Vec<_> = names.map(|name| name.to_string_lossy()).collect();
            let more = if files.len() > SHOWN { ", …" } else { "" };
            let shown = shown.join(", ");
            return Some(format!("line {line}: {file} is none of the files given ({shown}{more})"));
        }
        let mut of_file = shots.iter().filter(|shot| shot.file.ends_with(file)).peekable();
        of_file.peek()?;
        let number = self.shot.unwrap_or_default();
        Some(match of_file.any(|shot| self.means(&shot.file, shot.shot)) {
            true => format!("line {line}: an earlier line is about the same"),
            false => format!("line {line}: {file} has no shot {number}"),
        })
    }
}

/// Whether a title is that of speeds or picks and names a unit that is not m/s or s.
fn in_other_unit(title: &str) -> bool {
    let title = title.to_lowercase();
    let quantities = ["speed", "velocity", "v0", "error", "pick"];
    let Some((name, unit)) = title.split_once(['(', '[']) else {
        return false;
    };
    let unit = unit.trim_end_matches([')', ']']).replace(' ', "");
    let usual = match name.contains("pick") {
        true => &["s"][..],
        false => &["m/s", "ms^-1", "ms-1", "m·s^-1", "m·s⁻¹", "ms⁻¹"],
    };
    quantities.iter().any(|word| name.contains(word)) && !usual.contains(&unit.as_str())
}

impl ListColumns {
    fn new(titles: &StringRecord, decimal_comma: bool) -> Result<Self> {
        if let Some(title) = titles.iter().find(|title| in_other_unit(title)) {
            return Err(MeasureError::List(format!(
                "the column {title:?} has another unit: speeds and their errors are in m/s, picks in s"
            )));
        }
        for names in TITLES {
            let columns: Vec<usize> = called(titles, names).collect();
            if let [one, other, ..] = columns[..] {
                return Err(MeasureError::List(format!(
                    "the columns {:?} and {:?} are both taken for {:?}; leave one out",
                    &titles[one], &titles[other], names[0]
                )));
            }
        }
        let places = places(titles);
        let detail = format!("the first line must name the columns: file, and any of {COLUMNS}");
        places[0].ok_or(MeasureError::List(detail))?;
        Ok(Self { places, decimal_comma })
    }

    fn entry(&self, row: &StringRecord, line: u64) -> Result<ListEntry> {
        let [file, shot, case, speed, error, counts, picks @ .., pick_error] =
            self.places.map(|column| row.get(column?).filter(|text| !text.is_empty()));
        let wrong =
            |text: &str, what| MeasureError::List(format!("line {line}: {text:?} is no {what}"));
        let value = |text: Option<&str>, what, least: f64| {
            let number = |text: &str| self.number(text).filter(|number| *number >= least);
            let number = |text| number(text).ok_or_else(|| wrong(text, what));
            text.map(number).transpose()
        };
        let number = |text: &str| text.parse().map_err(|_| wrong(text, "number of a shot"));
        let no_file = || MeasureError::List(format!("line {line} names no file"));
        let answer = |text: &str| match &*text.to_lowercase() {
            "yes" | "y" | "true" | "1" => Ok(true),
            "no" | "n" | "false" | "0" => Ok(false),
            _ => Err(wrong(text, "yes or no")),
        };
        let pick = |text| value(text, "time in s after the first sample", 0.0);
        let [incident, wall, reflected] = picks;
        let picks_s = [pick(incident)?, pick(wall)?, pick(reflected)?];
        let pick_error_s = value(pick_error, "error of a pick in s above 0", f64::MIN_POSITIVE)?;
        if pick_error_s.is_some() && picks_s == [None; 3] {
            return Err(MeasureError::List(format!(
                "line {line} has an error of a pick and no pick"
            )));
        }
        Ok(ListEntry {
            line,
            picks_s,
            pick_error_s,
            speed_m_s: value(speed, "speed in m/s above 0", f64::MIN_POSITIVE)?,
            file: file.ok_or_else(no_file)?.to_owned(),
            shot: shot.map(number).transpose()?,
            case: case.map(str::to_owned),
            speed_error_m_s: value(error, "error of a speed in m/s", 0.0)?,
            counts: counts.map(answer).transpose()?,
        })
    }

    fn number(&self, text: &str) -> Option<f64> {
        let text = match self.decimal_comma {
            true => text.replace(',', "."),
            false => text.to_owned(),
        };
        let number = text.trim_end_matches("m/s").trim().parse().ok();
        number.filter(|number: &f64| number.is_finite())
    }
}

#[cfg(test)]
#[path = "tests/list.rs"]
mod tests;
