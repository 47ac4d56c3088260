//! From text to rows.

use super::columns::{Column, Columns, Measured};
use super::{Data, DataError, DataRow, Freedom, Observable, Place, check};
use csv::{ReaderBuilder, StringRecord, Trim};
use hertzchain_measure::signal::Estimate;

/// Standard errors for tables that have no columns of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Defaults {
    /// Of speeds in m/s; 0 when `None`.
    pub speed_m_s: Option<f64>,
    /// Of times of flight in s.
    pub time_s: Option<f64>,
    /// Of ratios of peaks.
    pub ratio: Option<f64>,
    /// How well errors are known, the table's too.
    pub scatter: Scatter,
}

/// From the scatter of how many shots standard errors come. Such errors are widened by
/// [`widening`](super::widening) in fits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scatter {
    /// As many as the table tells of each row's own errors, in columns as `measure`
    /// writes them: `shots`, and `tof_incident_s_count` of one quantity, less what they
    /// share (`tof_incident_shared_s`); `speed_error_shots` of the speed, 0 where it is known. Where it tells nothing, errors are known.
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
    /// Which case of a table with a column `case`; needed if it has several.
    pub case: Option<String>,
    /// Which measured numbers; others are not looked at.
    pub observables: Vec<Observable>,
    /// Standard errors where the table has none.
    pub defaults: Defaults,
}

impl Default for Selection {
    /// Both times of flight.
    fn default() -> Self {
        Self {
            case: None,
            observables: vec![Observable::Incident, Observable::Reflected],
            defaults: Defaults::default(),
        }
    }
}

impl Data {
    /// Reads a table from text: commas, or semicolons with decimal commas. Cells
    /// of observables may be empty: that one was not seen.
    ///
    /// # Errors
    /// See [`DataError`]: the first row and column that can't be used.
    pub fn parse(file: &str, text: &str, selection: &Selection) -> Result<Self, DataError> {
        let (titles, records) = records(file, text)?;
        let columns = Columns::of(&titles, &selection.observables, file)?;
        let reader = Reader {
            file,
            decimal_comma: delimiter(text) != b',',
            defaults: &selection.defaults,
            columns,
        };
        let (case, records) = reader.of_case(records, selection.case.as_deref())?;
        let rows = records
            .iter()
            .filter_map(|record| reader.row(record).transpose());
        let mut rows: Vec<DataRow> = rows.collect::<Result<_, _>>()?;
        reader.check_repeated(&rows)?;
        rows.sort_by(|a, b| a.speed_m_s.value.total_cmp(&b.speed_m_s.value));
        let file = file.to_owned();
        match rows.is_empty() {
            true => Err(DataError::Empty { file }),
            false => Ok(Self { file, case, rows }),
        }
    }
}

/// What the line of titles is divided by.
fn delimiter(text: &str) -> u8 {
    let titles = text
        .lines()
        .find(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let marks = [b';', b'\t'].into_iter();
    let mut marks = marks.filter(|mark| titles.is_some_and(|t| t.as_bytes().contains(mark)));
    marks.next().unwrap_or(b',')
}

/// A text whose lines all end alike: the reader counts a carriage return and a line
/// feed as one line too few.
pub(crate) fn with_plain_ends(text: &str) -> String {
    text.replace("\r\n", "\n").replace('\r', "\n")
}

fn records(file: &str, text: &str) -> Result<(Vec<String>, Vec<StringRecord>), DataError> {
    let no_table = |what: String| DataError::NoTable {
        file: file.to_owned(),
        what,
    };
    let text = with_plain_ends(text);
    let text = text.trim_start_matches('\u{feff}');
    if text.trim().is_empty() {
        return Err(no_table("the file is empty".to_owned()));
    }
    let mut reader = ReaderBuilder::new()
        .delimiter(delimiter(text))
        .comment(Some(b'#'))
        .trim(Trim::All)
        .from_reader(text.as_bytes());
    let titles = reader
        .headers()
        .map_err(|error| no_table(error.to_string()))?;
    let titles: Vec<String> = titles.iter().map(str::to_owned).collect();
    let records = reader.records().collect::<Result<Vec<_>, _>>();
    Ok((
        titles,
        records.map_err(|error| no_table(error.to_string()))?,
    ))
}

struct Reader<'a> {
    file: &'a str,
    decimal_comma: bool,
    defaults: &'a Defaults,
    columns: Columns,
}

