//! Tables of measured curves.

use super::{Data, DataRow, Freedom, Observable};
use crate::InferError;
use csv::{ReaderBuilder, Trim};
use hertzchain_measure::signal::Estimate;
use std::collections::HashSet;

/// Number of shots from whose scatter standard errors come. Fits widen
/// such errors by what their own uncertainty costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scatter {
    /// As the table says of each row's own errors, in columns as `measure` writes them: `shots`, and
    /// `tof_incident_s_count` of one quantity, less what they share (`tof_incident_shared_s`);
    /// `speed_error_shots` of the speed, 0 where it is known. Without them errors are known.
    #[default]
    AsTold,
    /// All errors are known, whatever the table says of shots.
    Known,
    /// All errors come from so many shots.
    Of(u32),
}

/// What to take from a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Selection {
    /// Which case of a table with a column `case`; needed if it has more than one.
    pub case: Option<String>,
    /// Which measured numbers.
    pub observables: Vec<Observable>,
    /// Standard error of speeds in m/s where the table has none; 0 when `None`.
    pub speed_error_m_s: Option<f64>,
    /// The same of times of flight in s.
    pub time_error_s: Option<f64>,
    /// The same of ratios of peaks.
    pub ratio_error: Option<f64>,
    /// How well errors are known, the table's too.
    pub scatter: Scatter,
}

impl Default for Selection {
    fn default() -> Self {
        Self {
            case: None,
            observables: vec![Observable::Incident, Observable::Reflected],
            speed_error_m_s: None,
            time_error_s: None,
            ratio_error: None,
            scatter: Scatter::default(),
        }
    }
}

/// A row of a table: its case and its numbers; texts that are no numbers are errors.
struct Record {
    line: u64,
    case: String,
    cells: Vec<Result<Option<f64>, String>>,
}

impl Data {
    /// Reads a table from text: commas, or semicolons with decimal commas. Cells of observables may
    /// be empty: that one was not seen.
    ///
    /// # Errors
    /// The first row and column that can't be used.
    pub fn parse(file: &str, text: &str, selection: &Selection) -> Result<Self, InferError> {
        let (titles, records) =
            records(text).map_err(|what| InferError::Input(format!("{file}: {what}")))?;
        let columns = Columns::of(&titles, &selection.observables, file)?;
        let has_cases = titles.iter().any(|title| title == "case");
        let (case, records) = of_case(file, records, has_cases, selection.case.as_deref())?;
        let reader = Reader { file, titles: &titles, selection, columns };
        let rows = records.iter().filter_map(|record| reader.row(record).transpose());
        let mut rows: Vec<DataRow> = rows.collect::<Result<_, _>>()?;
        rows.sort_by(|a, b| a.speed_m_s.value.total_cmp(&b.speed_m_s.value));
        match rows.is_empty() {
            true => InferError::input(format!(
                "{file}: no row has any of the numbers that are used (--use)"
            )),
            false => Ok(Self { file: file.to_owned(), case, rows }),
        }
    }
}

/// A text with plain ends: the reader counts a carriage return and line feed as one line too few.
pub(crate) fn with_plain_ends(text: &str) -> String {
    text.replace("\r\n", "\n").replace('\r', "\n")
}

fn records(text: &str) -> Result<(Vec<String>, Vec<Record>), String> {
    let text = with_plain_ends(text);
    let text = text.trim_start_matches('\u{feff}');
    if text.trim().is_empty() {
        return Err("the file is empty".to_owned());
    }
    // The line of titles shows what cells are divided by.
    let is_titles = |line: &&str| !line.trim().is_empty() && !line.starts_with('#');
    let titles = text.lines().find(is_titles).unwrap_or_default();
    let mut marks = [b';', b'\t'].into_iter();
    let delimiter = marks.find(|mark| titles.as_bytes().contains(mark)).unwrap_or(b',');
    let mut reader = ReaderBuilder::new()
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .trim(Trim::All)
        .from_reader(text.as_bytes());
    let titles = reader.headers().map_err(|error| error.to_string())?;
    let titles: Vec<String> = titles.iter().map(str::to_owned).collect();
    let case = titles.iter().position(|title| title == "case");
    let number = |text: &str| match (text, delimiter) {
        ("", _) => Ok(None),
        (text, b',') => text.parse().map(Some).map_err(|_| text.to_owned()),
        _ => text.replace(',', ".").parse().map(Some).map_err(|_| text.to_owned()),
    };
    let mut all = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| error.to_string())?;
        all.push(Record {
            line: record.position().map_or(0, csv::Position::line),
            case: case.and_then(|at| record.get(at)).unwrap_or_default().to_owned(),
            cells: record.iter().map(number).collect(),
        });
    }
    Ok((titles, all))
}

