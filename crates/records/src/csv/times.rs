//! Times written beside samples: segments and the interval between samples.

use crate::error::RecordError;
use std::ops::Range;

/// A step so many times the usual one begins a new segment.
const GAP: f64 = 10.0;

/// Share of a step by which a time may be off the even ones: files round times;
/// one lost sample shifts by half a step or more.
const UNEVEN: f64 = 0.4;

/// Where times jump back, or ahead by many steps.
pub(super) fn segments(times_s: &[f64]) -> Vec<Range<usize>> {
    let usual = usual_step(times_s);
    let jumps = |at: &usize| {
        let step = step(times_s, at - 1);
        step < 0.0 || (usual > 0.0 && step > GAP * usual)
    };
    let starts = (1..times_s.len()).filter(jumps);
    let mut begin = 0;
    let segments = starts.chain([times_s.len()]);
    segments
        .map(|end| std::mem::replace(&mut begin, end)..end)
        .collect()
}

/// The even interval of a segment's times.
///
/// # Errors
/// Times that are not finite or not even.
pub(super) fn interval_s(source: &str, times_s: &[f64]) -> Result<f64, RecordError> {
    let empty = || RecordError::Empty {
        source_name: source.to_owned(),
    };
    let (first, last) = (
        *times_s.first().ok_or_else(empty)?,
        *times_s.last().ok_or_else(empty)?,
    );
    let steps = times_s.len() - 1;
    if steps == 0 {
        return Err(RecordError::truncated(
            source.to_owned(),
            "a single sample has no interval",
        ));
    }
    let interval_s = (last - first) / steps as f64;
    let even = |i: usize| first + i as f64 * interval_s;
    let bearable = bearable_s(times_s, interval_s);
    let off = |(i, time): (usize, &f64)| {
        let off = (time - even(i)).abs();
        off.is_nan() || off > bearable
    };
    match times_s.iter().enumerate().any(off) {
        false => Ok(interval_s),
        true => Err(uneven(source, times_s)),
    }
}

/// Tells of the step that is least like the usual one.
fn uneven(source: &str, times_s: &[f64]) -> RecordError {
    let usual_s = usual_step(times_s);
    let odd = |at: &usize| {
        let odd = (step(times_s, *at) - usual_s).abs();
        if odd.is_nan() { f64::INFINITY } else { odd }
    };
    let steps = 0..times_s.len().saturating_sub(1);
    let at = steps.max_by(|a, b| odd(a).total_cmp(&odd(b))).unwrap_or(0);
    RecordError::UnevenTimes {
        source_name: source.to_owned(),
        sample: at + 1,
        time_s: times_s.get(at).copied().unwrap_or(f64::NAN),
        step_s: step(times_s, at),
        usual_s,
    }
}

fn step(times_s: &[f64], at: usize) -> f64 {
    let pair = times_s.get(at).zip(times_s.get(at + 1));
    pair.map_or(f64::NAN, |(from, to)| to - from)
}

/// The step in the middle of all steps by size; 0 without any.
fn usual_step(times_s: &[f64]) -> f64 {
    let mut steps: Vec<f64> = times_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    match steps.is_empty() {
        true => 0.0,
        false => *steps.select_nth_unstable_by(middle, f64::total_cmp).1,
    }
}

/// How far a time may be off the even ones: part of a step, or the unit that
/// they are rounded to where that is so coarse that times repeat.
fn bearable_s(times_s: &[f64], interval_s: f64) -> f64 {
    let steps = || times_s.windows(2).map(|pair| pair[1] - pair[0]);
    let rounding = match steps().any(|step| step == 0.0) {
        true => steps()
            .filter(|step| *step > 0.0)
            .fold(f64::INFINITY, f64::min),
        false => 0.0,
    };
    let finite = if rounding.is_finite() { rounding } else { 0.0 };
    finite.max(UNEVEN * interval_s.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jumps_back_and_far_ahead_begin_segments() {
        assert_eq!(segments(&[0.0, 1.0, 2.0, 0.0, 1.0]), [0..3, 3..5]);
        assert_eq!(segments(&[0.0, 1.0, 2.0, 90.0, 91.0]), [0..3, 3..5]);
        assert_eq!(segments(&[0.0, 1.0, 2.0]).first(), Some(&(0..3)));
        assert_eq!(segments(&[]).first(), Some(&(0..0)));
    }

    #[test]
    fn rounded_times_are_even_and_a_lost_sample_is_not() {
        let rounded: Vec<f64> = (0..1000).map(|i| (f64::from(i) * 0.4).round()).collect();
        // The ends are rounded too: half a unit over the whole length.
        let interval = interval_s("x", &rounded).unwrap();
        assert!((interval - 0.4).abs() < 1.0 / 999.0, "{interval}");
    }

    #[test]
    fn a_lost_sample_is_told() {
        for lost in [1, 500, 998] {
            let kept = (0..1000).filter(|i| *i != lost).map(f64::from);
            let times: Vec<f64> = kept.collect();
            assert!(interval_s("x", &times).is_err(), "{lost}");
        }
    }
}
