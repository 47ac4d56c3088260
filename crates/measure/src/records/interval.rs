//! How fast a file was sampled: what it and the options say together.

use crate::records::error::{RecordError, name};
use crate::records::options::ReadOptions;
use std::path::Path;

/// Relative difference of two rates that are meant to be the same: exports
/// round intervals to four digits.
const SAME_RATE: f64 = 1e-3;

/// Intervals that a recorder can have, in s: from a picosecond to a quarter of an hour.
const POSSIBLE_S: std::ops::RangeInclusive<f64> = 1e-12..=1e3;

/// Relative error of an interval below which nobody need be told: a nanosecond in a hundred
/// microseconds.
const MATTERS: f64 = 1e-5;

/// What a column of times says of the interval between samples, in s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FromTimes {
    /// Least interval that the printed digits allow.
    pub least_s: f64,
    /// Largest interval that they allow.
    pub most_s: f64,
    /// How far times are rounded or jitter: mostly what one of their last digit is.
    pub even_to_s: f64,
}

/// An interval between samples.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Interval {
    /// In s.
    pub s: f64,
    /// Its standard error in s.
    pub error_s: f64,
    /// What is to be told of it.
    pub note: Option<String>,
}

impl Interval {
    /// One that is known.
    pub(super) fn of(s: f64) -> Self {
        Self {
            s,
            error_s: 0.0,
            note: None,
        }
    }
}

/// Sampling interval in s, from what the file states and what the option says.
///
/// # Errors
/// Neither says, they disagree, or the interval is impossible.
pub(crate) fn interval_s(
    file: &Path,
    stated_s: Option<f64>,
    options: &ReadOptions,
) -> Result<f64, RecordError> {
    let given_s = options.rate_hz.map(|rate| rate.recip());
    let interval_s = match (stated_s, given_s) {
        (Some(stated), Some(given)) if !options.trust_rate => agreed(file, stated, given)?,
        (_, Some(given)) => given,
        (Some(stated), None) => stated,
        (None, None) => return Err(RecordError::NoRate { file: name(file) }),
    };
    match POSSIBLE_S.contains(&interval_s) {
        true => Ok(interval_s),
        false => Err(RecordError::ImpossibleRate {
            file: name(file),
            interval_s,
        }),
    }
}

/// Sampling interval from a column of times, from what a line states beside it, and from
/// what the option says.
///
/// A rate that is given or stated counts if the times allow it. Else it is the roundest one
/// that they allow, if it has at most two digits: recorders have such rates, and one in a
/// hundred intervals has one near it by chance. Else it is in the middle of what they allow.
///
/// # Errors
/// The option and the times disagree, or these tell nothing.
pub(crate) fn from_times(
    file: &Path,
    told: &FromTimes,
    stated_s: Option<f64>,
    options: &ReadOptions,
) -> Result<Interval, RecordError> {
    let middle_s = 0.5 * (told.least_s + told.most_s);
    if let Some(rate_hz) = options.rate_hz {
        let given_s = rate_hz.recip();
        return match told.allow(given_s) {
            true => Ok(Interval::of(given_s)),
            false => agreed(file, middle_s, given_s).map(Interval::of),
        };
    }
    if let Some(stated_s) = stated_s.filter(|stated_s| *stated_s > 0.0 && told.allow(*stated_s)) {
        return Ok(Interval::of(stated_s));
    }
    if told.least_s <= 0.0 {
        return Err(RecordError::CoarseTimes {
            file: name(file),
            even_to_s: told.even_to_s,
        });
    }
    let round_s = told.round_s();
    let s = round_s.unwrap_or(middle_s);
    // Any of the range is as likely as any other.
    let error_s = (told.most_s - s).max(s - told.least_s) / 3.0_f64.sqrt();
    let doubtful = error_s > MATTERS * s;
    let note = doubtful.then(|| coarse(told, s, round_s.is_some()));
    let interval_s = interval_s(file, Some(s), options)?;
    Ok(Interval {
        s: interval_s,
        error_s,
        note,
    })
}

impl FromTimes {
    /// Whether an interval is among those, but for rounding.
    fn allow(&self, interval_s: f64) -> bool {
        let slack = 1e-9 * interval_s;
        (self.least_s - slack..=self.most_s + slack).contains(&interval_s)
    }

    /// The interval with one digit among those, as a rate or as a time; else with two.
    fn round_s(&self) -> Option<f64> {
        let middle_s = 0.5 * (self.least_s + self.most_s);
        let rounded = [0, 1].into_iter().flat_map(|more| {
            let rate_hz = to_digits(middle_s.recip(), more);
            [rate_hz.recip(), to_digits(middle_s, more)]
        });
        rounded
            .into_iter()
            .find(|interval_s| self.allow(*interval_s))
    }
}

/// A number with its first digit and so many more.
fn to_digits(value: f64, more: usize) -> f64 {
    format!("{value:.more$e}").parse().unwrap_or(f64::NAN)
}

/// What is told of times of few digits. The share has one digit, so that alike records
/// are told of once.
fn coarse(told: &FromTimes, interval_s: f64, is_round: bool) -> String {
    let share = (told.most_s - interval_s).max(interval_s - told.least_s) / interval_s;
    let percent = to_digits(100.0 * share, 0);
    let even_to_us = to_digits(1e6 * told.even_to_s, 1);
    let taken = match is_round {
        true => format!(
            "{} kHz, the roundest rate that fits, was taken",
            to_digits(1e-3 / interval_s, 5)
        ),
        false => "the middle of what fits was taken".to_owned(),
    };
    format!(
        "times are even only to {even_to_us} µs, which leaves the interval between samples uncertain by \
         up to {percent} %; {taken}, and stated errors hold the rest; --rate tells it exactly"
    )
}

/// What is told where times without a unit were taken for seconds, and no rate
/// was given to hold them against.
pub(crate) fn seconds_taken(
    name: &str,
    unit_s: Option<f64>,
    options: &ReadOptions,
) -> Option<String> {
    let told = unit_s.or(options.time_unit_s).or(options.rate_hz).is_some();
    let called = match name {
        "" => "its first column".to_owned(),
        name => format!("{name:?}"),
    };
    (!told).then(|| {
        format!("{called} names no unit and was taken as times in s; --time-unit us says another")
    })
}

/// The option's interval, which is exact where an export rounds.
fn agreed(file: &Path, stated: f64, given: f64) -> Result<f64, RecordError> {
    match (stated - given).abs() <= SAME_RATE * given {
        true => Ok(given),
        false => Err(RecordError::WrongRate {
            file: name(file),
            stated_hz: stated.recip(),
            given_hz: given.recip(),
        }),
    }
}

#[cfg(test)]
#[path = "tests/interval.rs"]
mod tests;