/// The records of the case asked for, or of all where there is only one.
fn of_case(
    file: &str,
    records: Vec<Record>,
    has_cases: bool,
    asked: Option<&str>,
) -> Result<(String, Vec<Record>), InferError> {
    let mut cases: Vec<String> = Vec::new();
    for record in &records {
        if !cases.contains(&record.case) {
            cases.push(record.case.clone());
        }
    }
    let wrong = |what: &str| {
        InferError::input(format!("{file}: {what}; its cases are {}", cases.join(", ")))
    };
    let chosen = match (asked, &cases[..]) {
        (None, [] | [_]) => cases.first().cloned().unwrap_or_default(),
        (None, _) => return wrong("one case must be chosen by --case"),
        // Of the model, then: the table has none.
        (Some(name), _) if !has_cases => return Ok((name.to_owned(), records)),
        (Some(name), cases) if cases.iter().any(|case| case == name) => name.to_owned(),
        (Some(name), _) => return wrong(&format!("it has no case `{name}`")),
    };
    let records = records.into_iter().filter(|record| record.case == chosen).collect();
    Ok((chosen, records))
}

/// Columns of a measured quantity, by their places.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Measured {
    value: usize,
    sigma: Option<usize>,
    /// Number of shots that it is the mean of.
    count: Option<usize>,
    /// The part of its error that all shots share, and that no scatter shows.
    shared: Option<usize>,
}

#[derive(Clone, Debug, PartialEq)]
struct Columns {
    shots: Option<usize>,
    speed: Measured,
    observables: [Option<Measured>; 4],
    correlation: Option<usize>,
}

/// Times that `measure` takes to the mean speed, shot by shot, do not scatter with their speeds any
/// more: they are read in place of plain means.
const AT_MEAN_SPEED: [&str; 2] = ["tof_incident_at_mean_speed_s", "tof_reflected_at_mean_speed_s"];

/// Correlations of the errors of both plain means, and of both times at the mean speed.
const CORRELATIONS: [&str; 2] = ["tof_correlation", "tof_at_mean_speed_correlation"];

impl Columns {
    /// Columns of the wanted observables, of which a table must have one.
    fn of(titles: &[String], wanted: &[Observable], file: &str) -> Result<Self, InferError> {
        let missing = |column: &str, expected: String| {
            InferError::Input(format!("{file}: no column `{column}`; expected {expected}"))
        };
        let speed = measured(titles, "speed_m_s").ok_or_else(|| {
            let near = other_unit(titles, "speed", "_m_s");
            missing("speed_m_s", format!("speeds of the striker in m/s{near}"))
        })?;
        let speed = Measured { count: find(titles, &["speed_error_shots"]), ..speed };
        let observables = Observable::ALL.map(|of| {
            let plain = of.column();
            let shared = format!("{}_shared_s", plain.strip_suffix("_s").unwrap_or(plain));
            let finer = AT_MEAN_SPEED.get(of.index()).and_then(|name| measured(titles, name));
            let found = finer.or_else(|| measured(titles, plain)).map(|found| Measured {
                count: find(titles, &[&format!("{plain}_count")]),
                shared: find(titles, &[&shared]),
                ..found
            });
            found.filter(|_| wanted.contains(&of))
        });
        if observables.iter().all(Option::is_none) {
            let names: Vec<&str> = wanted.iter().map(|of| of.column()).collect();
            return Err(missing(&names.join("` or `"), instead(titles, wanted)));
        }
        unclear(titles, wanted, file)?;
        let incident = observables[0].as_ref().map(|of| titles[of.value].as_str());
        let correlations = match incident == Some(AT_MEAN_SPEED[0]) {
            false => &CORRELATIONS[..1],
            // The plain means' own is that of other errors.
            true if find(titles, &[Observable::Incident.column()]).is_some() => &CORRELATIONS[1..],
            true => &[CORRELATIONS[1], CORRELATIONS[0]],
        };
        Ok(Self {
            correlation: find(titles, correlations),
            shots: find(titles, &["shots"]),
            speed,
            observables,
        })
    }
}