fn line(record: &StringRecord) -> u64 {
    record.position().map_or(0, csv::Position::line)
}

impl Reader<'_> {
    fn cell_error(&self, line: u64, column: &Column, what: String) -> DataError {
        DataError::Cell {
            place: Place {
                file: self.file.to_owned(),
                line,
                column: column.title.clone(),
            },
            what,
        }
    }

    /// The records of the case asked for, or of all where there is only one.
    fn of_case(
        &self,
        records: Vec<StringRecord>,
        asked: Option<&str>,
    ) -> Result<(String, Vec<StringRecord>), DataError> {
        let of = |record: &StringRecord| {
            let column = self.columns.case.as_ref();
            let cell = column.and_then(|column| record.get(column.at));
            cell.unwrap_or_default().to_owned()
        };
        let mut cases: Vec<String> = Vec::new();
        for case in records.iter().map(of) {
            if !cases.contains(&case) {
                cases.push(case);
            }
        }
        let wrong = |what: String, cases: Vec<String>| {
            let file = self.file.to_owned();
            Err(DataError::Case { file, what, cases })
        };
        let chosen = match (asked, &cases[..]) {
            (None, []) => String::new(),
            (None, [only]) => only.clone(),
            (None, _) => return wrong("one case must be chosen by --case".to_owned(), cases),
            // Of the model, then: the table knows of none.
            (Some(name), _) if self.columns.case.is_none() => {
                return Ok((name.to_owned(), records));
            }
            (Some(name), _) if cases.iter().any(|case| case == name) => name.to_owned(),
            (Some(name), _) => return wrong(format!("it has no case `{name}`"), cases),
        };
        let records = records.into_iter().filter(|record| of(record) == chosen);
        Ok((chosen.clone(), records.collect()))
    }

    /// A row; none where nothing was seen at this speed.
    fn row(&self, record: &StringRecord) -> Result<Option<DataRow>, DataError> {
        let line = line(record);
        let speed_m_s = self.speed(record, line)?;
        let mut values = [None; 4];
        let mut freedom = Freedom {
            speed: self.freedom(record, line, &self.columns.speed, speed_m_s.sigma)?,
            ..Freedom::KNOWN
        };
        for (of, columns) in Observable::ALL.into_iter().zip(&self.columns.observables) {
            if let Some(columns) = columns {
                let value = self.observable(record, line, of, columns)?;
                let sigma = value.map_or(f64::NAN, |value| value.sigma);
                freedom.values[of.index()] = self.freedom(record, line, columns, sigma)?;
                values[of.index()] = value;
            }
        }
        let row = DataRow {
            line,
            speed_m_s,
            values,
            correlation: self.correlation(record, line)?,
            freedom,
        };
        Ok(values.iter().any(Option::is_some).then_some(row))
    }

    fn speed(&self, record: &StringRecord, line: u64) -> Result<Estimate, DataError> {
        let Measured { value, sigma, .. } = &self.columns.speed;
        let speed = self.number(record, line, value)?.ok_or_else(|| {
            let what = "no speed; expected one in m/s".to_owned();
            self.cell_error(line, value, what)
        })?;
        self.sound(check::wrong_speed(speed), line, value)?;
        let known = match sigma {
            Some(column) => self.number(record, line, column)?,
            None => None,
        };
        let estimate = Estimate {
            value: speed,
            sigma: known.or(self.defaults.speed_m_s).unwrap_or(0.0),
        };
        let place = sigma.as_ref().unwrap_or(value);
        self.sound(check::speed_sigma(estimate), line, place)?;
        Ok(estimate)
    }

    fn observable(
        &self,
        record: &StringRecord,
        line: u64,
        of: Observable,
        columns: &Measured,
    ) -> Result<Option<Estimate>, DataError> {
        let Some(value) = self.number(record, line, &columns.value)? else {
            return Ok(None);
        };
        self.sound(check::value(of, value), line, &columns.value)?;
        let known = match &columns.sigma {
            Some(column) => self.number(record, line, column)?,
            None => None,
        };
        let (usual, option) = match of.is_time() {
            true => (self.defaults.time_s, "--tof-error"),
            false => (self.defaults.ratio, "--ratio-error"),
        };
        let place = columns.sigma.as_ref().unwrap_or(&columns.value);
        let sigma = known.or(usual).ok_or_else(|| {
            let what = format!(
                "no uncertainty of this {}; expected a standard error in a column `{}_error`, or \
                 {option} for all rows",
                of.name(),
                of.column()
            );
            self.cell_error(line, place, what)
        })?;
        let estimate = Estimate { value, sigma };
        self.sound(check::sigma(of, estimate), line, place)?;
        Ok(Some(estimate))
    }

    /// Correlation of the errors of both times, where the table has one.
    fn correlation(&self, record: &StringRecord, line: u64) -> Result<Option<f64>, DataError> {
        let Some(column) = &self.columns.correlation else {
            return Ok(None);
        };
        let value = self.number(record, line, column)?;
        self.sound(value.and_then(check::correlation), line, column)?;
        Ok(value)
    }

    /// Degrees of freedom of the scatter from which a standard error comes; infinite if
    /// it is known, as one from an option is. Of an error part of which all shots share, and
    /// which is known, Satterthwaite's: the rest alone scatters.
    fn freedom(
        &self,
        record: &StringRecord,
        line: u64,
        columns: &Measured,
        sigma: f64,
    ) -> Result<f64, DataError> {
        let own = columns.sigma.as_ref();
        let own = own.is_some_and(|column| !record.get(column.at).unwrap_or_default().is_empty());
        match self.defaults.scatter {
            Scatter::Known => return Ok(f64::INFINITY),
            Scatter::Of(shots) => return Ok(f64::from(shots) - 1.0),
            Scatter::AsTold if !own => return Ok(f64::INFINITY),
            Scatter::AsTold => {}
        }
        let Some(shots) = self.shots(record, line, columns)? else {
            return Ok(f64::INFINITY);
        };
        let shared = match &columns.shared {
            Some(column) => self.number(record, line, column)?.unwrap_or(0.0),
            None => 0.0,
        };
        let scattered = 1.0 - (shared / sigma).powi(2).min(1.0);
        // One shot has no scatter, nor has none: the error is known from elsewhere.
        Ok(match shots > 1.0 {
            true => (shots - 1.0) / scattered.powi(2),
            false => f64::INFINITY,
        })
    }

    /// How many shots a row tells that a mean is of.
    fn shots(
        &self,
        record: &StringRecord,
        line: u64,
        columns: &Measured,
    ) -> Result<Option<f64>, DataError> {
        for column in columns.count.iter().chain(&self.columns.shots) {
            if let Some(shots) = self.number(record, line, column)? {
                let wrong = shots < 0.0 || shots.fract() != 0.0;
                let what = || format!("{shots} is no number of shots; expected a whole one");
                self.sound(wrong.then(what), line, column)?;
                return Ok(Some(shots));
            }
        }
        Ok(None)
    }

    fn sound(&self, wrong: Option<String>, line: u64, column: &Column) -> Result<(), DataError> {
        wrong.map_or(Ok(()), |what| Err(self.cell_error(line, column, what)))
    }

    /// The number in a cell, if there is one.
    fn number(
        &self,
        record: &StringRecord,
        line: u64,
        column: &Column,
    ) -> Result<Option<f64>, DataError> {
        let text = record.get(column.at).unwrap_or_default();
        if text.is_empty() {
            return Ok(None);
        }
        let plain = match self.decimal_comma {
            true => text.replace(',', "."),
            false => text.to_owned(),
        };
        let number = plain.parse().map(Some);
        number.map_err(|_| self.cell_error(line, column, format!("`{text}` is no number")))
    }

    /// Refuses one speed twice: means of shots are not ours to take.
    fn check_repeated(&self, rows: &[DataRow]) -> Result<(), DataError> {
        for (at, row) in rows.iter().enumerate() {
            let earlier = rows[..at].iter();
            let mut same = earlier.filter(|e| e.speed_m_s.value == row.speed_m_s.value);
            if let Some(first) = same.next() {
                let what = format!(
                    "the speed {} m/s stands in line {} too; expected one row a speed, as \
                     `hertzchain measure` writes them in speeds.csv",
                    row.speed_m_s.value, first.line
                );
                return Err(self.cell_error(row.line, &self.columns.speed.value, what));
            }
        }
        Ok(())
    }
}
