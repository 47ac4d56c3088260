//! Delimiter, decimal sign and columns of a text; its fields as numbers.

use super::{LineEnding, Lines, as_text};
use std::borrow::Cow;
use std::io;
use std::path::Path;

const BEGINNING: usize = 1 << 18;

const ROWS: usize = 60;

const FIRST_ROWS: usize = 3;

/// Share of rows in which a column must hold a number to be one of numbers.
const MOSTLY: f64 = 0.8;

/// Weight of a number with marks between its thousands, or with zeros before its digits: a dialect
/// that reads it without any comes first.
const GROUPED: f64 = 0.99;

/// Delimiters in the order of preference; a comma may be a decimal one.
const DELIMITERS: [char; 5] = [';', '\t', '|', ',', ' '];

/// Cells where a recorder had a voltage beyond its range; with a minus sign below it.
const OVERLOADS: &[&str] = &[
    "overload",
    "overrange",
    "over range",
    "overflow",
    "over",
    "ovl",
    "ovld",
    "ovrl",
    "ovf",
    "ol",
    "o.l.",
    "clipped",
    "1.#inf",
    "∞",
];

/// Cells where a program had no number.
const MISSING: &[&str] = &[
    "", "-", "--", "---", "n/a", "na", "#n/a", "null", "none", "missing", "#num!", "#value!",
    "#div/0!", "1.#qnan", "1.#ind", "-1.#ind", "-1.#qnan",
];

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Dialect {
    pub delimiter: char,
    pub decimal_comma: bool,
    /// Columns that hold numbers.
    pub columns: Vec<usize>,
    /// Lines before the first row of numbers.
    pub first_row: usize,
}

impl Dialect {
    /// The dialect in which most of the rows' fields are numbers.
    pub(super) fn of(beginning: &str) -> Option<Self> {
        let lines = beginning.lines().filter(|line| !line.trim().is_empty());
        let lines: Vec<&str> = lines.collect();
        // The end of the beginning: preambles are over by then.
        let rows = lines.len().div_ceil(2).min(ROWS);
        let rows = lines.get(lines.len() - rows..)?;
        let signs = [false, true].into_iter();
        let dialects = signs.flat_map(|comma| DELIMITERS.map(|delimiter| (delimiter, comma)));
        let shares =
            dialects.map(|(delimiter, comma)| (share(rows, delimiter, comma), delimiter, comma));
        // The first of equals.
        let best = shares.reduce(|best, next| if next.0 > best.0 { next } else { best });
        let (_, delimiter, decimal_comma) = best.filter(|best| best.0 > 0.0)?;
        let mut dialect = Self { delimiter, decimal_comma, columns: Vec::new(), first_row: 0 };
        let cells: Vec<_> = rows.iter().map(|row| dialect.fields(row)).collect();
        let widest = cells.iter().map(Vec::len).max().unwrap_or(0);
        let is_number = |column: usize| {
            let number = |row: &&Vec<Cow<'_, str>>| dialect.value(row, column).is_some();
            cells.iter().filter(number).count() as f64 >= MOSTLY * rows.len() as f64
        };
        dialect.columns = (0..widest).filter(|column| is_number(*column)).collect();
        // A line of the preamble may look like a row, several do not.
        let are: Vec<bool> = beginning.lines().map(|line| dialect.is_row(line)).collect();
        let several = |at: &usize| are[*at..are.len().min(at + FIRST_ROWS)].iter().all(|is| *is);
        let first = (0..are.len()).find(several).or(are.iter().position(|is| *is));
        dialect.first_row = first.filter(|_| !dialect.columns.is_empty())?;
        Some(dialect)
    }

    pub(super) fn fields<'a>(&self, line: &'a str) -> Vec<Cow<'a, str>> {
        fields(line, self.delimiter)
    }

    pub(super) fn value(&self, row: &[Cow<'_, str>], column: usize) -> Option<f64> {
        number(row.get(column)?, self.decimal_comma)
    }

    fn is_row(&self, line: &str) -> bool {
        let row = self.fields(line);
        let mut columns = self.columns.iter();
        columns.all(|column| self.value(&row, *column).is_some())
    }
}