/// Column of `measure`'s table of single shots alone.
const OF_SHOTS: &str = "not_counted_because";

/// Refuses a table of single shots, a column that stands twice, and one of a wanted observable in another
/// unit or name, which would be left out without a word.
fn unclear(titles: &[String], wanted: &[Observable], file: &str) -> Result<(), InferError> {
    if titles.iter().any(|title| title == OF_SHOTS) {
        return InferError::input(format!(
            "{file} has single shots, also those that do not count, and not the errors that they share; \
             fit their means: `speeds.csv` of the same folder, in Python what `measure` returned"
        ));
    }
    let read = ["speed", "tof_", "shots", "case"].into_iter();
    let read = read.chain(Observable::ALL.map(|of| of.column()));
    let is_read = |title: &&String| read.clone().any(|stem| title.starts_with(stem));
    let mut seen = HashSet::new();
    if let Some(column) = titles.iter().filter(is_read).find(|title| !seen.insert(*title)) {
        return InferError::input(format!("{file}: column `{column}` stands there twice"));
    }
    for of in wanted.iter().filter(|of| of.is_time()) {
        let stem = of.column().strip_suffix("_s").unwrap_or(of.column());
        let is_there = titles.iter().any(|title| title == of.column())
            || AT_MEAN_SPEED.get(of.index()).is_some_and(|name| titles.iter().any(|t| t == name));
        let unread = titles.iter().find(|title| title.starts_with(stem));
        if let Some(unread) = unread.filter(|_| !is_there) {
            return InferError::input(format!(
                "{file}: `{unread}` is there without a column `{}`, in s; rename it, or leave this \
                 time out with --use",
                of.column()
            ));
        }
    }
    Ok(())
}

/// What a table without any wanted observable should have, with a hint at what it has.
fn instead(titles: &[String], wanted: &[Observable]) -> String {
    let kinds = [(true, "times in s"), (false, "ratios of peaks")].into_iter();
    let kinds = kinds.filter(|(times, _)| wanted.iter().any(|of| of.is_time() == *times));
    let kinds: Vec<&str> = kinds.map(|(_, name)| name).collect();
    let others = Observable::ALL.into_iter().filter(|of| !wanted.contains(of));
    let there = others.map(Observable::column).find(|column| titles.iter().any(|t| t == column));
    let hint = there.map_or_else(
        || other_unit(titles, "tof", "_s"),
        |column| format!("; `{column}` is there, but --use does not name it"),
    );
    format!("{}{hint}", kinds.join(" or "))
}

/// A hint at a column that looks like the one wanted, but for its unit.
fn other_unit(titles: &[String], beginning: &str, unit: &str) -> String {
    let near = |title: &&String| title.starts_with(beginning) && !title.ends_with(unit);
    titles.iter().find(near).map_or(String::new(), |title| {
        format!("; `{title}` is not read, since its title does not end with the SI unit")
    })
}

fn find(titles: &[String], names: &[&str]) -> Option<usize> {
    names.iter().find_map(|name| titles.iter().position(|title| title == name))
}

/// The column of a quantity, and that of its error: `x_s_err`, `x_err_s`, or the same with `error`
/// or `sigma`.
fn measured(titles: &[String], name: &str) -> Option<Measured> {
    let stem = |unit: &&str| name.strip_suffix(*unit).filter(|stem| !stem.is_empty());
    let unit = ["_m_s", "_s"].into_iter().find(|unit| stem(unit).is_some()).unwrap_or("");
    let stem = stem(&unit).unwrap_or(name);
    let of = |word: &str| [format!("{name}_{word}"), format!("{stem}_{word}{unit}")];
    let names: Vec<String> = ["error", "err", "sigma"].into_iter().flat_map(of).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    Some(Measured {
        value: find(titles, &[name])?,
        sigma: find(titles, &names),
        count: find(titles, &[&format!("{name}_count")]),
        shared: None,
    })
}

