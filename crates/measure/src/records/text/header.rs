//! Names, units, times and rate, from the lines before the numbers and beside the first of them.

use super::dialect::{Dialect, last_digit, leading_number, number, time_of_day_s};
use super::times::{self, Printed};

const SECONDS: &[&str] = &[
    "s", "sec", "secs", "second", "seconds", "sekunde", "sekunden", "seconde", "secondes",
    "segundos",
];

const PREFIXES: &[(&[&str], f64)] = &[
    (&[""], 1.0),
    (&["m", "milli"], 1e-3),
    (&["u", "µ", "μ", "micro", "mikro"], 1e-6),
    (&["n", "nano"], 1e-9),
];

const RATES: &[&str] = &["hz", "s/s", "sa/s"];
const RATE_PREFIXES: &[(&[&str], f64)] =
    &[(&[""], 1.0), (&["k"], 1e3), (&["m"], 1e6), (&["g"], 1e9)];

/// Units of channels, which show that a line has units.
const VOLTS: &[&str] = &["volts", "volt", "v"];
const VOLT_PREFIXES: &[(&[&str], f64)] =
    &[(&[""], 1.0), (&["k"], 1e3), (&["m", "milli"], 1e-3), (&["u", "µ", "μ", "micro"], 1e-6)];

/// Names of columns of times, and of columns that count.
const TIMES: &[&str] = &["t", "time", "times", "zeit", "temps", "tiempo", "x-axis", "x"];
const COUNTS: &[&str] = &["#", "n", "no", "nr", "index", "sample", "samples", "point", "sequence"];

/// Names of intervals that begin a header line, or stand over their value, a recorder a line:
/// Tektronix, Keysight and LeCroy, Rigol, LabVIEW, others.
#[rustfmt::skip]
const INTERVALS: &[&str] = &[
    "sample interval", "sampling interval", "sample period", "sampling period", "horizontal interval",
    "x increment", "xincr",
    "increment", "interval",
    "hresolution", "delta(second)", "delta_x", "delta x", "time resolution",
    "dt", "abtastintervall",
];

#[rustfmt::skip]
const RATE_NAMES: &[&str] = &[
    "sample rate", "sampling rate", "samplerate", "sampling frequency", "sample frequency", "rate",
    "fs", "clock=", "abtastrate",
];

/// What separates a name and its unit: "time_us", "t/ms".
const APART: [char; 4] = ['_', '/', ' ', ','];

/// Lines that may state the sampling next to numbers, and rows that show what a column is.
const SHOWN: usize = 40;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct TextHeader {
    /// Columns that are channels.
    pub channels: Vec<usize>,
    pub names: Vec<String>,
    /// Volts of one in each channel; 1 where a unit is not stated or no voltage.
    pub scales: Vec<f64>,
    /// Column of times and its unit in s, if stated.
    pub time: Option<(usize, Option<f64>)>,
    pub time_name: String,
    /// Unit of the times that is unknown here.
    pub strange_unit: Option<String>,
    /// Sampling interval in s that a line states.
    pub interval_s: Option<f64>,
}

