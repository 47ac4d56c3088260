//! Speeds and cases that recordings themselves do not tell: `shots.csv`.

use std::path::Path;

/// A table of shots: which file, at which speed.
#[derive(Clone, Debug, PartialEq)]
pub struct ShotList {
    entries: Vec<Entry>,
}

/// One line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    file: String,
    shot: Option<u64>,
    pub case: Option<String>,
    pub speed_m_s: Option<f64>,
    pub speed_error_m_s: Option<f64>,
}

/// What is wrong with a table of shots.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ListError {
    /// No line of titles with a column of files.
    #[error(
        "the first line must name the columns: file, and any of shot, case, speed, speed error"
    )]
    NoTitles,
    /// Speeds in another unit.
    #[error("the column {title:?} has another unit: speeds and their errors are in m/s")]
    Unit {
        /// The column's title.
        title: String,
    },
    /// A number that is none.
    #[error("line {line}: {text:?} is no {what}")]
    NoNumber {
        /// Which line, from 1.
        line: usize,
        /// What stands there.
        text: String,
        /// What should stand there.
        what: &'static str,
    },
    /// A line without a file.
    #[error("line {line} names no file")]
    NoFile {
        /// Which line, from 1.
        line: usize,
    },
}

/// Columns by their titles.
struct Columns {
    file: usize,
    shot: Option<usize>,
    case: Option<usize>,
    speed: Option<usize>,
    error: Option<usize>,
}

impl ShotList {
    /// Reads the table's text: commas, or semicolons with decimal commas.
    ///
    /// # Errors
    /// See [`ListError`].
    pub fn parse(text: &str) -> Result<Self, ListError> {
        let text = text.trim_start_matches('\u{feff}');
        let mut lines = text.lines().enumerate().filter(|(_, line)| {
            let line = line.trim();
            !line.is_empty() && !line.starts_with('#')
        });
        let (_, titles) = lines.next().ok_or(ListError::NoTitles)?;
        let delimiter = [';', '\t', ',']
            .into_iter()
            .find(|mark| titles.contains(*mark));
        let delimiter = delimiter.unwrap_or(',');
        if let Some(title) = titles.split(delimiter).find(|title| in_other_unit(title)) {
            let title = title.trim().to_owned();
            return Err(ListError::Unit { title });
        }
        let columns = Columns::of(titles, delimiter).ok_or(ListError::NoTitles)?;
        let entries = lines.map(|(index, line)| columns.entry(line, delimiter, index + 1));
        Ok(Self {
            entries: entries.collect::<Result<_, _>>()?,
        })
    }

    /// What is said of a shot: by its file's name with as much of the path as
    /// the table gives, and its number if the table numbers shots.
    pub(crate) fn find(&self, file: &Path, shot: Option<u64>) -> Option<&Entry> {
        self.entries.iter().find(|entry| {
            file.ends_with(&entry.file) && (entry.shot.is_none() || entry.shot == shot)
        })
    }
}

/// Whether a title is that of speeds and names a unit that is not m/s.
fn in_other_unit(title: &str) -> bool {
    let title = title.trim().trim_matches('"').to_lowercase();
    let of_speed = ["speed", "velocity", "v0", "error"];
    let Some((name, unit)) = title.split_once(['(', '[']) else {
        return false;
    };
    let unit = unit.trim_end_matches([')', ']']).replace(' ', "");
    let usual = ["m/s", "ms^-1", "ms-1", "m·s^-1", "m·s⁻¹", "ms⁻¹"];
    of_speed.iter().any(|word| name.contains(word)) && !usual.contains(&unit.as_str())
}

