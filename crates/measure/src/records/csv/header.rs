//! What the lines before and beside the numbers say: names, units, rate.

use super::dialect::Dialect;
use super::even;
use super::field::{fields, is_time_of_day, last_digit, leading_number, number};
use super::times::Printed;

/// What is known of the columns.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Header {
    /// Columns that are channels.
    pub channels: Vec<usize>,
    /// Their names.
    pub names: Vec<String>,
    /// Column of times and what one of its units is in s, if anything says.
    pub time: Option<(usize, Option<f64>)>,
    /// Its title.
    pub time_name: String,
    /// Its unit, if one is named that nobody here knows.
    pub strange_unit: Option<String>,
    /// Sampling interval in s that a line states.
    pub interval_s: Option<f64>,
}

/// How seconds are called.
const SECONDS: &[&str] = &[
    "s", "sec", "secs", "second", "seconds", "sekunde", "sekunden", "seconde", "secondes",
    "segundos",
];

/// What stands before them, and what it makes of them.
const PREFIXES: &[(&str, f64)] = &[
    ("", 1.0),
    ("m", 1e-3),
    ("milli", 1e-3),
    ("u", 1e-6),
    ("µ", 1e-6),
    ("μ", 1e-6),
    ("micro", 1e-6),
    ("mikro", 1e-6),
    ("n", 1e-9),
    ("nano", 1e-9),
];

/// What one of a unit of time is in s, in whatever way that is written.
fn seconds(unit: &str) -> Option<f64> {
    let unit = unit.trim().trim_end_matches('.').to_lowercase();
    let of = |name: &&str| look_up(PREFIXES, unit.strip_suffix(*name)?);
    SECONDS.iter().find_map(of)
}

/// Units of rates in Hz.
const RATES: &[(&str, f64)] = &[
    ("hz", 1.0),
    ("s/s", 1.0),
    ("sa/s", 1.0),
    ("khz", 1e3),
    ("ks/s", 1e3),
    ("ksa/s", 1e3),
    ("mhz", 1e6),
    ("ms/s", 1e6),
    ("msa/s", 1e6),
    ("ghz", 1e9),
    ("gs/s", 1e9),
    ("gsa/s", 1e9),
];

/// How columns of times are called.
const TIME_NAMES: &[&str] = &[
    "t", "time", "times", "zeit", "temps", "tiempo", "x-axis", "x",
];
/// How columns that count are called.
const INDEX_NAMES: &[&str] = &[
    "#", "n", "no", "nr", "index", "sample", "samples", "point", "sequence",
];
/// How intervals are called; the first that a line begins with counts.
const INTERVALS: &[&str] = &[
    "sample interval",
    "sampling interval",
    "sample period",
    "sampling period",
    "horizontal interval",
    "x increment",
    "xincr",
    "increment",
    "interval",
    "delta(second)",
    "delta_x",
    "delta x",
    "time resolution",
    "dt",
    "abtastintervall",
];
/// How rates are called.
const RATES_CALLED: &[&str] = &[
    "sample rate",
    "sampling rate",
    "samplerate",
    "sampling frequency",
    "sample frequency",
    "rate",
    "fs",
    "abtastrate",
];

impl Header {
    /// Reads the lines before the first row, and what stands beside the first rows. What
    /// counts is times if `counts_time`.
    pub(super) fn of(beginning: &str, dialect: &Dialect, counts_time: bool) -> Self {
        let rows = sampled(beginning, dialect);
        let (names, units) = titles(beginning, dialect, rising(&rows, 0) == Some(1.0));
        let title = |column: usize| names.get(column).map_or("", String::as_str);
        let named_unit = |column: usize| {
            let own = bracketed(title(column)).or_else(|| within(title(column)));
            own.or_else(|| units.get(column).cloned())
        };
        let unit = |column: usize| named_unit(column).and_then(|unit| seconds(&unit));
        let is_time = |column: usize| called(TIME_NAMES, title(column)) || unit(column).is_some();
        let first = dialect.columns.first().copied();
        let counts = |column: usize| called(INDEX_NAMES, title(column));
        let several = dialect.columns.len() > 1;
        let mut time = dialect.columns.iter().copied().find(|c| is_time(*c));
        let mut index = dialect.columns.iter().copied().find(|c| counts(*c));
        // No signal rises evenly, whatever its title.
        if let Some(first) = first.filter(|_| time.or(index).is_none() && several) {
            match rising(&rows, 0) {
                Some(1.0) => index = Some(first),
                Some(_) => time = Some(first),
                None if even::rises(&risen(beginning, dialect, first)) => time = Some(first),
                None => {}
            }
        }
        if counts_time && time.is_none() {
            time = index.take();
        }
        let time = time.filter(|_| several);
        let index = index.filter(|_| several);
        let channel = |c: &usize| Some(*c) != time && Some(*c) != index;
        let channels: Vec<usize> = dialect.columns.iter().copied().filter(channel).collect();
        let names = channels.iter().enumerate().map(|(number, column)| {
            let name = plain(title(*column));
            if name.is_empty() {
                (number + 1).to_string()
            } else {
                name
            }
        });
        Self {
            names: names.collect(),
            channels,
            time: time.map(|column| {
                let unit = || unit(column).or_else(|| ending(title(column)));
                let seconds = of_day(beginning, dialect, column).then_some(1.0);
                (column, seconds.or_else(unit))
            }),
            strange_unit: time
                .and_then(named_unit)
                .filter(|unit| !unit.is_empty() && seconds(unit).is_none())
                .filter(|_| !time.is_some_and(|column| of_day(beginning, dialect, column))),
            time_name: time.map_or(String::new(), |column| plain(title(column))),
            interval_s: stated_s(beginning, dialect),
        }
    }
}

