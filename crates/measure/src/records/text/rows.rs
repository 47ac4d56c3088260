//! Rows into records, line by line.

use super::dialect::{Dialect, last_digit, no_number, number};
use super::times::{self, Printed, Returns};
use super::{LineEnding, Lines, as_text};
use crate::error::{MeasureError, Result, file_name};
use crate::records::interval::{self, SampleInterval};
use crate::records::options::{Parts, ReadOptions};
use crate::records::record::{Channel, Record};
use crate::records::stored::{MOST_SAMPLES, from_sample};
use std::borrow::Cow;
use std::collections::VecDeque;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Longest footer in lines: more is something else.
const LONGEST_FOOTER: usize = 8;

pub(super) struct RowPlan {
    pub dialect: Dialect,
    /// Names of channels, and the volts of one in each.
    pub names: Vec<(String, f64)>,
    pub columns: Vec<usize>,
    /// Column of times and their unit in s.
    pub time: Option<(usize, f64)>,
    /// Interval in s that a line beside the numbers states.
    pub stated_s: Option<f64>,
    /// The interval; of the last segment where times are written.
    pub interval: SampleInterval,
    /// Lines that, seen again, separate segments.
    pub separators: Vec<String>,
    pub options: ReadOptions,
    pub note: Option<String>,
}

pub(super) struct Segments {
    file: PathBuf,
    lines: Lines,
    bytes: Vec<u8>,
    plan: RowPlan,
    line: usize,
    ended: bool,
    skipping: bool,
    shots: u64,
    /// Samples of the segment under way that were returned before.
    passed: usize,
    /// Whether times go back so soon that they are no segments'.
    to_and_fro: bool,
    returns: Returns,
    /// Lines in words after rows; a footer unless rows follow.
    footer: Option<Footer>,
    /// Whether no row came since a segment's end: lines in words would be its footer.
    trailing: bool,
    block: TextBlock,
    ready: VecDeque<Result<Record>>,
}

#[derive(Default)]
struct TextBlock {
    times: Vec<Printed>,
    columns: Vec<Vec<f64>>,
}

impl TextBlock {
    fn len(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }
}

struct Footer {
    shown: String,
    detail: String,
    lines: usize,
}

enum Line {
    Row(Option<Printed>, Vec<f64>),
    Separator,
    Words(Footer),
    Bad(String),
    End,
}

impl RowPlan {
    /// Time and samples of a row. Cells without a number count in whole lines only.
    fn row(&self, fields: &[Cow<'_, str>], whole: bool) -> Option<(Option<Printed>, Vec<f64>)> {
        let comma = self.dialect.decimal_comma;
        let value = |column: &usize| {
            let field = fields.get(*column)?;
            number(field, comma).or_else(|| no_number(field).filter(|_| whole))
        };
        let time = match self.time {
            Some((column, unit_s)) => Some(self.time(fields.get(column), unit_s)?),
            None => None,
        };
        let values: Option<Vec<f64>> = self.columns.iter().map(value).collect();
        Some((time, values?))
    }

    /// A time and its last digit; where the rate is trusted it may be anything.
    fn time(&self, field: Option<&Cow<'_, str>>, unit_s: f64) -> Option<Printed> {
        let comma = self.dialect.decimal_comma;
        let read = field.and_then(|field| Some((number(field, comma)?, last_digit(field, comma))));
        let trusted = self.options.trusted_rate_hz();
        let (time, last) = read.or(trusted.map(|_| (f64::NAN, 0.0)))?;
        Some(Printed { s: time * unit_s, unit_s: last * unit_s })
    }

    /// Whether a line is one of those before the numbers, but for digits: "Segment 2".
    fn separates(&self, line: &str) -> bool {
        let letters = |line: &str| line.replace(|c: char| c.is_ascii_digit(), "");
        let own = letters(line);
        let worded = own.contains(char::is_alphabetic);
        let mut known = self.separators.iter();
        known.any(|known| known == line || (worded && letters(known) == own))
    }
}

impl Segments {
    pub(super) fn open(file: &Path, plan: RowPlan) -> io::Result<Self> {
        let mut lines = Lines::open(file)?;
        let mut bytes = Vec::new();
        for _ in 0..plan.dialect.first_row {
            lines.next(&mut bytes)?;
        }
        Ok(Self {
            file: file.to_owned(),
            lines,
            bytes,
            line: plan.dialect.first_row,
            plan,
            ended: false,
            skipping: false,
            shots: 0,
            passed: 0,
            to_and_fro: false,
            returns: Returns::default(),
            footer: None,
            trailing: false,
            block: TextBlock::default(),
            ready: VecDeque::new(),
        })
    }

