//! Speeds and cases that recordings themselves do not tell: `shots.csv`.

use crate::{MeasureError, Shot};
use csv::{ReaderBuilder, StringRecord, Trim};
use std::collections::{HashMap, HashSet};
use std::ffi::OsString;
use std::io::Read;
use std::path::{Path, PathBuf};

/// A table of shots: which file, at which speed.
#[derive(Clone, Debug, PartialEq)]
pub struct ShotList {
    entries: Vec<Entry>,
    /// Which entries are about files of a name.
    by_name: HashMap<OsString, Vec<usize>>,
}

/// One line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    line: u64,
    file: String,
    shot: Option<u64>,
    pub case: Option<String>,
    pub speed_m_s: Option<f64>,
    pub speed_error_m_s: Option<f64>,
}

fn no_titles() -> MeasureError {
    let detail =
        "the first line must name the columns: file, and any of shot, case, speed, speed error";
    MeasureError::List(detail.to_owned())
}

/// Columns by their titles.
struct Columns {
    decimal_comma: bool,
    file: usize,
    shot: Option<usize>,
    case: Option<usize>,
    speed: Option<usize>,
    error: Option<usize>,
}

impl ShotList {
    /// Reads the table's text: commas, or semicolons or tabs with decimal commas.
    /// Fields may stand in quotes.
    ///
    /// # Errors
    /// [`MeasureError::List`] with the line.
    pub fn parse(text: &str) -> Result<Self, MeasureError> {
        let text = text.trim_start_matches('\u{feff}');
        let titles = text.lines().map(str::trim);
        let titles = titles
            .clone()
            .find(|line| !line.is_empty() && !line.starts_with('#'));
        let titles = titles.ok_or_else(no_titles)?;
        let marks = [b';', b'\t'].into_iter();
        let delimiter = marks
            .clone()
            .find(|mark| titles.contains(char::from(*mark)));
        let mut reader = ReaderBuilder::new()
            .delimiter(delimiter.unwrap_or(b','))
            .comment(Some(b'#'))
            .trim(Trim::All)
            .flexible(true)
            .from_reader(text.as_bytes().chain(b"\n".as_slice()));
        let malformed = |error: csv::Error| MeasureError::List(error.to_string());
        let titles = reader.headers().map_err(malformed)?.clone();
        let columns = Columns::of(&titles, delimiter.is_some())?;
        let mut entries = Vec::new();
        let mut row = StringRecord::new();
        while reader.read_record(&mut row).map_err(malformed)? {
            // Where a record begins is told before empty lines are passed over.
            let line = reader.position().line() - 1;
            // A spreadsheet leaves lines of nothing but delimiters.
            if !row.iter().all(str::is_empty) {
                entries.push(columns.entry(&row, line)?);
            }
        }
        let mut by_name: HashMap<OsString, Vec<usize>> = HashMap::new();
        for (index, entry) in entries.iter().enumerate() {
            let name = Path::new(&entry.file).file_name().unwrap_or_default();
            by_name.entry(name.to_owned()).or_default().push(index);
        }
        Ok(Self { entries, by_name })
    }

    /// The speed of a file's shot and its standard error in m/s, as far as the
    /// table tells.
    #[must_use]
    pub fn speed(&self, file: &Path, shot: Option<u64>) -> Option<(f64, Option<f64>)> {
        let entry = self.find(file, shot)?;
        Some((entry.speed_m_s?, entry.speed_error_m_s))
    }

    /// The case of a file's shot, if the table has it.
    #[must_use]
    pub fn case(&self, file: &Path, shot: Option<u64>) -> Option<&str> {
        self.find(file, shot)?.case.as_deref()
    }

    /// What is said of a shot, by the first line that does.
    pub(crate) fn find(&self, file: &Path, shot: Option<u64>) -> Option<&Entry> {
        let lines = self.by_name.get(file.file_name()?)?;
        let mut entries = lines.iter().filter_map(|line| self.entries.get(*line));
        entries.find(|entry| entry.means(file, shot))
    }

    /// What lines and shots do not find in each other, as it is told to people.
    ///
    /// Files that were refused are told of elsewhere, and so not here.
    pub(crate) fn unmatched(&self, files: &[PathBuf], shots: &[Shot]) -> Vec<String> {
        let mut used = HashSet::new();
        let mut told: Vec<String> = Vec::new();
        for shot in shots {
            match self.find(&shot.file, shot.shot) {
                Some(entry) => {
                    used.insert(entry.line);
                }
                None if shot.speed_m_s.is_some() => {}
                None => told.push(format!("no line is about {}", shot.source)),
            }
        }
        let unused = self
            .entries
            .iter()
            .filter(|entry| !used.contains(&entry.line));
        told.extend(unused.filter_map(|entry| entry.unused(files, shots)));
        told
    }
}