impl TextHeader {
    /// Reads the lines before the first row and the first rows. A column that counts is one of
    /// times if `counts_are_times`.
    pub(super) fn of(beginning: &str, dialect: &Dialect, counts_are_times: bool) -> Self {
        let first = printed(beginning, dialect);
        let step = even_step(&first);
        let (titles, units) = titles(beginning, dialect, step == Some(1.0));
        let title = |column: usize| titles.get(column).map_or("", String::as_str);
        let unit = |column: usize| {
            let own = split_unit(title(column)).1.map(str::to_owned);
            own.or_else(|| units.get(column).cloned())
        };
        let unit_s = |column: usize| seconds(&unit(column)?);
        let several = dialect.columns.len() > 1;
        let find = |is: &dyn Fn(usize) -> bool| {
            let mut columns = dialect.columns.iter().copied();
            columns.find(|column| several && is(*column))
        };
        let mut time = find(&|c| is_called(TIMES, title(c)) || unit_s(c).is_some());
        let mut count = find(&|c| is_called(COUNTS, title(c)));
        // No signal rises evenly, whatever its title.
        if time.or(count).is_none() && several {
            let rises = step.is_some() || times::rises(&rising(&first));
            let column = dialect.columns.first().copied().filter(|_| rises);
            match step == Some(1.0) {
                true => count = column,
                false => time = column,
            }
        }
        if counts_are_times && time.is_none() {
            time = count.take();
        }
        let mut channels = dialect.columns.clone();
        channels.retain(|column| Some(*column) != time && Some(*column) != count);
        let names = channels.iter().enumerate();
        let names = names.map(|(number, column)| match without_bracket(title(*column)) {
            "" => (number + 1).to_string(),
            name => name.to_owned(),
        });
        let of_day = time.filter(|column| is_time_of_day(beginning, dialect, *column));
        let stated = time.filter(|_| of_day.is_none()).and_then(unit);
        let of_title = |column: usize| volts(title(column).rsplit_once(APART)?.1);
        let scale = |column: &usize| match unit(*column) {
            Some(unit) => volts(&unit),
            None => of_title(*column),
        };
        Self {
            scales: channels.iter().map(|column| scale(column).unwrap_or(1.0)).collect(),
            names: names.collect(),
            channels,
            time: time.map(|column| {
                let stated = || unit_s(column).or_else(|| ending_s(title(column)));
                (column, of_day.map(|_| 1.0).or_else(stated))
            }),
            time_name: without_bracket(time.map_or("", title)).to_owned(),
            strange_unit: stated.filter(|unit| !unit.is_empty() && seconds(unit).is_none()),
            interval_s: stated_s(beginning, dialect),
        }
    }
}

/// A unit of time in s.
pub(crate) fn seconds(unit: &str) -> Option<f64> {
    prefixed(unit.trim().trim_end_matches('.'), SECONDS, PREFIXES)
}

/// A unit of voltage in V.
pub(crate) fn volts(unit: &str) -> Option<f64> {
    prefixed(unit.trim(), VOLTS, VOLT_PREFIXES)
}

fn prefixed(unit: &str, units: &[&str], prefixes: &[(&[&str], f64)]) -> Option<f64> {
    let unit = unit.trim().to_lowercase();
    units.iter().find_map(|known| {
        let prefix = unit.strip_suffix(known)?;
        let found = prefixes.iter().find(|one| one.0.contains(&prefix));
        found.map(|one| one.1)
    })
}

/// The first column of numbers with its digits, from the first row on.
fn printed(beginning: &str, dialect: &Dialect) -> Vec<Printed> {
    let Some(column) = dialect.columns.first() else {
        return Vec::new();
    };
    let one = |line: &str| {
        let fields = dialect.fields(line);
        let field = fields.get(*column)?;
        Some(Printed {
            s: number(field, dialect.decimal_comma)?,
            unit_s: last_digit(field, dialect.decimal_comma),
        })
    };
    let rows = beginning.lines().skip(dialect.first_row);
    rows.map_while(one).collect()
}

/// The step of a column of which the first rows rise evenly.
fn even_step(column: &[Printed]) -> Option<f64> {
    let rows = column.get(..SHOWN).unwrap_or(column);
    let (first, last) = (rows.first()?.s, rows.last()?.s);
    let step = (last - first) / (rows.len().checked_sub(1)? as f64);
    let mut numbered = rows.iter().enumerate();
    let even = numbered.all(|(i, value)| (value.s - first - i as f64 * step).abs() <= 0.5 * step);
    (rows.len() > 2 && step > 0.0 && even).then_some(step)
}

/// A column until it falls: times of few digits repeat.
fn rising(column: &[Printed]) -> Vec<Printed> {
    let mut last_s = f64::NEG_INFINITY;
    let rows = column.iter().copied();
    rows.take_while(|time| time.s >= std::mem::replace(&mut last_s, time.s)).collect()
}

/// Whether a column holds times of day, which are in seconds whatever its title says.
fn is_time_of_day(beginning: &str, dialect: &Dialect, column: usize) -> bool {
    let row = beginning.lines().nth(dialect.first_row).unwrap_or_default();
    let fields = dialect.fields(row);
    let field = fields.get(column);
    field.is_some_and(|field| time_of_day_s(field).is_some())
}