/// Lines that are looked at for what is beside the numbers.
const BESIDE: usize = 40;

/// The first rows of numbers.
fn sampled(beginning: &str, dialect: &Dialect) -> Vec<Vec<f64>> {
    let row = |line: &str| {
        let fields = fields(line, dialect.delimiter);
        let value = |column: &usize| number(fields.get(*column)?, dialect.decimal_comma);
        dialect
            .columns
            .iter()
            .map(value)
            .collect::<Option<Vec<_>>>()
    };
    let lines = beginning.lines().skip(dialect.first_row);
    lines.take(BESIDE).map_while(row).collect()
}

/// Whether a column holds times of day, which are in seconds whatever its title says.
fn of_day(beginning: &str, dialect: &Dialect, column: usize) -> bool {
    let row = beginning.lines().nth(dialect.first_row);
    row.is_some_and(|row| {
        let fields = fields(row, dialect.delimiter);
        fields
            .get(column)
            .is_some_and(|field| is_time_of_day(field))
    })
}

/// The even step of a column that rises as times or numbers do.
fn rising(rows: &[Vec<f64>], column: usize) -> Option<f64> {
    let values: Vec<f64> = rows
        .iter()
        .filter_map(|row| row.get(column).copied())
        .collect();
    let (first, last) = (values.first()?, values.last()?);
    let step = (last - first) / (values.len().checked_sub(1)? as f64);
    let even = |(i, value): (usize, &f64)| (value - first - i as f64 * step).abs() <= 0.5 * step;
    (values.len() > 2 && step > 0.0 && values.iter().enumerate().all(even)).then_some(step)
}

/// A column until it falls, with its digits: times of few digits repeat.
fn risen(beginning: &str, dialect: &Dialect, column: usize) -> Vec<Printed> {
    let printed = |line: &str| {
        let fields = fields(line, dialect.delimiter);
        let field = fields.get(column)?;
        Some(Printed {
            s: number(field, dialect.decimal_comma)?,
            unit_s: last_digit(field, dialect.decimal_comma),
        })
    };
    let lines = beginning.lines().skip(dialect.first_row);
    let mut last_s = f64::NEG_INFINITY;
    let rows = lines.map_while(printed);
    rows.take_while(|time| time.s >= std::mem::replace(&mut last_s, time.s))
        .collect()
}

/// A line without the mark of a comment before it. Where the first column counts, a
/// mark that stands for itself may be its title.
fn unmarked<'a>(line: &'a str, dialect: &Dialect, counts: bool) -> &'a str {
    let Some(rest) = line.trim_start().strip_prefix(['#', '%']) else {
        return line;
    };
    let alone = rest.trim_start_matches(' ').starts_with(dialect.delimiter);
    let spaced = dialect.delimiter == ' ' && rest.starts_with(' ');
    match alone || (counts && spaced) {
        true => line,
        false => rest.trim_start_matches(['#', '%', ' ']),
    }
}

/// Names and units: the last lines before the numbers that have as many fields.
fn titles(beginning: &str, dialect: &Dialect, counts: bool) -> (Vec<String>, Vec<String>) {
    let wide = dialect.columns.last().map_or(0, |last| last + 1);
    let lines = beginning.lines().take(dialect.first_row);
    let split = |line: &str| -> Vec<String> {
        let fields = fields(unmarked(line, dialect, counts), dialect.delimiter);
        fields.into_iter().map(|field| field.into_owned()).collect()
    };
    let mut lines: Vec<Vec<String>> = lines
        .filter(|line| !line.trim().is_empty())
        .map(split)
        .filter(|fields| fields.len() >= wide)
        .collect();
    let Some(last) = lines.pop() else {
        return Default::default();
    };
    let filled = || last.iter().filter(|field| !field.is_empty());
    if filled().all(|field| is_unit(field)) && filled().count() > 0 {
        let bare = |field: &String| bracketed(field).unwrap_or_else(|| field.clone());
        let units = last.iter().map(bare).collect();
        return (lines.pop().unwrap_or_default(), units);
    }
    (last, Vec::new())
}

