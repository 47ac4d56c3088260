//! How a text writes its columns, found from its beginning.

use super::field::{fields, number, plain};
use super::lines::{Lines, Read};
use std::io;
use std::path::Path;

/// As much of a file as tells its dialect.
const BEGINNING: usize = 1 << 18;

/// Rows that are looked at.
const ROWS: usize = 60;

/// Share of rows in which a column must hold a number to be one of numbers.
const MOSTLY: f64 = 0.8;

/// What a number with marks between its thousands counts: a dialect that reads it without any
/// goes before.
const GROUPED: f64 = 0.99;

/// Delimiters in the order of preference; a comma may be a decimal one.
const DELIMITERS: [char; 5] = [';', '\t', '|', ',', ' '];

/// Delimiter, decimal sign and place of the numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Dialect {
    pub delimiter: char,
    pub decimal_comma: bool,
    /// Columns that hold numbers.
    pub columns: Vec<usize>,
    /// Lines before the first row of numbers.
    pub first_row: usize,
}

/// The lines at the beginning of a file, whole ones if there are any, each ended by LF.
pub(super) fn beginning(file: &Path) -> io::Result<String> {
    let mut lines = Lines::open(file)?;
    let (mut all, mut line) = (String::new(), Vec::new());
    loop {
        match lines.next(&mut line)? {
            Read::Nothing => return Ok(all),
            Read::Begun if !all.is_empty() && all.len() + line.len() > BEGINNING => return Ok(all),
            Read::Begun | Read::Whole => {}
        }
        line.truncate(BEGINNING);
        all += &text(&line);
        all.push('\n');
        if all.len() >= BEGINNING {
            return Ok(all);
        }
    }
}

/// Bytes as text; those that are not UTF-8 are taken for Latin-1, as oscilloscopes write µ.
pub(super) fn text(bytes: &[u8]) -> String {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    }
}

impl Dialect {
    /// The dialect in which most of the rows' fields are numbers.
    pub(super) fn of(beginning: &str) -> Option<Self> {
        let lines: Vec<&str> = beginning
            .lines()
            .filter(|line| !line.trim().is_empty())
            .collect();
        // The end of the beginning: preambles are over by then.
        let rows = lines.len().div_ceil(2).min(ROWS);
        let rows = lines.get(lines.len() - rows..)?;
        let mut best: Option<(f64, char, bool)> = None;
        for decimal_comma in [false, true] {
            for delimiter in DELIMITERS {
                let share = share(rows, delimiter, decimal_comma);
                if share > best.map_or(0.0, |best| best.0) {
                    best = Some((share, delimiter, decimal_comma));
                }
            }
        }
        let (_, delimiter, decimal_comma) = best?;
        let columns = columns(rows, delimiter, decimal_comma);
        let mut dialect = Self {
            delimiter,
            decimal_comma,
            columns,
            first_row: 0,
        };
        let first = beginning.lines().position(|line| dialect.is_row(line));
        dialect.first_row = first.filter(|_| !dialect.columns.is_empty())?;
        Some(dialect)
    }

    /// Whether all columns of numbers hold numbers.
    pub(super) fn is_row(&self, line: &str) -> bool {
        let fields = fields(line, self.delimiter);
        let holds = |column: &usize| {
            let field = fields.get(*column);
            field.is_some_and(|field| number(field, self.decimal_comma).is_some())
        };
        self.columns.iter().all(holds)
    }
}

/// Share of the fields that are numbers; longer splits win over equals by a hair,
/// as "1 2" is no number with a space in it.
fn share(rows: &[&str], delimiter: char, decimal_comma: bool) -> f64 {
    let (mut numbers, mut all) = (0.0, 0.0);
    for row in rows {
        for field in fields(row, delimiter)
            .iter()
            .filter(|field| !field.is_empty())
        {
            all += 1.0;
            numbers += match plain(field, decimal_comma) {
                Some(_) => 1.0,
                None if number(field, decimal_comma).is_some() => GROUPED,
                None => 0.0,
            };
        }
    }
    if all > 0.0 { numbers / all } else { 0.0 }
}

fn columns(rows: &[&str], delimiter: char, decimal_comma: bool) -> Vec<usize> {
    let mut counts: Vec<usize> = Vec::new();
    for row in rows {
        for (column, field) in fields(row, delimiter).iter().enumerate() {
            if counts.len() <= column {
                counts.resize(column + 1, 0);
            }
            let is_number = number(field, decimal_comma).is_some();
            counts[column] += usize::from(is_number);
        }
    }
    let enough = MOSTLY * rows.len() as f64;
    let numbers = counts
        .iter()
        .enumerate()
        .filter(|(_, count)| **count as f64 >= enough);
    numbers.map(|(column, _)| column).collect()
}

#[cfg(test)]
#[path = "tests/dialect.rs"]
mod tests;
