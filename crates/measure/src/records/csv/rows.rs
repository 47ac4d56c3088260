//! Rows into records, line by line.

use super::dialect::{Dialect, text};
use super::field::{fields, last_digit, no_number, number};
use super::lines::{Lines, Read};
use super::times::{self, Printed, Returns};
use crate::records::cut::{MOST_SAMPLES, from_sample};
use crate::records::error::{RecordError, name};
use crate::records::interval::{self, Interval};
use crate::records::options::{Parts, ReadOptions};
use crate::records::record::{Channel, Record, Samples};
use std::borrow::Cow;
use std::collections::VecDeque;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What is to be read of every row.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub dialect: Dialect,
    pub names: Vec<String>,
    pub columns: Vec<usize>,
    /// Column of times and their unit in s.
    pub time: Option<(usize, f64)>,
    /// In s between samples, that a line beside the numbers states.
    pub stated_s: Option<f64>,
    /// Between samples; of the last segment where times are written.
    pub interval: Interval,
    /// Lines that, seen again, separate segments.
    pub separators: Vec<String>,
    pub options: ReadOptions,
    /// What was taken for granted.
    pub notes: Vec<String>,
}

/// An iterator over the records of a text.
pub(super) struct Rows {
    file: PathBuf,
    lines: Lines,
    bytes: Vec<u8>,
    plan: Plan,
    line: usize,
    ended: bool,
    /// Skipping to the next segment after a bad row.
    lost: bool,
    /// Segments so far.
    shots: u64,
    /// Samples of the segment under way that were given before.
    passed: usize,
    /// Whether times go back so soon that they are no segments'.
    to_and_fro: bool,
    /// Of times that the given rate makes irrelevant.
    returns: Returns,
    /// Lines in words after rows; a footer unless rows follow.
    footer: Option<Footer>,
    /// Whether no row came since a segment's end: lines in words would be its footer.
    trailing: bool,
    block: Block,
    ready: VecDeque<Result<Record, RecordError>>,
}

/// Rows since the last separator.
#[derive(Default)]
struct Block {
    times: Vec<Printed>,
    columns: Vec<Vec<f64>>,
}

/// Lines in words that follow numbers.
struct Footer {
    /// The first, as far as it is shown.
    shown: String,
    /// Why it is no row.
    detail: String,
    lines: usize,
}

/// Longest footer in lines: more is something else.
const LONGEST_FOOTER: usize = 8;

/// What a line is.
enum Line {
    Row(Option<Printed>, Vec<f64>),
    Separator,
    Words { shown: String, detail: String },
    Bad(String),
    End,
}