fn is_unit(field: &str) -> bool {
    const VOLTS: &[&str] = &["v", "mv", "µv", "uv", "volt", "volts"];
    let inside = |open, close| field.strip_prefix(open)?.strip_suffix(close);
    let bare = inside('(', ')').or_else(|| inside('[', ']'));
    let whole = bare.unwrap_or(field).to_lowercase();
    bare.is_some() || seconds(&whole).is_some() || VOLTS.contains(&whole.as_str())
}

/// What stands in brackets at the end: "Time (ms)" is in ms.
fn bracketed(text: &str) -> Option<String> {
    let text = text.trim();
    let inside = text.strip_suffix([')', ']'])?;
    let at = inside.rfind(['(', '['])?;
    Some(inside[at + 1..].trim().to_owned())
}

/// What stands after "in": "Zeit in ms" is in ms.
fn within(text: &str) -> Option<String> {
    let (_, unit) = text.rsplit_once(" in ")?;
    Some(unit.trim().to_owned())
}

/// A title without its unit.
fn plain(title: &str) -> String {
    let end = match bracketed(title) {
        Some(_) => title.rfind(['(', '[']).unwrap_or(title.len()),
        None => title.len(),
    };
    title[..end].trim().to_owned()
}

fn called(names: &[&str], title: &str) -> bool {
    let title = plain(title).to_lowercase();
    let stem = title.rsplit_once(" in ").or_else(|| {
        title
            .rsplit_once(APART)
            .filter(|_| ending(&title).is_some())
    });
    let is_named = |name: &str| names.contains(&name.trim());
    is_named(&title) || stem.is_some_and(|(stem, _)| is_named(stem))
}

/// What keeps a name and its unit apart.
const APART: [char; 4] = ['_', '/', ' ', ','];

/// The unit that a title ends in: "time_us", "t/ms".
fn ending(title: &str) -> Option<f64> {
    seconds(title.rsplit_once(APART)?.1)
}

fn look_up(units: &[(&str, f64)], unit: &str) -> Option<f64> {
    let unit = unit.trim().to_lowercase();
    let found = units.iter().find(|known| known.0 == unit);
    found.map(|known| known.1)
}

/// The interval that a line before or beside the numbers states.
fn stated_s(beginning: &str, dialect: &Dialect) -> Option<f64> {
    let lines = beginning.lines().take(dialect.first_row.max(BESIDE));
    let beside = lines.clone().find_map(|line| line_states_s(line, dialect));
    let mut pairs = lines.clone().zip(lines.skip(1));
    beside.or_else(|| pairs.find_map(|(titles, values)| below_s(titles, values, dialect)))
}

/// The interval that stands under its title.
fn below_s(titles: &str, values: &str, dialect: &Dialect) -> Option<f64> {
    let called = |title: &str| INTERVALS.contains(&title.to_lowercase().as_str());
    let titles = fields(titles, dialect.delimiter);
    let at = titles.iter().position(|title| called(title))?;
    number(
        fields(values, dialect.delimiter).get(at)?,
        dialect.decimal_comma,
    )
}

fn line_states_s(line: &str, dialect: &Dialect) -> Option<f64> {
    let line = line.trim_start_matches(['#', '"', '%', ' ', '\t']);
    let lower = line.to_lowercase();
    let after = |names: &[&str]| {
        let name = names.iter().find(|name| lower.starts_with(*name))?;
        line.get(name.len()..)
    };
    if let Some(rest) = after(INTERVALS) {
        let (value, unit) = quantity(rest, dialect)?;
        return Some(value * seconds(&unit).unwrap_or(1.0));
    }
    let (value, unit) = quantity(after(RATES_CALLED)?, dialect)?;
    Some((value * look_up(RATES, &unit).unwrap_or(1.0)).recip())
}

/// A value and its unit, which stands after it or in brackets before.
fn quantity(rest: &str, dialect: &Dialect) -> Option<(f64, String)> {
    let rest = rest.trim();
    let (before, rest) = match rest.strip_prefix(['(', '[']) {
        Some(open) => open.split_once([')', ']'])?,
        None => ("", rest),
    };
    let (value, tail) =
        leading_number(rest, dialect.decimal_comma).or_else(|| leading_number(rest, false))?;
    let tail = tail.trim_start_matches([dialect.delimiter, ' ', '"', '\t']);
    let unit = tail.split([dialect.delimiter, ' ', '"', '\t']).next()?;
    let unit = if unit.is_empty() { before } else { unit };
    Some((value, unit.trim_matches(['(', ')', '[', ']']).to_owned()))
}

#[cfg(test)]
#[path = "tests/header.rs"]
mod tests;