impl Columns {
    fn of(titles: &str, delimiter: char) -> Option<Self> {
        let titles: Vec<String> = titles
            .split(delimiter)
            .map(|title| {
                let title = title.split(['(', '[']).next().unwrap_or_default();
                title
                    .trim()
                    .trim_matches('"')
                    .to_lowercase()
                    .replace('_', " ")
            })
            .collect();
        let find = |names: &[&str]| {
            titles
                .iter()
                .position(|title| names.contains(&title.as_str()))
        };
        Some(Self {
            file: find(&["file", "record", "recording"])?,
            shot: find(&["shot", "segment"]),
            case: find(&["case", "oil", "section"]),
            speed: find(&["speed", "speed m s", "v0", "velocity"]),
            error: find(&["speed error", "speed error m s", "error"]),
        })
    }

    fn entry(&self, line: &str, delimiter: char, number: usize) -> Result<Entry, ListError> {
        let fields: Vec<&str> = line
            .split(delimiter)
            .map(|field| field.trim().trim_matches('"'))
            .collect();
        let field = |column: Option<usize>| {
            let text = fields.get(column?).copied();
            text.filter(|text| !text.is_empty())
        };
        let wrong = |text: &str, what| ListError::NoNumber {
            line: number,
            text: text.to_owned(),
            what,
        };
        let value = |column, what| -> Result<Option<f64>, ListError> {
            let Some(text) = field(column) else {
                return Ok(None);
            };
            let plain = if delimiter == ',' {
                text.to_owned()
            } else {
                text.replace(',', ".")
            };
            let plain = plain.trim_end_matches("m/s").trim();
            let value = plain
                .parse()
                .ok()
                .filter(|v: &f64| v.is_finite() && *v >= 0.0);
            value.map(Some).ok_or_else(|| wrong(text, what))
        };
        let shot = match field(self.shot) {
            None => None,
            Some(text) => Some(text.parse().map_err(|_| wrong(text, "number of a shot"))?),
        };
        Ok(Entry {
            file: field(Some(self.file))
                .ok_or(ListError::NoFile { line: number })?
                .to_owned(),
            shot,
            case: field(self.case).map(str::to_owned),
            speed_m_s: value(self.speed, "speed in m/s")?,
            speed_error_m_s: value(self.error, "error of a speed in m/s")?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_in_another_unit_are_refused_not_taken_for_metres_a_second() {
        for title in ["velocity [mm/s]", "speed (cm/s)", "speed error (%)"] {
            let list = ShotList::parse(&format!("file,{title}\na.csv,500\n"));
            assert!(matches!(list, Err(ListError::Unit { .. })), "{title}");
        }
        for title in ["speed (m/s)", "v0 [m s^-1]", "speed"] {
            let list = ShotList::parse(&format!("file,{title}\na.csv,0.5\n"));
            assert!(list.is_ok(), "{title}");
        }
    }

    #[test]
    fn a_list_gives_files_their_speeds() {
        let list =
            ShotList::parse("file,case,speed,speed error\na.csv,dry,0.5,0.003\nb.csv,,0.7\n");
        let list = list.unwrap();
        let a = list.find(Path::new("data/a.csv"), Some(1)).unwrap();
        assert_eq!((a.case.as_deref(), a.speed_m_s), (Some("dry"), Some(0.5)));
        assert_eq!(a.speed_error_m_s, Some(0.003));
        let b = list.find(Path::new("b.csv"), None).unwrap();
        assert_eq!((b.case.as_deref(), b.speed_m_s), (None, Some(0.7)));
        assert_eq!(list.find(Path::new("c.csv"), None), None);
    }

    #[test]
    fn shots_of_one_file_have_speeds_of_their_own() {
        let list = ShotList::parse("File;Shot;Speed (m/s)\na.h5;1;0,5\na.h5;2;0,7\n").unwrap();
        let speed = |shot| list.find(Path::new("a.h5"), Some(shot)).unwrap().speed_m_s;
        assert_eq!((speed(1), speed(2)), (Some(0.5), Some(0.7)));
    }

    #[test]
    fn mistakes_are_told_with_their_line() {
        assert_eq!(ShotList::parse("a,b\n"), Err(ListError::NoTitles));
        let error = ShotList::parse("file,speed\n\na.csv,fast\n").unwrap_err();
        assert!(error.to_string().contains("line 3"), "{error}");
    }
}