/// Faster than any striker: speeds of chains are in m/s.
const MOST_SPEED_M_S: f64 = 50.0;
/// Longer than a wave takes through any row on a table.
const MOST_TIME_S: f64 = 0.1;
/// Times from here on are rather microseconds than milliseconds.
const MICROSECONDS_FROM: f64 = 20.0;

/// What is wrong with a speed of a striker in m/s, if anything is.
pub fn wrong_speed(value: f64) -> Option<String> {
    let is_fast = value > MOST_SPEED_M_S;
    // Further digits are rounding.
    let value: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    if value <= 0.0 || !value.is_finite() {
        return Some(format!("{value} is no speed of a striker; expected more than 0 m/s"));
    }
    is_fast.then(|| {
        format!("{value} m/s is no speed of a striker; it looks like mm/s or cm/s, expected m/s")
    })
}

fn wrong_value(of: Observable, value: f64) -> Option<String> {
    let name = of.name();
    if value <= 0.0 || !value.is_finite() {
        return Some(format!("{value} is no {name}; expected a positive number"));
    }
    let unit = if value >= MICROSECONDS_FROM { "microseconds" } else { "milliseconds" };
    (of.is_time() && value > MOST_TIME_S)
        .then(|| format!("{value} s is no {name}; it looks like {unit}, expected seconds"))
}

fn wrong_sigma(of: Observable, Estimate { value, sigma }: Estimate) -> Option<String> {
    if sigma <= 0.0 || !sigma.is_finite() {
        return Some(format!("{sigma} is no uncertainty; expected a standard error above 0"));
    }
    let unit = if of.is_time() { " s" } else { "" };
    (sigma > value).then(|| {
        format!(
            "the uncertainty {sigma}{unit} is larger than the value {value}{unit}: another unit?"
        )
    })
}

fn wrong_speed_sigma(Estimate { value, sigma }: Estimate) -> Option<String> {
    if sigma < 0.0 || !sigma.is_finite() {
        return Some(format!("{sigma} is no uncertainty; expected 0 m/s or more"));
    }
    (sigma >= value).then(|| {
        format!("the uncertainty {sigma} m/s is not below the speed {value} m/s: another unit?")
    })
}

struct Reader<'a> {
    file: &'a str,
    titles: &'a [String],
    selection: &'a Selection,
    columns: Columns,
}