fn share(rows: &[&str], delimiter: char, decimal_comma: bool) -> f64 {
    let (mut numbers, mut all) = (0.0, 0.0);
    for row in rows {
        let fields = fields(row, delimiter);
        for field in fields.iter().filter(|field| !field.is_empty()) {
            all += 1.0;
            numbers += match plain(field, decimal_comma) {
                Some(_) if !has_leading_zero(field) => 1.0,
                Some(_) => GROUPED,
                None if number(field, decimal_comma).is_some() => GROUPED,
                None => 0.0,
            };
        }
    }
    if all > 0.0 { numbers / all } else { 0.0 }
}

/// Whether a zero stands before other digits, as after a decimal comma that was taken for a delimiter.
fn has_leading_zero(field: &str) -> bool {
    matches!(field.as_bytes(), [b'0', next, ..] if next.is_ascii_digit())
}

/// The lines at the beginning of a file, whole ones if there are any, each ended by LF.
pub(super) fn beginning(file: &Path) -> io::Result<String> {
    let mut lines = Lines::open(file)?;
    let (mut all, mut line) = (String::new(), Vec::new());
    while all.len() < BEGINNING {
        let ending = lines.next(&mut line)?;
        let goes_on = ending == LineEnding::Begun && !all.is_empty();
        if ending == LineEnding::Nothing || goes_on && all.len() + line.len() > BEGINNING {
            break;
        }
        line.truncate(BEGINNING);
        all += &as_text(&line);
        all.push('\n');
    }
    Ok(all)
}

/// The fields of a line. Spaces separate in runs; quotes keep delimiters.
pub(super) fn fields(line: &str, delimiter: char) -> Vec<Cow<'_, str>> {
    if delimiter == ' ' {
        return line.split_whitespace().map(Cow::Borrowed).collect();
    }
    if !line.contains('"') {
        let fields = line.split(delimiter);
        return fields.map(|field| Cow::Borrowed(field.trim())).collect();
    }
    let mut fields = vec![String::new()];
    let mut quoted = false;
    for letter in line.chars() {
        if letter == '"' {
            quoted = !quoted;
        } else if letter == delimiter && !quoted {
            fields.push(String::new());
        } else if let Some(last) = fields.last_mut() {
            last.push(letter);
        }
    }
    let trimmed = fields.iter().map(|field| field.trim().to_owned());
    trimmed.map(Cow::Owned).collect()
}

/// A number with a decimal point, or with a decimal comma; thousands may be apart by a comma or
/// a point, whichever the decimal sign is not, a space or an apostrophe. A time of day is one.
pub(super) fn number(text: &str, decimal_comma: bool) -> Option<f64> {
    plain(text, decimal_comma)
        .or_else(|| plain(&ungrouped(text, decimal_comma)?, decimal_comma))
        .or_else(|| time_of_day_s(text))
}

fn plain(text: &str, decimal_comma: bool) -> Option<f64> {
    // No number begins with other letters; the parser takes its time to say so.
    let first = text.bytes().next()?;
    if !(first.is_ascii_digit() || b"+-.,nNiI".contains(&first)) {
        return None;
    }
    match decimal_comma {
        false => text.parse().ok(),
        true if text.contains('.') => None,
        true => text.replace(',', ".").parse().ok(),
    }
}

/// A number without what stands between its thousands, if anything does.
fn ungrouped(text: &str, decimal_comma: bool) -> Option<String> {
    let (sign, other) = match decimal_comma {
        true => (',', '.'),
        false => ('.', ','),
    };
    let end = text.find([sign, 'e', 'E']).unwrap_or(text.len());
    let (whole, rest) = text.split_at(end);
    let digits = whole.trim_start_matches(['+', '-']);
    let mark = digits.chars().find(|letter| !letter.is_ascii_digit())?;
    let known = mark == other || matches!(mark, ' ' | '\u{a0}' | '\u{202f}' | '\'' | '’');
    let mut groups = digits.split(mark);
    let first = groups.next()?;
    let leads = (1..=3).contains(&first.len()) && !first.starts_with('0');
    let three = |group: &str| group.len() == 3 && group.bytes().all(|b| b.is_ascii_digit());
    (known && leads && groups.all(three)).then(|| whole.replace(mark, "") + rest)
}