impl Rows {
    pub(super) fn open(file: &Path, plan: Plan) -> io::Result<Self> {
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
            lost: false,
            shots: 0,
            passed: 0,
            to_and_fro: false,
            returns: Returns::default(),
            footer: None,
            trailing: false,
            block: Block::default(),
            ready: VecDeque::new(),
        })
    }

    fn line(&mut self) -> Line {
        let read = match self.lines.next(&mut self.bytes) {
            Ok(Read::Nothing) => return Line::End,
            Ok(read) => read,
            Err(cause) => {
                self.ready
                    .push_back(Err(RecordError::reading(&self.file, cause)));
                return Line::End;
            }
        };
        self.line += 1;
        let whole = read == Read::Whole;
        let line = text(&self.bytes);
        let line = line.as_str();
        let dialect = &self.plan.dialect;
        let fields = fields(line, dialect.delimiter);
        let value = |column: &usize| {
            let field = fields.get(*column)?;
            number(field, dialect.decimal_comma).or_else(|| no_number(field).filter(|_| whole))
        };
        let blank = fields.iter().all(|field| field.is_empty());
        let time = match self.plan.time {
            Some((column, unit_s)) => self.time(fields.get(column), unit_s).map(Some),
            None => Some(None),
        };
        let values = self.plan.columns.iter().map(value);
        match time.zip(values.collect()) {
            Some((time, values)) if !blank => Line::Row(time, values),
            _ if blank || self.separates(line) => Line::Separator,
            _ if !whole && !is_worded(line) => {
                Line::Bad(format!("line {} stops in the middle", self.line))
            }
            _ => {
                let shown: String = line.chars().take(60).collect();
                let detail = format!("line {} is no row of numbers: {shown:?}", self.line);
                match is_worded(line) {
                    true => Line::Words { shown, detail },
                    false => Line::Bad(detail),
                }
            }
        }
    }

    /// Whether a line is one of those before the numbers, but for digits: "Segment 2".
    fn separates(&self, line: &str) -> bool {
        let letters = |line: &str| line.replace(|c: char| c.is_ascii_digit(), "");
        let own = letters(line);
        let worded = own.contains(char::is_alphabetic);
        let mut known = self.plan.separators.iter();
        known.any(|known| known == line || (worded && letters(known) == own))
    }

    /// A time and its last digit; where the rate is told and trusted it may be anything.
    fn time(&self, field: Option<&Cow<'_, str>>, unit_s: f64) -> Option<Printed> {
        let comma = self.plan.dialect.decimal_comma;
        let read = field.and_then(|field| Some((number(field, comma)?, last_digit(field, comma))));
        let nothing = || {
            self.plan
                .options
                .rate_is_trusted()
                .then_some((f64::NAN, 0.0))
        };
        read.or_else(nothing).map(|(time, last)| Printed {
            s: time * unit_s,
            unit_s: last * unit_s,
        })
    }

    /// Reads on until something is ready or the file is at its end.
    fn advance(&mut self) {
        match self.line() {
            Line::Row(..) if self.lost => {}
            Line::Row(time, values) => match self.footer.take() {
                Some(footer) => self.bad(footer.detail),
                None => {
                    self.trailing = false;
                    self.row(time, &values);
                }
            },
            Line::Separator => {
                if self.block.len() > 0 {
                    self.end_segment();
                }
                self.lost = false;
                self.trailing = true;
            }
            Line::Words { .. } | Line::Bad(_) if self.lost => {}
            Line::Words { shown, detail } => {
                let first = Footer {
                    shown,
                    detail,
                    lines: 0,
                };
                let footer = self.footer.get_or_insert(first);
                footer.lines += 1;
                if footer.lines > LONGEST_FOOTER {
                    let detail = std::mem::take(&mut footer.detail);
                    self.bad(detail);
                }
            }
            Line::Bad(detail) => {
                let first = self.footer.take().map(|footer| footer.detail);
                self.bad(first.unwrap_or(detail));
            }
            Line::End => {
                self.end_segment();
                self.ended = true;
            }
        }
    }

    /// What was read since the last separator is no segment, nor is what follows until the next.
    fn bad(&mut self, detail: String) {
        self.footer = None;
        self.trailing = false;
        self.block = Block::default();
        self.lost = true;
        self.shots += 1;
        let error = RecordError::malformed(&self.file, "text", detail);
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
            None => self.bad(footer.detail),
        }
    }

    fn row(&mut self, time: Option<Printed>, values: &[f64]) {
        if let Some(time) = time {
            let begins = match self.plan.options.rate_is_trusted() {
                true => self.returns.begins(time.s),
                false => self.goes_back(time),
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
            self.block = Block::default();
            self.lost = true;
            self.ready.push_back(Err(RecordError::TooLong {
                source_name: name(&self.file),
                most: MOST_SAMPLES,
            }));
        }
    }

    /// Whether a segment begins with this time. One of a few rows is none: then times go to and
    /// fro, which is told once.
    fn goes_back(&mut self, time: Printed) -> bool {
        let times = &self.block.times;
        let back = times.last().is_some_and(|last| time.s < last.s);
        self.to_and_fro |= back && self.passed == 0 && times.len() < times::SHORTEST;
        back && !self.to_and_fro
    }

    /// Makes records of the block, of which more may follow only if it is a piece.
    fn close(&mut self, ended: bool) {
        let block = std::mem::take(&mut self.block);
        let whole = 0..block.len();
        let segments = match self.plan.time {
            _ if block.len() == 0 => Vec::new(),
            Some(_) if !self.plan.options.rate_is_trusted() && !self.to_and_fro => {
                times::segments(&block.times)
            }
            _ => std::iter::once(whole).collect(),
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

    fn record(&mut self, block: &Block, range: Range<usize>) -> Result<Record, RecordError> {
        // The number of the only record would tell nothing, but when it is made
        // nobody knows whether more will follow.
        let segment = match self.shots {
            1 => name(&self.file),
            shot => format!("{}, segment {shot}", name(&self.file)),
        };
        let source = from_sample(segment, self.passed as u64);
        let times = block.times.get(range.clone()).unwrap_or_default();
        let interval = self.interval(&source, times)?;
        let channels = self.plan.names.iter().zip(&block.columns);
        let channel = |(name, column): (&String, &Vec<f64>)| Channel {
            name: name.clone(),
            samples: Samples::Volts(column.get(range.clone()).unwrap_or_default().to_vec()),
        };
        Ok(Record {
            shot: Some(self.shots),
            first_sample: self.passed as u64,
            interval_error_s: interval.error_s,
            notes: self
                .plan
                .notes
                .iter()
                .cloned()
                .chain(interval.note)
                .collect(),
            ..Record::new(
                source,
                &self.file,
                interval.s,
                channels.map(channel).collect(),
            )
        })
    }

    /// A piece that goes on is as the piece before it.
    fn interval(&mut self, source: &str, times: &[Printed]) -> Result<Interval, RecordError> {
        let options = &self.plan.options;
        let given = options.rate_hz.filter(|_| options.trust_rate);
        if let Some(rate_hz) = given {
            return Ok(Interval::of(rate_hz.recip()));
        }
        if self.plan.time.is_some() && self.passed == 0 {
            let told = times::interval(source, times)?;
            self.plan.interval =
                interval::from_times(&self.file, &told, self.plan.stated_s, options)?;
        } else if times.len() > 1 {
            times::interval(source, times)?;
        }
        Ok(self.plan.interval.clone())
    }
}

/// Whether a line begins as words or a comment do, and no number that stops in its middle.
fn is_worded(line: &str) -> bool {
    let first = line
        .trim_start_matches(['"', ' ', '\t', ',', ';'])
        .chars()
        .next();
    first.is_some_and(|first| first.is_alphabetic() || "#%*=/<[(".contains(first))
}

impl Block {
    fn len(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }
}

impl Iterator for Rows {
    type Item = Result<Record, RecordError>;

    fn next(&mut self) -> Option<Self::Item> {
        // A footer after a blank line is told with the record before it.
        while (self.ready.is_empty() || self.trailing) && !self.ended {
            self.advance();
        }
        self.ready.pop_front()
    }
}