impl Reader<'_> {
    fn wrong<T>(&self, line: u64, column: usize, what: &str) -> Result<T, InferError> {
        InferError::input(format!("{}, line {line}, {}: {what}", self.file, self.titles[column]))
    }

    fn check(&self, wrong: Option<String>, line: u64, column: usize) -> Result<(), InferError> {
        wrong.map_or(Ok(()), |what| self.wrong(line, column, &what))
    }

    /// The number in a cell, if there are such a column and a number.
    fn number(&self, record: &Record, column: Option<usize>) -> Result<Option<f64>, InferError> {
        let Some(column) = column else { return Ok(None) };
        match &record.cells[column] {
            Ok(number) => Ok(*number),
            Err(text) => self.wrong(record.line, column, &format!("`{text}` is no number")),
        }
    }

    /// A row; none where nothing was seen at this speed.
    fn row(&self, record: &Record) -> Result<Option<DataRow>, InferError> {
        let line = record.line;
        let speed_m_s = self.speed(record)?;
        let (mut values, mut freedom) = ([None; 4], Freedom::KNOWN);
        freedom.speed = self.freedom(record, &self.columns.speed, speed_m_s.sigma)?;
        for (of, columns) in Observable::ALL.into_iter().zip(&self.columns.observables) {
            let Some(columns) = columns else { continue };
            let value = self.observable(record, of, columns)?;
            let sigma = value.map_or(f64::NAN, |value| value.sigma);
            freedom.values[of.index()] = self.freedom(record, columns, sigma)?;
            values[of.index()] = value;
        }
        let correlation = self.number(record, self.columns.correlation)?;
        if let (Some(value), Some(column)) = (correlation, self.columns.correlation)
            && (value.is_nan() || value.abs() >= 1.0)
        {
            let what = format!(
                "{value} is no correlation of two errors; expected a number between -1 and 1"
            );
            return self.wrong(line, column, &what);
        }
        let row = DataRow { line, speed_m_s, values, correlation, freedom };
        Ok(values.iter().any(Option::is_some).then_some(row))
    }

    fn speed(&self, record: &Record) -> Result<Estimate, InferError> {
        let (line, Measured { value: column, sigma, .. }) = (record.line, self.columns.speed);
        let Some(value) = self.number(record, Some(column))? else {
            return self.wrong(line, column, "no speed; expected one in m/s");
        };
        self.check(wrong_speed(value), line, column)?;
        let known = self.number(record, sigma)?;
        let sigma_m_s = known.or(self.selection.speed_error_m_s).unwrap_or(0.0);
        let speed = Estimate { value, sigma: sigma_m_s };
        self.check(wrong_speed_sigma(speed), line, sigma.unwrap_or(column))?;
        Ok(speed)
    }

    fn observable(
        &self,
        record: &Record,
        of: Observable,
        columns: &Measured,
    ) -> Result<Option<Estimate>, InferError> {
        let line = record.line;
        let Some(value) = self.number(record, Some(columns.value))? else {
            return self.plain_alone(record, of, columns.value).map(|()| None);
        };
        self.check(wrong_value(of, value), line, columns.value)?;
        let known = self.number(record, columns.sigma)?;
        let (usual, option) = match of.is_time() {
            true => (self.selection.time_error_s, "--tof-error"),
            false => (self.selection.ratio_error, "--ratio-error"),
        };
        let place = columns.sigma.unwrap_or(columns.value);
        let Some(sigma) = known.or(usual) else {
            let what = format!(
                "no uncertainty of this {}; expected a standard error in a column `{}_error`, or \
                 {option} for all rows",
                of.name(),
                self.titles[columns.value]
            );
            return self.wrong(line, place, &what);
        };
        let estimate = Estimate { value, sigma };
        self.check(wrong_sigma(of, estimate), line, place)?;
        Ok(Some(estimate))
    }

    /// Refuses a row whose plain mean would be passed over, as the time at the mean speed is missing.
    fn plain_alone(&self, record: &Record, of: Observable, read: usize) -> Result<(), InferError> {
        let plain = find(self.titles, &[of.column()]).filter(|plain| *plain != read);
        match self.number(record, plain)? {
            None => Ok(()),
            Some(_) => {
                let what = format!(
                    "no number, though `{}` has one: fill the cell, or leave this column out",
                    of.column()
                );
                self.wrong(record.line, read, &what)
            }
        }
    }

    /// Degrees of freedom of the scatter from which a standard error comes; infinite if it is known,
    /// as one from an option is. Of an error part of which all shots share, and which is known,
    /// Satterthwaite's: the rest alone scatters.
    fn freedom(&self, record: &Record, columns: &Measured, sigma: f64) -> Result<f64, InferError> {
        let has_own = columns.sigma.is_some_and(|at| !matches!(record.cells[at], Ok(None)));
        match self.selection.scatter {
            Scatter::Of(shots) => return Ok(f64::from(shots) - 1.0),
            Scatter::AsTold if has_own => {}
            _ => return Ok(f64::INFINITY),
        }
        let shots = self.shots(record, columns)?;
        let shared = self.number(record, columns.shared)?.unwrap_or(0.0);
        let scattered = 1.0 - (shared / sigma).powi(2).min(1.0);
        // One shot has no scatter, nor has none: the error is known from elsewhere.
        Ok(match shots {
            Some(shots) if shots > 1.0 => (shots - 1.0) / scattered.powi(2),
            _ => f64::INFINITY,
        })
    }

    /// Number of shots that a mean is of.
    fn shots(&self, record: &Record, columns: &Measured) -> Result<Option<f64>, InferError> {
        for column in columns.count.into_iter().chain(self.columns.shots) {
            if let Some(shots) = self.number(record, Some(column))? {
                if shots < 0.0 || shots.fract() != 0.0 {
                    let what = format!("{shots} is no number of shots; expected a whole one");
                    return self.wrong(record.line, column, &what);
                }
                return Ok(Some(shots));
            }
        }
        Ok(None)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]
#[path = "tests/columns.rs"]
mod tests;