    fn line(&mut self) -> Line {
        let read = match self.lines.next(&mut self.bytes) {
            Ok(LineEnding::Nothing) => return Line::End,
            Ok(read) => read,
            Err(cause) => {
                let error = MeasureError::reading(&self.file, cause);
                self.ready.push_back(Err(error));
                return Line::End;
            }
        };
        self.line += 1;
        let whole = read == LineEnding::Whole;
        let line = as_text(&self.bytes);
        let fields = self.plan.dialect.fields(&line);
        let blank = fields.iter().all(|field| field.is_empty());
        if let Some((time, values)) = self.plan.row(&fields, whole).filter(|_| !blank) {
            return Line::Row(time, values);
        }
        if blank || self.plan.separates(&line) {
            return Line::Separator;
        }
        let shown: String = line.chars().take(60).collect();
        let detail = format!("line {} is no row of numbers: {shown:?}", self.line);
        match (is_worded(&line), whole) {
            (true, _) => Line::Words(Footer { shown, detail, lines: 0 }),
            (false, true) => Line::Bad(detail),
            (false, false) => Line::Bad(format!("line {} stops in the middle", self.line)),
        }
    }

    fn advance(&mut self) {
        match self.line() {
            Line::Row(..) | Line::Words(_) | Line::Bad(_) if self.skipping => {}
            Line::Row(time, values) => match self.footer.take() {
                Some(footer) => self.reject(footer.detail),
                None => {
                    self.trailing = false;
                    self.row(time, &values);
                }
            },
            Line::Separator => {
                if self.block.len() > 0 {
                    self.end_segment();
                }
                self.skipping = false;
                self.trailing = true;
            }
            Line::Words(first) => {
                let footer = self.footer.get_or_insert(first);
                footer.lines += 1;
                if footer.lines > LONGEST_FOOTER {
                    let detail = std::mem::take(&mut footer.detail);
                    self.reject(detail);
                }
            }
            Line::Bad(detail) => {
                let first = self.footer.take().map(|footer| footer.detail);
                self.reject(first.unwrap_or(detail));
            }
            Line::End => {
                self.end_segment();
                self.ended = true;
            }
        }
    }

    /// Drops the rows since the last separator and those until the next.
    fn reject(&mut self, detail: String) {
        self.footer = None;
        self.trailing = false;
        self.block = TextBlock::default();
        self.skipping = true;
        self.shots += 1;
        let error = MeasureError::malformed(&self.file, "text", detail);
        self.ready.push_back(Err(error));
    }

    /// Makes records of the block; lines in words after it were its footer.
    fn end_segment(&mut self) {
        self.close(true);
        let Some(footer) = self.footer.take() else {
            return;
        };
        match self.ready.back_mut() {
            Some(Ok(record)) => record.notes.push(format!(
                "what follows the numbers, from {:?} on, is no row and was passed over",
                footer.shown
            )),
            Some(Err(_)) => {}
            None => self.reject(footer.detail),
        }
    }

    fn row(&mut self, time: Option<Printed>, values: &[f64]) {
        if let Some(time) = time {
            let begins = match self.plan.options.trusted_rate_hz() {
                Some(_) => self.returns.begins(time.s),
                None => self.goes_back(time),
            };
            if begins {
                self.close(true);
            }
            self.block.times.push(time);
        }
        self.block.columns.resize_with(values.len(), Vec::new);
        for (column, value) in self.block.columns.iter_mut().zip(values) {
            column.push(*value);
        }
        let length = self.block.len();
        if Some(length) == self.plan.options.parts.most() {
            self.close(false);
        } else if length > MOST_SAMPLES {
            self.block = TextBlock::default();
            self.skipping = true;
            let error = MeasureError::too_long(file_name(&self.file), MOST_SAMPLES);
            self.ready.push_back(Err(error));
        }
    }

