//! Times written beside samples: where segments begin, and how far digits tell.

use super::even;
use crate::records::error::RecordError;
use crate::records::interval::FromTimes;
use std::ops::Range;

/// A step so many times the usual one begins a new segment.
const GAP: f64 = 10.0;

/// Rows of the shortest segment: fewer hold no shot.
pub(super) const SHORTEST: usize = 16;

/// Units of the last digit over which a usual step is told: then rounding moves it by a
/// quarter at most.
const TOLD_OVER: f64 = 4.0;

/// A time as it is printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Printed {
    /// In s.
    pub s: f64,
    /// What one of its last digit is, in s.
    pub unit_s: f64,
}

impl Printed {
    /// How far the true time may be off.
    pub(super) fn half_s(&self) -> f64 {
        0.5 * self.unit_s + self.rounding_s()
    }

    /// Rounding of the arithmetic, of the file's writer and ours.
    pub(super) fn rounding_s(&self) -> f64 {
        8.0 * f64::EPSILON * self.s.abs()
    }
}

/// Where times jump back, or ahead by many steps more than their digits hide; nowhere if most of
/// what that leaves is too short.
pub(super) fn segments(times: &[Printed]) -> Vec<Range<usize>> {
    let usual_s = usual_step_s(times);
    let jumps = |at: &usize| {
        let step_s = step_s(times, at - 1);
        let hidden_s = times[at - 1].half_s() + times[*at].half_s();
        step_s < 0.0 || (usual_s > 0.0 && step_s - hidden_s > GAP * usual_s)
    };
    let starts = (1..times.len()).filter(jumps);
    let mut begin = 0;
    let segments = starts.chain([times.len()]);
    let segments: Vec<Range<usize>> = segments
        .map(|end| std::mem::replace(&mut begin, end)..end)
        .collect();
    let short = segments.iter().filter(|part| part.len() < SHORTEST).count();
    match segments.len() > MANY && 2 * short > segments.len() {
        true => std::iter::once(0..times.len()).collect(),
        false => segments,
    }
}

/// More segments than this are looked at for what they are.
const MANY: usize = 3;

/// The even interval of a segment's times.
///
/// # Errors
/// Times that are not finite or not even.
pub(super) fn interval(source: &str, times: &[Printed]) -> Result<FromTimes, RecordError> {
    match times.len() {
        0 => Err(RecordError::Empty {
            source_name: source.to_owned(),
        }),
        1 => Err(RecordError::truncated(
            source.to_owned(),
            "a single sample has no interval",
        )),
        _ => even::interval(times).ok_or_else(|| uneven(source, times)),
    }
}

/// Tells of the step that is least like the usual one.
fn uneven(source: &str, times: &[Printed]) -> RecordError {
    let usual_s = usual_step_s(times);
    let odd = |at: &usize| {
        let odd = (step_s(times, *at) - usual_s).abs();
        if odd.is_nan() { f64::INFINITY } else { odd }
    };
    let steps = 0..times.len().saturating_sub(1);
    let at = steps.max_by(|a, b| odd(a).total_cmp(&odd(b))).unwrap_or(0);
    RecordError::UnevenTimes {
        source_name: source.to_owned(),
        sample: at + 1,
        time_s: times.get(at).map_or(f64::NAN, |time| as_printed(time.s)),
        step_s: step_s(times, at),
        usual_s,
    }
}

/// Without the last digits of double precision, which no file had.
fn as_printed(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

fn step_s(times: &[Printed], at: usize) -> f64 {
    let pair = times.get(at).zip(times.get(at + 1));
    pair.map_or(f64::NAN, |(from, to)| to.s - from.s)
}

/// The step in the middle of all steps by size; 0 without any. Where digits are so few that
/// times repeat, it is told over as many steps as they need.
fn usual_step_s(times: &[Printed]) -> f64 {
    let unit_s = times.iter().fold(0.0, |unit, time| time.unit_s.max(unit));
    let mut over = 1;
    loop {
        let rise_s = usual_rise_s(times, over);
        if rise_s >= TOLD_OVER * unit_s || 8 * over > times.len() {
            return rise_s / over as f64;
        }
        over *= 2;
    }
}

/// The rise over so many steps in the middle of all by size.
fn usual_rise_s(times: &[Printed], over: usize) -> f64 {
    let pairs = times.iter().zip(times.iter().skip(over));
    let mut rises: Vec<f64> = pairs.map(|(from, to)| to.s - from.s).collect();
    let middle = rises.len() / 2;
    match rises.is_empty() {
        true => 0.0,
        false => *rises.select_nth_unstable_by(middle, f64::total_cmp).1,
    }
}

/// Follows times that nobody trusts, for where they begin anew.
#[derive(Debug, Default)]
pub(super) struct Returns {
    /// First and last time of the segment under way, if they only rose so far.
    risen_s: Option<(f64, f64)>,
    begun: bool,
}

impl Returns {
    /// Whether a segment begins with this time: all before rose, and it is no later than
    /// the first of them. Times that go to and fro say nothing.
    pub(super) fn begins(&mut self, time_s: f64) -> bool {
        let risen_s = self.risen_s.filter(|(_, last_s)| time_s >= *last_s);
        let back = self
            .risen_s
            .is_some_and(|(first_s, last_s)| last_s > first_s && time_s <= first_s);
        self.risen_s = match (self.begun && !back, risen_s) {
            (false, _) => time_s.is_finite().then_some((time_s, time_s)),
            (true, risen_s) => risen_s.map(|(first_s, _)| (first_s, time_s)),
        };
        self.begun = true;
        back
    }
}

#[cfg(test)]
#[path = "tests/times.rs"]
mod tests;
