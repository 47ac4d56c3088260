//! Times printed beside samples: where segments begin, and the interval that their digits allow.

use crate::error::{MeasureError, Result};
use crate::records::interval::FromTimes;
use std::ops::Range;

/// A step so many times the usual one begins a new segment.
const GAP: f64 = 10.0;

/// Rows of the shortest segment: fewer hold no shot.
pub(super) const SHORTEST: usize = 16;

/// More segments than this are dropped if most are too short.
const MANY: usize = 3;

/// Units of the last digit that a usual step must span: then rounding moves it by a quarter at
/// most.
const SPANNED: f64 = 4.0;

/// Share of a step by which times may be off the even ones beyond their digits: clocks jitter; one
/// lost sample shifts by half a step or more.
const UNEVEN: f64 = 0.4;

/// Most steps of a search that ends by itself after some ten.
const STEPS: usize = 100;

/// Rows by which numbers must rise evenly to be times: signals do by chance for some.
const RISEN: usize = 32;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Printed {
    pub s: f64,
    /// Worth of the last digit in s.
    pub unit_s: f64,
}

impl Printed {
    fn half_s(&self) -> f64 {
        0.5 * self.unit_s + self.rounding_s()
    }

    /// Rounding of the arithmetic, of the file's writer and ours.
    fn rounding_s(&self) -> f64 {
        8.0 * f64::EPSILON * self.s.abs()
    }
}

fn unit_s(times: &[Printed]) -> f64 {
    times.iter().fold(0.0, |unit, time| time.unit_s.max(unit))
}

/// Where times jump back, or ahead by many steps more than their digits hide; nowhere if most of
/// what that leaves is too short.
pub(super) fn segments(times: &[Printed]) -> Vec<Range<usize>> {
    let usual_s = usual_step_s(times);
    let jumps = |at: &usize| {
        let (from, to) = (times[at - 1], times[*at]);
        let step_s = to.s - from.s;
        let hidden_s = from.half_s() + to.half_s();
        step_s < 0.0 || (usual_s > 0.0 && step_s - hidden_s > GAP * usual_s)
    };
    let starts = (1..times.len()).filter(jumps);
    let mut begin = 0;
    let segments = starts.chain([times.len()]);
    let segments: Vec<Range<usize>> =
        segments.map(|end| std::mem::replace(&mut begin, end)..end).collect();
    let short = segments.iter().filter(|part| part.len() < SHORTEST).count();
    match segments.len() > MANY && 2 * short > segments.len() {
        true => std::iter::once(0..times.len()).collect(),
        false => segments,
    }
}

/// The even interval of a segment's times; an error of times that are not even.
pub(super) fn interval(source: &str, times: &[Printed]) -> Result<FromTimes> {
    match times.len() {
        0 => Err(MeasureError::empty(source.to_owned())),
        1 => Err(MeasureError::truncated(source.to_owned(), "a single sample has no interval")),
        _ => even_interval(times).ok_or_else(|| uneven(source, times)),
    }
}

/// The error at the step that differs most from the usual one.
fn uneven(source: &str, times: &[Printed]) -> MeasureError {
    let usual_s = usual_step_s(times);
    let off_s = |pair: &[Printed]| (pair[1].s - pair[0].s - usual_s).abs();
    let off_s = times.windows(2).map(off_s).enumerate();
    let off_s = off_s.map(|(at, off)| (at, if off.is_nan() { f64::INFINITY } else { off }));
    let at = off_s.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |of| of.0);
    // Without the last digits of double precision, which no file had.
    let time_s = times.get(at).map_or(f64::NAN, |time| time.s);
    let time_s: f64 = format!("{time_s:.11e}").parse().unwrap_or(time_s);
    let step_s = match times.get(at..at + 2) {
        Some([from, to]) => to.s - from.s,
        _ => f64::NAN,
    };
    let detail = format!(
        "its times are not evenly spaced: from sample {}, at {time_s} s, to the next they go on by \
         {:.4} µs where steps of {:.4} µs are usual; were samples lost? If not, --rate with \
         --trust-rate leaves times aside",
        at + 1,
        step_s * 1e6,
        usual_s * 1e6
    );
    MeasureError::Rate(source.to_owned(), detail)
}

/// The median of all steps; 0 without any. Where digits are so few that times repeat, it is taken
/// over as many steps as they need.
fn usual_step_s(times: &[Printed]) -> f64 {
    let unit_s = unit_s(times);
    let mut over = 1;
    loop {
        let pairs = times.iter().zip(times.iter().skip(over));
        let mut rises_s: Vec<f64> = pairs.map(|(from, to)| to.s - from.s).collect();
        let middle = rises_s.len() / 2;
        let rise_s = match rises_s.is_empty() {
            true => 0.0,
            false => *rises_s.select_nth_unstable_by(middle, f64::total_cmp).1,
        };
        if rise_s >= SPANNED * unit_s || 8 * over > times.len() {
            return rise_s / over as f64;
        }
        over *= 2;
    }
}