/// `12:00:00.000001`, with a date before it or without, in s since midnight, or since that before
/// the month began: double precision has no more digits than nanoseconds of a month need. Hours
/// and minutes alone are none.
pub(super) fn time_of_day_s(text: &str) -> Option<f64> {
    let text = text.trim_matches('"').trim();
    if text.len() > 40 || text.matches(':').count() < 2 {
        return None;
    }
    let (date, clock) = text.rsplit_once([' ', 'T']).unwrap_or(("", text));
    let clock = clock.trim_end_matches('Z');
    let clock = clock.split_once('+').map_or(clock, |(clock, _zone)| clock);
    let mut parts = clock.splitn(3, ':');
    let whole = |text: &str, most: u32| text.parse().ok().filter(|n: &u32| *n <= most);
    let hours = whole(parts.next()?, 24)?;
    let minutes = whole(parts.next()?, 59)?;
    let seconds = parts.next()?;
    let is_digit = |letter: char| letter.is_ascii_digit();
    let digits = |letter: char| is_digit(letter) || letter == '.' || letter == ',';
    if !seconds.starts_with(is_digit) || !seconds.chars().all(digits) {
        return None;
    }
    let seconds: f64 = seconds.replace(',', ".").parse().ok()?;
    let day = match date {
        "" => 0,
        date => day_of_month(date)?,
    };
    let minutes = 60 * (24 * day + hours) + minutes;
    (seconds < 61.0).then(|| f64::from(60 * minutes) + seconds)
}

/// Of year-month-day, also with slashes; 0 of other orders, which leave it open.
fn day_of_month(date: &str) -> Option<u32> {
    let parts: Vec<&str> = date.trim().split(['-', '/', '.']).collect();
    let numbers: Option<Vec<u32>> = parts.iter().map(|part| part.parse().ok()).collect();
    match numbers?[..] {
        [_, _, day] if parts[0].len() == 4 && day <= 31 => Some(day),
        [_, _, _] => Some(0),
        _ => None,
    }
}

/// Infinity of a cell beyond the range, NaN of one without a number.
pub(super) fn no_number(text: &str) -> Option<f64> {
    let text = text.trim_matches('"').to_lowercase();
    let below = text.strip_prefix('-').map_or("", str::trim);
    if OVERLOADS.contains(&text.trim_start_matches('+')) {
        Some(f64::INFINITY)
    } else if OVERLOADS.contains(&below) || text == "underrange" || text == "underflow" {
        Some(f64::NEG_INFINITY)
    } else {
        MISSING.contains(&text.as_str()).then_some(f64::NAN)
    }
}

/// The worth of the last digit of a number: 1e-5 of 0.00012, 1e-9 of 1.5e-8.
pub(super) fn last_digit(text: &str, decimal_comma: bool) -> f64 {
    let sign = match text.contains(':') {
        true if text.contains(',') => ',',
        true => '.',
        false if decimal_comma => ',',
        false => '.',
    };
    let (digits, power) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let behind = digits.split_once(sign).map_or(0, |(_, behind)| behind.len());
    let power: i32 = power.parse().unwrap_or(0);
    10.0_f64.powi(power.saturating_sub(i32::try_from(behind).unwrap_or(i32::MAX)))
}

/// A number at the beginning of a text and what follows: "1.5 MS/s".
pub(super) fn leading_number(text: &str, decimal_comma: bool) -> Option<(f64, &str)> {
    let text = text.trim_start_matches([' ', ':', '=', '"', ';', ',', '\t']);
    let ends = text.char_indices().map(|(at, letter)| at + letter.len_utf8());
    let parsed = ends.filter_map(|end| {
        let (head, tail) = text.split_at(end);
        let is_whole = head.ends_with(|letter: char| letter.is_ascii_digit() || letter == '.');
        let value = plain(head, decimal_comma).filter(|_| is_whole)?;
        Some((value, tail))
    });
    // Numbers are short; a long text is no number.
    parsed.take(32).last()
}

#[cfg(test)]
#[path = "tests/field.rs"]
mod field_tests;
#[cfg(test)]
#[path = "tests/dialect.rs"]
mod tests;
