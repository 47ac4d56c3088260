//! Speeds, times and lists of speeds as a user writes them.

use crate::error::StudyError;
use hertzchain_experiment::units::{parse_quantity, parse_unit};

/// Most speeds in one sweep.
const MOST_SPEEDS: usize = 100_000;

fn refused<T>(why: String) -> Result<T, StudyError> {
    Err(StudyError::Refused(why))
}

/// A speed in m/s from "0.5", "0.5 m/s" or "500 mm/s".
///
/// # Errors
/// What is wrong with the text.
pub fn parse_speed(text: &str) -> Result<f64, StudyError> {
    let expected =
        ["a number with a unit, such as \"0.5 m/s\"", "a speed such as 0.5 or \"0.5 m/s\""];
    parse_positive(text, ("speed", "m/s"), expected)
}

/// A time in s from "1e-3", "2 ms" or "1 us".
///
/// # Errors
/// What is wrong with the text.
pub fn parse_time(text: &str) -> Result<f64, StudyError> {
    parse_positive(text, ("time", "s"), ["a time, such as \"2 ms\"", "a time such as \"2 ms\""])
}

/// A positive quantity without a unit or with one of the dimension of `unit`.
fn parse_positive(
    text: &str,
    (what, unit): (&str, &str),
    [expected, quantity]: [&str; 2],
) -> Result<f64, StudyError> {
    let text = text.trim();
    let found = parse_quantity(text)
        .or_else(|error| refused(format!("`{text}`: {error}; expected {expected}")))?;
    let fits = |unit: &str| {
        parse_unit(unit).is_ok_and(|unit| found.dimension.agrees_with(&unit.dimension))
    };
    match found.value {
        _ if !(fits("1") && !text.ends_with('%') || fits(unit)) => {
            refused(format!("`{text}` is {}, not {quantity}", found.dimension.name()))
        }
        value if value > 0.0 => Ok(value),
        value => refused(format!("a {what} of {value} {unit} is not positive")),
    }
}

/// Speeds in m/s from "0.1, 0.2, 0.5 m/s", "0.075:1.23:25" (equal steps) or
/// "log:0.075:1.23:25" (equal ratios); members of a list may be ranges.
///
/// # Errors
/// What is wrong with the text.
pub fn parse_speeds(text: &str) -> Result<Vec<f64>, StudyError> {
    let mut speeds = Vec::new();
    for member in text.split(',') {
        match member.contains(':') {
            true => speeds.extend(range(member.trim())?),
            false => speeds.push(parse_speed(member)?),
        }
    }
    Ok(speeds)
}

fn range(text: &str) -> Result<Vec<f64>, StudyError> {
    let (logarithmic, ends) = match text.strip_prefix("log:") {
        Some(ends) => (true, ends),
        None => (false, text),
    };
    let parts: Vec<&str> = ends.split(':').collect();
    let &[from, to, count] = parts.as_slice() else {
        return refused(format!(
            "`{text}` is not a range; expected FROM:TO:COUNT, such as 0.075:1.23:25 or log:0.075:1.23:25"
        ));
    };
    let (from, to) = (parse_speed(from)?, parse_speed(to)?);
    let points = count.trim().parse().ok().filter(|n| (2..=MOST_SPEEDS).contains(n));
    let Some(count) = points else {
        return refused(format!(
            "a range has from 2 to {MOST_SPEEDS} speeds, not {}",
            count.trim()
        ));
    };
    let between = |share: f64| match logarithmic {
        true => from * (to / from).powf(share),
        false => from + (to - from) * share,
    };
    let at = |i: usize| match i {
        0 => from,
        // The last is the end itself, not the end as rounding leaves it.
        i if i + 1 == count => to,
        i => between(i as f64 / (count - 1) as f64),
    };
    Ok((0..count).map(at).collect())
}

#[cfg(test)]
#[path = "tests/speeds.rs"]
mod tests;
