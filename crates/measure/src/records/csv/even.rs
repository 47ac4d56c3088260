//! The even interval of printed times, as far as their digits tell it.

use super::times::Printed;
use crate::records::interval::FromTimes;

/// Share of a step by which times may be off the even ones beyond their digits: clocks
/// jitter; one lost sample shifts by half a step or more.
const UNEVEN: f64 = 0.4;

/// Steps of a search that ends by itself after some ten.
const STEPS: usize = 100;

/// The interval of times in equal steps, and which others their digits allow; `None` of
/// times that are not even.
///
/// Times that go on by equal steps to the last digit are taken as they stand. Others
/// are rounded: a line t = a + b·i is one of theirs if it meets every printed time
/// within half its last digit, and b may be anything that such a line has.
pub(super) fn interval(times: &[Printed]) -> Option<FromTimes> {
    let steps = times.len().checked_sub(1).filter(|steps| *steps > 0)? as f64;
    let (first, last) = (times.first()?, times.last()?);
    let mean_s = (last.s - first.s) / steps;
    let printed_to_s = times.iter().fold(0.0, |unit, time| time.unit_s.max(unit));
    let told = |least_s, most_s, even_to_s| FromTimes {
        least_s,
        most_s,
        even_to_s,
    };
    let off = |(i, time): (usize, &Printed)| (time.s - first.s - i as f64 * mean_s).abs();
    let exact = |at: (usize, &Printed)| off(at) <= first.rounding_s() + at.1.rounding_s();
    if mean_s > 0.0 && times.iter().enumerate().all(exact) {
        return Some(told(mean_s, mean_s, printed_to_s));
    }
    if lost(times) {
        return None;
    }
    if let Some((least_s, most_s)) = range_s(times) {
        return Some(told(least_s, most_s, printed_to_s));
    }
    let (slope_s, left_s) = line(times)?;
    let allowed = 2.0 * left_s / steps;
    let even = left_s <= UNEVEN * slope_s;
    even.then(|| told(slope_s - allowed, slope_s + allowed, 2.0 * left_s))
}

/// Rows by which numbers must rise evenly to be times: signals do by chance for some.
const RISEN: usize = 32;

/// Whether many times rise by even steps, and by some digits in all, so that their digits
/// leave no constant.
pub(super) fn rises(times: &[Printed]) -> bool {
    if times.len() < RISEN {
        return false;
    }
    let rise_s = times
        .first()
        .zip(times.last())
        .map(|(from, to)| (to.s - from.s, 3.0 * from.unit_s.max(to.unit_s)));
    rise_s.is_some_and(|(rise_s, least_s)| rise_s > least_s)
        && interval(times).is_some_and(|told| told.least_s > 0.0)
}

/// Whether all steps are one step but for a single one of several: so a lost sample looks, and
/// also the rounding of an interval by chance so near a whole number of digits that it shows
/// once. Recorders' intervals are not.
fn lost(times: &[Printed]) -> bool {
    let steps_s = times.windows(2).map(|pair| pair[1].s - pair[0].s);
    let step_s = steps_s.clone().fold(f64::INFINITY, f64::min);
    let slack_s = times.iter().fold(0.0, |unit, time| time.half_s().max(unit));
    let mut odd = steps_s.filter(|s| s - step_s > slack_s);
    let (Some(one), None) = (odd.next(), odd.next()) else {
        return false;
    };
    step_s > 0.0 && one > 1.5 * step_s
}

/// Least and largest slope of the lines that meet all times within half their last digit.
fn range_s(times: &[Printed]) -> Option<(f64, f64)> {
    let steps = times.len().checked_sub(1)? as f64;
    let (first, last) = (times.first()?, times.last()?);
    let (mean_s, slack_s) = (
        (last.s - first.s) / steps,
        (last.half_s() + first.half_s()) / steps,
    );
    let least_s = edge_s(times, mean_s - slack_s)?;
    let most_s = edge_s(times, mean_s + slack_s)?;
    Some((least_s, most_s))
}

/// The slope next to `start`, which lies beyond, with which a line meets all times.
///
/// With slope b a line must lie above the greatest of (lower end)ᵢ − b·i and below the
/// least of (upper end)ⱼ − b·j. By how much the one exceeds the other is convex in b and
/// made of straight pieces, so Newton's method ends after a few of them.
fn edge_s(times: &[Printed], start: f64) -> Option<f64> {
    let begun = times.first()?.s;
    let (mut slope, mut side) = (start, 0.0);
    for _ in 0..STEPS {
        let (mut lower, mut upper) = ((f64::NEG_INFINITY, 0.0), (f64::INFINITY, 0.0));
        for (i, time) in times.iter().enumerate() {
            let (i, half) = (i as f64, time.half_s());
            let at = time.s - begun - slope * i;
            if at - half > lower.0 {
                lower = (at - half, i);
            }
            if at + half < upper.0 {
                upper = (at + half, i);
            }
        }
        let (over, turn) = (lower.0 - upper.0, upper.1 - lower.1);
        let rounding = times.last()?.rounding_s() + times.first()?.rounding_s();
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
fn line(times: &[Printed]) -> Option<(f64, f64)> {
    let begun = times.first()?.s;
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
    Some((slope, most))
}

#[cfg(test)]
#[path = "tests/even.rs"]
mod tests;