    /// Whether a segment begins with this time. One of a few rows is none: then times go to and
    /// fro, which is reported once.
    fn goes_back(&mut self, time: Printed) -> bool {
        let times = &self.block.times;
        let back = times.last().is_some_and(|last| time.s < last.s);
        self.to_and_fro |= back && self.passed == 0 && times.len() < times::SHORTEST;
        back && !self.to_and_fro
    }

    /// Makes records of the block, of which more may follow only if it is a piece.
    fn close(&mut self, ended: bool) {
        let block = std::mem::take(&mut self.block);
        let is_trusted = self.plan.options.trusted_rate_hz().is_some();
        let segments = match self.plan.time {
            _ if block.len() == 0 => Vec::new(),
            Some(_) if !is_trusted && !self.to_and_fro => times::segments(&block.times),
            _ => std::iter::once(0..block.len()).collect(),
        };
        for (number, range) in segments.into_iter().enumerate() {
            if number > 0 || self.passed == 0 {
                self.passed = 0;
                self.shots += 1;
            }
            let count = range.len();
            let record = self.record(&block, range);
            self.ready.push_back(record);
            self.passed += count;
        }
        if ended || !matches!(self.plan.options.parts, Parts::Pieces(_)) {
            (self.passed, self.to_and_fro) = (0, false);
        }
    }

    fn record(&mut self, block: &TextBlock, range: Range<usize>) -> Result<Record> {
        // The number of the only record would say nothing, but when it is made it is not known
        // whether more will follow.
        let segment = match self.shots {
            1 => file_name(&self.file),
            shot => format!("{}, segment {shot}", file_name(&self.file)),
        };
        let source = from_sample(segment, self.passed as u64);
        let times = block.times.get(range.clone()).unwrap_or_default();
        let interval = self.interval(&source, times)?;
        let channels = self.plan.names.iter().zip(&block.columns);
        let channels = channels.map(|((name, volts), column)| Channel {
            name: name.clone(),
            volts: column[range.clone()].iter().map(|number| number * volts).collect(),
            range_v: None,
        });
        let channels = channels.collect();
        let notes = self.plan.note.iter().cloned();
        Ok(Record {
            shot: Some(self.shots),
            first_sample: self.passed as u64,
            interval_error_s: interval.error_s,
            notes: notes.chain(interval.note).collect(),
            ..Record::new(source, &self.file, interval.s, channels)
        })
    }

    /// The interval of a segment; a piece that goes on has that of the piece before it.
    fn interval(&mut self, source: &str, times: &[Printed]) -> Result<SampleInterval> {
        let options = &self.plan.options;
        if let Some(rate_hz) = options.trusted_rate_hz() {
            return Ok(SampleInterval::exact(rate_hz.recip()));
        }
        if self.plan.time.is_some() && self.passed == 0 {
            let range = times::interval(source, times)?;
            let stated_s = self.plan.stated_s;
            self.plan.interval = interval::from_times(&self.file, &range, stated_s, options)?;
        } else if times.len() > 1 {
            times::interval(source, times)?;
        }
        Ok(self.plan.interval.clone())
    }
}

/// Whether a line begins as words or a comment do, and not as a number that stops in its middle.
fn is_worded(line: &str) -> bool {
    let start = line.trim_start_matches(['"', ' ', '\t', ',', ';']);
    start.starts_with(|first: char| first.is_alphabetic() || "#%*=/<[(".contains(first))
}

impl Iterator for Segments {
    type Item = Result<Record>;

    fn next(&mut self) -> Option<Self::Item> {
        // A footer after a blank line is noted with the record before it.
        while (self.ready.is_empty() || self.trailing) && !self.ended {
            self.advance();
        }
        self.ready.pop_front()
    }
}