/// Names that anybody reads at once.
const SHOWN: usize = 6;

impl Entry {
    /// By the file's name with as much of its path as the table gives, and the
    /// shot's number if the table numbers shots.
    fn means(&self, file: &Path, shot: Option<u64>) -> bool {
        file.ends_with(&self.file) && (self.shot.is_none() || self.shot == shot)
    }

    /// Why no shot found this line; `None` if its file gave none at all.
    fn unused(&self, files: &[PathBuf], shots: &[Shot]) -> Option<String> {
        let Self { line, file, .. } = self;
        if !files.iter().any(|given| given.ends_with(file)) {
            let names = files.iter().filter_map(|file| file.file_name());
            let shown: Vec<_> = names
                .take(SHOWN)
                .map(|name| name.to_string_lossy())
                .collect();
            let more = if files.len() > SHOWN { ", …" } else { "" };
            let shown = shown.join(", ");
            return Some(format!(
                "line {line}: {file} is none of the files given ({shown}{more})"
            ));
        }
        let mut of_file = shots.iter().filter(|shot| shot.file.ends_with(file));
        let some = of_file.clone().next().is_some();
        let again = of_file.any(|shot| self.means(&shot.file, shot.shot));
        let number = self.shot.unwrap_or_default();
        match (some, again) {
            (false, _) => None,
            (true, true) => Some(format!("line {line}: an earlier line is about the same")),
            (true, false) => Some(format!("line {line}: {file} has no shot {number}")),
        }
    }
}

/// Whether a title is that of speeds and names a unit that is not m/s.
fn in_other_unit(title: &str) -> bool {
    let title = title.to_lowercase();
    let of_speed = ["speed", "velocity", "v0", "error"];
    let Some((name, unit)) = title.split_once(['(', '[']) else {
        return false;
    };
    let unit = unit.trim_end_matches([')', ']']).replace(' ', "");
    let usual = ["m/s", "ms^-1", "ms-1", "m·s^-1", "m·s⁻¹", "ms⁻¹"];
    of_speed.iter().any(|word| name.contains(word)) && !usual.contains(&unit.as_str())
}

impl Columns {
    fn of(titles: &StringRecord, decimal_comma: bool) -> Result<Self, MeasureError> {
        if let Some(title) = titles.iter().find(|title| in_other_unit(title)) {
            return Err(MeasureError::List(format!(
                "the column {title:?} has another unit: speeds and their errors are in m/s"
            )));
        }
        let plain = |title: &str| {
            let name = title.split(['(', '[']).next().unwrap_or_default();
            name.trim().to_lowercase().replace('_', " ")
        };
        let titles: Vec<String> = titles.iter().map(plain).collect();
        let find = |names: &[&str]| {
            titles
                .iter()
                .position(|title| names.contains(&title.as_str()))
        };
        Ok(Self {
            decimal_comma,
            file: find(&["file", "record", "recording"]).ok_or_else(no_titles)?,
            shot: find(&["shot", "segment"]),
            case: find(&["case", "oil", "section"]),
            speed: find(&["speed", "speed m s", "v0", "velocity"]),
            error: find(&["speed error", "speed error m s", "error"]),
        })
    }

    fn entry(&self, row: &StringRecord, line: u64) -> Result<Entry, MeasureError> {
        let field = |column: Option<usize>| {
            let text = row.get(column?);
            text.filter(|text| !text.is_empty())
        };
        let wrong =
            |text: &str, what| MeasureError::List(format!("line {line}: {text:?} is no {what}"));
        let value = |column, what| {
            let number = |text: &str| self.number(text).ok_or_else(|| wrong(text, what));
            field(column).map(number).transpose()
        };
        let shot = |text: &str| text.parse().map_err(|_| wrong(text, "number of a shot"));
        let what = "speed in m/s above 0";
        let speed = value(self.speed, what)?;
        if let Some(text) = field(self.speed).filter(|_| speed == Some(0.0)) {
            return Err(wrong(text, what));
        }
        Ok(Entry {
            line,
            file: field(Some(self.file))
                .ok_or_else(|| MeasureError::List(format!("line {line} names no file")))?
                .to_owned(),
            shot: field(self.shot).map(shot).transpose()?,
            case: field(self.case).map(str::to_owned),
            speed_m_s: speed,
            speed_error_m_s: value(self.error, "error of a speed in m/s")?,
        })
    }

    fn number(&self, text: &str) -> Option<f64> {
        let text = match self.decimal_comma {
            true => text.replace(',', "."),
            false => text.to_owned(),
        };
        let number = text.trim_end_matches("m/s").trim().parse().ok();
        number.filter(|number: &f64| number.is_finite() && *number >= 0.0)
    }
}

#[cfg(test)]
#[path = "tests/list.rs"]
mod tests;