/// Titles and units: the last lines before the numbers that have as many fields.
fn titles(beginning: &str, dialect: &Dialect, counts: bool) -> (Vec<String>, Vec<String>) {
    let wide = dialect.columns.last().map_or(0, |last| last + 1);
    let lines = beginning.lines().take(dialect.first_row);
    let lines = lines.filter(|line| !line.trim().is_empty());
    let split = |line: &str| -> Vec<String> {
        let fields = dialect.fields(without_mark(line, dialect, counts));
        fields.iter().map(ToString::to_string).collect()
    };
    let lines = lines.map(split).filter(|fields| fields.len() >= wide);
    let mut lines: Vec<Vec<String>> = lines.collect();
    let last = lines.pop().unwrap_or_default();
    let mut filled = last.iter().filter(|field| !field.is_empty()).peekable();
    if filled.peek().is_some() && filled.all(|field| is_unit(field)) {
        let bare = |field: &String| split_unit(field).1.unwrap_or(field).to_owned();
        return (lines.pop().unwrap_or_default(), last.iter().map(bare).collect());
    }
    (last, Vec::new())
}

/// A line without the mark of a comment before it. Where the first column counts, a mark that
/// stands for itself may be its title.
fn without_mark<'a>(line: &'a str, dialect: &Dialect, counts: bool) -> &'a str {
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

fn is_unit(field: &str) -> bool {
    let bracketed = field.starts_with(['(', '[']) && field.ends_with([')', ']']);
    bracketed || seconds(field).is_some() || volts(field).is_some()
}

/// Name and unit of a title: "Time (ms)", "Zeit in ms".
fn split_unit(title: &str) -> (&str, Option<&str>) {
    let title = title.trim();
    let bracket = title.strip_suffix([')', ']']);
    let split = bracket.and_then(|inside| inside.rsplit_once(['(', '[']));
    match split.or_else(|| title.rsplit_once(" in ")) {
        Some((name, unit)) => (name.trim(), Some(unit.trim())),
        None => (title, None),
    }
}

fn without_bracket(title: &str) -> &str {
    match title.trim().ends_with([')', ']']) {
        true => split_unit(title).0,
        false => title.trim(),
    }
}

/// Whether a title is one of these names, with a unit or without.
fn is_called(names: &[&str], title: &str) -> bool {
    let title = without_bracket(title).to_lowercase();
    let stem = title.rsplit_once(" in ").or_else(|| {
        let split = title.rsplit_once(APART);
        split.filter(|_| ending_s(&title).is_some())
    });
    names.contains(&&*title) || stem.is_some_and(|(stem, _)| names.contains(&stem.trim()))
}

/// The unit in s that a title ends in: "time_us", "t/ms".
fn ending_s(title: &str) -> Option<f64> {
    seconds(title.rsplit_once(APART)?.1)
}

/// The interval that a line before or beside the numbers states.
fn stated_s(beginning: &str, dialect: &Dialect) -> Option<f64> {
    let lines = beginning.lines().take(dialect.first_row.max(SHOWN));
    let mut pairs = lines.clone().zip(lines.clone().skip(1));
    let beside = lines.clone().find_map(|line| line_states_s(line, dialect));
    beside.or_else(|| pairs.find_map(|(titles, values)| below_s(titles, values, dialect)))
}

fn below_s(titles: &str, values: &str, dialect: &Dialect) -> Option<f64> {
    let titles = dialect.fields(titles);
    let mut names = titles.iter().map(|title| title.to_lowercase());
    let at = names.position(|title| INTERVALS.contains(&&*title))?;
    dialect.value(&dialect.fields(values), at)
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
        return Some(value * seconds(unit).unwrap_or(1.0));
    }
    let (value, unit) = quantity(after(RATE_NAMES)?, dialect)?;
    Some((value * prefixed(unit, RATES, RATE_PREFIXES).unwrap_or(1.0)).recip())
}

/// A value and its unit, which stands after it or in brackets before.
fn quantity<'a>(rest: &'a str, dialect: &Dialect) -> Option<(f64, &'a str)> {
    let rest = rest.trim();
    let (before, rest) = match rest.strip_prefix(['(', '[']) {
        Some(open) => open.split_once([')', ']'])?,
        None => ("", rest),
    };
    let (value, tail) =
        leading_number(rest, dialect.decimal_comma).or_else(|| leading_number(rest, false))?;
    let ends = [dialect.delimiter, ',', ';', ' ', '"', '\t'];
    let unit = tail.trim_start_matches(ends).split(ends).next()?;
    let unit = if unit.is_empty() { before } else { unit };
    Some((value, unit.trim_matches(['(', ')', '[', ']'])))
}

#[cfg(test)]
#[path = "tests/header.rs"]
mod tests;