/// The interval of times in equal steps, and the range that their digits allow; `None` of times
/// that are not even.
///
/// Times that go on by equal steps to the last digit are taken as they stand. Others are rounded:
/// a line t = a + b·i fits if it meets every printed time within half its last digit, and the
/// range is that of b over all such lines.
pub(super) fn even_interval(times: &[Printed]) -> Option<FromTimes> {
    let steps = times.len().checked_sub(1).filter(|steps| *steps > 0)? as f64;
    let (first, last) = (times.first()?, times.last()?);
    let mean_s = (last.s - first.s) / steps;
    let unit_s = unit_s(times);
    let range = |least_s, most_s, even_to_s| Some(FromTimes { least_s, most_s, even_to_s });
    let off_s = |i: usize, time: &Printed| (time.s - first.s - i as f64 * mean_s).abs();
    let mut numbered = times.iter().enumerate();
    let exact =
        |(i, time): (usize, &Printed)| off_s(i, time) <= first.rounding_s() + time.rounding_s();
    if mean_s > 0.0 && numbered.all(exact) {
        return range(mean_s, mean_s, unit_s);
    }
    if lacks_one(times) {
        return None;
    }
    let slack_s = (last.half_s() + first.half_s()) / steps;
    let edges = (edge_s(times, mean_s - slack_s), edge_s(times, mean_s + slack_s));
    if let (Some(least_s), Some(most_s)) = edges {
        return range(least_s, most_s, unit_s);
    }
    let (slope_s, left_s) = line(times);
    let allowed = 2.0 * left_s / steps;
    match left_s <= UNEVEN * slope_s {
        true => range(slope_s - allowed, slope_s + allowed, 2.0 * left_s),
        false => None,
    }
}

/// Whether many times rise by even steps, and by some digits in all, so that their digits leave no
/// constant.
pub(super) fn rises(times: &[Printed]) -> bool {
    let [from, .., to] = times else { return false };
    times.len() >= RISEN
        && to.s - from.s > 3.0 * from.unit_s.max(to.unit_s)
        && even_interval(times).is_some_and(|range| range.least_s > 0.0)
}

/// Whether all steps are one step but for a single longer one of several: a lost sample, or the
/// rounding of an interval so near a whole number of digits that it shows once, which recorders'
/// intervals are not.
fn lacks_one(times: &[Printed]) -> bool {
    let steps_s = times.windows(2).map(|pair| pair[1].s - pair[0].s);
    let step_s = steps_s.clone().fold(f64::INFINITY, f64::min);
    let slack_s = times.iter().fold(0.0, |unit, time| time.half_s().max(unit));
    let mut longer = steps_s.filter(|s| s - step_s > slack_s);
    let (Some(one), None) = (longer.next(), longer.next()) else {
        return false;
    };
    step_s > 0.0 && one > 1.5 * step_s
}

/// The slope next to `start`, which lies beyond, with which a line meets all times.
///
/// With slope b a line must lie above the greatest of (lower end)ᵢ − b·i and below the least of
/// (upper end)ⱼ − b·j. By how much the one exceeds the other is convex in b and made of straight
/// pieces, so Newton's method ends after a few of them.
fn edge_s(times: &[Printed], start: f64) -> Option<f64> {
    let (first, last) = (times.first()?, times.last()?);
    let rounding = last.rounding_s() + first.rounding_s();
    let (mut slope, mut side) = (start, 0.0);
    for _ in 0..STEPS {
        let (mut lower, mut upper) = ((f64::NEG_INFINITY, 0.0), (f64::INFINITY, 0.0));
        for (i, time) in times.iter().enumerate() {
            let (i, half) = (i as f64, time.half_s());
            let at = time.s - first.s - slope * i;
            if at - half > lower.0 {
                lower = (at - half, i);
            }
            if at + half < upper.0 {
                upper = (at + half, i);
            }
        }
        let (over, turn) = (lower.0 - upper.0, upper.1 - lower.1);
        if over <= rounding {
            return Some(slope);
        }
        // Beyond the least of a convex function there is no line at all.
        if turn == 0.0 || turn * side < 0.0 {
            return None;
        }
        side = turn;
        slope -= over / turn;
    }
    None
}

/// Slope of the line of least squares, and the most by which a time is off it.
fn line(times: &[Printed]) -> (f64, f64) {
    let begun = times.first().map_or(0.0, |time| time.s);
    let middle = 0.5 * (times.len() as f64 - 1.0);
    let mean = times.iter().map(|time| time.s - begun).sum::<f64>() / times.len() as f64;
    let (mut along, mut squares) = (0.0, 0.0);
    for (i, time) in times.iter().enumerate() {
        let i = i as f64 - middle;
        along += i * (time.s - begun - mean);
        squares += i * i;
    }
    let slope = along / squares;
    let off = |(i, time): (usize, &Printed)| {
        let off = (time.s - begun - mean - slope * (i as f64 - middle)).abs();
        if off.is_nan() { f64::INFINITY } else { off }
    };
    let most = times.iter().enumerate().map(off).fold(0.0, f64::max);
    (slope, most)
}

/// Where times begin anew of which a trusted rate needs nothing else.
#[derive(Debug, Default)]
pub(super) struct Returns {
    /// First and last time of the segment under way, if they only rose so far.
    risen_s: Option<(f64, f64)>,
    begun: bool,
}

impl Returns {
    /// Whether a segment begins with this time: all before rose, and it is no later than the first
    /// of them. Times that go to and fro begin none.
    pub(super) fn begins(&mut self, time_s: f64) -> bool {
        let back =
            self.risen_s.is_some_and(|(first_s, last_s)| last_s > first_s && time_s <= first_s);
        let risen_s = self.risen_s.filter(|(_, last_s)| time_s >= *last_s);
        self.risen_s = match self.begun && !back {
            false => time_s.is_finite().then_some((time_s, time_s)),
            true => risen_s.map(|(first_s, _)| (first_s, time_s)),
        };
        self.begun = true;
        back
    }
}

#[cfg(test)]
#[path = "tests/even.rs"]
mod even_tests;
#[cfg(test)]
#[path = "tests/times.rs"]
mod tests;
