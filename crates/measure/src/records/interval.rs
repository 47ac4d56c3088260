//! The sampling interval, from what the file and the options state.

use crate::error::{MeasureError, Result, file_name};
use crate::records::options::ReadOptions;
use std::path::Path;

/// Relative difference of two rates that count as the same: exports round intervals to four
/// digits.
const SAME_RATE: f64 = 1e-3;

/// Intervals that a recorder can have, in s: from a picosecond to a quarter of an hour.
const POSSIBLE_S: std::ops::RangeInclusive<f64> = 1e-12..=1e3;

/// Relative error of an interval from which on a note reports it: a nanosecond in a hundred
/// microseconds.
const NOTED: f64 = 1e-5;

/// The intervals between samples, in s, that a column of times allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FromTimes {
    pub least_s: f64,
    pub most_s: f64,
    /// Rounding or jitter of the times: mostly the worth of their last digit.
    pub even_to_s: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SampleInterval {
    pub s: f64,
    pub error_s: f64,
    pub note: Option<String>,
}

impl SampleInterval {
    pub(super) fn exact(s: f64) -> Self {
        Self { s, error_s: 0.0, note: None }
    }
}

/// Sampling interval in s, from what the file states and the options say.
pub(crate) fn interval_s(file: &Path, stated_s: Option<f64>, options: &ReadOptions) -> Result<f64> {
    let given_s = options.rate_hz.map(f64::recip);
    let refused = |detail: String| MeasureError::Rate(file_name(file), detail);
    let interval_s = match (stated_s, given_s) {
        (Some(stated), Some(given)) if !options.trust_rate => agreed(file, stated, given)?,
        (_, Some(given)) => given,
        (Some(stated), None) => stated,
        (None, None) => {
            let detail = "does not say how fast it was sampled; give the rate, such as --rate 1MHz";
            return Err(refused(detail.to_owned()));
        }
    };
    match POSSIBLE_S.contains(&interval_s) {
        true => Ok(interval_s),
        false => Err(refused(format!(
            "a sampling interval of {interval_s:e} s is impossible: recorders have 1 ps to 1000 s"
        ))),
    }
}

/// Sampling interval from a column of times, from a header line, and from the options.
///
/// A rate that is given or stated counts if the times allow it. Else it is the roundest one that
/// they allow, if it has at most two digits: recorders have such rates, and one in a hundred
/// intervals has one near it by chance. Else it is the middle of what they allow.
pub(crate) fn from_times(
    file: &Path,
    times: &FromTimes,
    stated_s: Option<f64>,
    options: &ReadOptions,
) -> Result<SampleInterval> {
    let middle_s = 0.5 * (times.least_s + times.most_s);
    if let Some(given_s) = options.rate_hz.map(f64::recip) {
        return match times.allow(given_s) {
            true => Ok(SampleInterval::exact(given_s)),
            false => agreed(file, middle_s, given_s).map(SampleInterval::exact),
        };
    }
    if let Some(stated_s) = stated_s.filter(|stated_s| *stated_s > 0.0 && times.allow(*stated_s)) {
        return Ok(SampleInterval::exact(stated_s));
    }
    if times.least_s <= 0.0 {
        if middle_s < 0.0 {
            let detail = "its times fall; expected times that rise".to_owned();
            return Err(MeasureError::Rate(file_name(file), detail));
        }
        let detail = format!(
            "its times go by steps of {:.3} µs, too coarse to show how fast it was sampled; give \
             the rate, such as --rate 1MHz",
            times.even_to_s * 1e6
        );
        return Err(MeasureError::Rate(file_name(file), detail));
    }
    let round_s = times.round_s();
    let s = round_s.unwrap_or(middle_s);
    // The range is a uniform distribution.
    let off_s = (times.most_s - s).max(s - times.least_s);
    let error_s = off_s / 3.0_f64.sqrt();
    let coarse = (error_s > NOTED * s).then(|| coarse(times, s, off_s, round_s.is_some()));
    let stated_s = stated_s.filter(|stated_s| *stated_s > 0.0);
    let note = coarse.or_else(|| stated_s.map(|stated_s| other_interval(stated_s, s)));
    Ok(SampleInterval { s: interval_s(file, Some(s), options)?, error_s, note })
}

impl FromTimes {
    fn allow(&self, interval_s: f64) -> bool {
        let slack = 1e-9 * interval_s;
        (self.least_s - slack..=self.most_s + slack).contains(&interval_s)
    }

    /// The interval with one digit within the range, as a rate or as a time; else with two.
    fn round_s(&self) -> Option<f64> {
        let middle_s = 0.5 * (self.least_s + self.most_s);
        let mut rounded = [0, 1].into_iter().flat_map(|more| {
            let rate_hz = to_digits(middle_s.recip(), more);
            [rate_hz.recip(), to_digits(middle_s, more)]
        });
        rounded.find(|interval_s| self.allow(*interval_s))
    }
}

fn to_digits(value: f64, more: usize) -> f64 {
    format!("{value:.more$e}").parse().unwrap_or(f64::NAN)
}

/// The note on two intervals that a file states.
pub(crate) fn other_interval(stated_s: f64, taken_s: f64) -> String {
    let [stated_us, taken_us] = [stated_s, taken_s].map(|s| to_digits(1e6 * s, 4));
    format!(
        "it states an interval between samples of {stated_us} µs and one of {taken_us} µs, which was \
         taken; --rate with --trust-rate takes another"
    )
}

/// The note on times of few digits. The share has one digit, so that similar records share it.
fn coarse(times: &FromTimes, interval_s: f64, off_s: f64, is_round: bool) -> String {
    let percent = to_digits(100.0 * off_s / interval_s, 0);
    let even_to_us = to_digits(1e6 * times.even_to_s, 1);
    let taken = match is_round {
        true => format!(
            "{} kHz, the roundest rate that fits, was taken",
            to_digits(1e-3 / interval_s, 5)
        ),
        false => "the middle of what fits was taken".to_owned(),
    };
    format!(
        "times are even only to {even_to_us} µs, which leaves the interval between samples uncertain by \
         up to {percent} %; {taken}, and stated errors hold the rest; --rate states it exactly"
    )
}

/// The note where times without a unit were taken as seconds, and no rate confirms it.
pub(crate) fn seconds_assumed(
    name: &str,
    unit_s: Option<f64>,
    options: &ReadOptions,
) -> Option<String> {
    let is_known = unit_s.or(options.time_unit_s).or(options.rate_hz).is_some();
    let called = match name {
        "" => "its first column".to_owned(),
        name => format!("{name:?}"),
    };
    (!is_known).then(|| {
        format!("{called} names no unit and was taken as times in s; --time-unit us says another")
    })
}

/// The option's interval, which is exact where an export rounds.
fn agreed(file: &Path, stated_s: f64, given_s: f64) -> Result<f64> {
    if (stated_s - given_s).abs() <= SAME_RATE * given_s {
        return Ok(given_s);
    }
    let detail = format!(
        "was sampled at {} Hz by its own account, not at {} Hz; leave the rate out, or insist on \
         yours with --trust-rate",
        stated_s.recip(),
        given_s.recip()
    );
    Err(MeasureError::Rate(file_name(file), detail))
}

#[cfg(test)]
#[path = "tests/interval.rs"]
mod tests;
