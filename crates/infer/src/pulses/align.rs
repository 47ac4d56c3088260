//! A record against a model's signal, each at its own time.
//!
//! Residuals r(θ, n) of a record depend on the parameters θ and on numbers n of
//! its own. Least squares over both are least squares over θ of what the best n
//! leave: r minus its part along the columns ∂r/∂n [GolubPereyra1973].

use super::record::{BASELINE, Pulses};
use crate::linear::dot;

/// A model's signals in V, a row a channel, from the impact on.
pub(super) struct Traced {
    pub(super) interval_s: f64,
    /// When the passing pulse is highest, in s.
    pub(super) passing_s: f64,
    pub(super) volts: Vec<Vec<f64>>,
    /// Their change with the logarithm of the speed.
    pub(super) by_ln_speed: Vec<Vec<f64>>,
}

/// Most corrections of the moment of impact.
const CORRECTIONS: usize = 30;

/// A correction that is small enough, in standard errors of the moment.
const SMALL: f64 = 1e-6;

/// Residuals of a record in standard errors, with its own numbers at their best:
/// those of the means, channel by channel, then that of the speed.
pub(super) fn residuals(record: &Pulses, traced: &Traced) -> Vec<f64> {
    let mut shift_s = record.passing_s - traced.passing_s;
    let mut projected = Vec::new();
    for _ in 0..CORRECTIONS {
        let correction;
        (projected, correction) = at(record, traced, shift_s);
        shift_s += correction.seconds;
        if correction.sigmas.abs() < SMALL {
            break;
        }
    }
    projected
}

/// By how much the moment of impact is to be moved.
struct Correction {
    seconds: f64,
    sigmas: f64,
}

/// What is left of the residuals at one moment of impact.
fn at(record: &Pulses, traced: &Traced, shift_s: f64) -> (Vec<f64>, Correction) {
    let half_s = 0.5 * traced.interval_s;
    let channels = record.means_v.len();
    let model = sampled(record, traced, &traced.volts, shift_s);
    let later = sampled(record, traced, &traced.volts, shift_s + half_s);
    let earlier = sampled(record, traced, &traced.volts, shift_s - half_s);
    let by_shift = later.iter().zip(&earlier).map(|(a, b)| (a - b) / (2.0 * half_s));
    let mut by_shift: Vec<f64> = by_shift.collect();
    let measured = weighed(record, |channel, at| record.means_v[channel][at]);
    let mut left: Vec<f64> = measured.iter().zip(&model).map(|(a, b)| a - b).collect();
    let baseline = |number: usize| {
        let (own, power) = (number / BASELINE, (number % BASELINE) as i32);
        let middle = 0.5 * record.means_v[own].len() as f64;
        weighed(record, |channel, at| match channel == own {
            true => ((at as f64 - middle) / middle).powi(power),
            false => 0.0,
        })
    };
    let mut columns: Vec<Vec<f64>> = (0..BASELINE * channels).map(baseline).collect();
    let error = record.ln_speed_error();
    if error > 0.0 {
        let mut by_speed = sampled(record, traced, &traced.by_ln_speed, shift_s);
        by_speed.push(1.0 / error);
        columns.iter_mut().for_each(|column| column.push(0.0));
        columns.push(by_speed);
        by_shift.push(0.0);
        left.push(0.0);
    }
    columns.push(by_shift);
    let (along, length) = take_out(&mut columns, &mut left);
    (left, Correction { seconds: along / length, sigmas: along })
}

/// Takes the part along all columns out of a vector; returns its coordinate along
/// what the last column has of its own, and the length of that.
fn take_out(columns: &mut [Vec<f64>], from: &mut [f64]) -> (f64, f64) {
    let mut last = (0.0, f64::INFINITY);
    for number in 0..columns.len() {
        let (before, rest) = columns.split_at_mut(number);
        let Some(own) = rest.first_mut() else { break };
        for other in before.iter() {
            let along = dot(other, own);
            own.iter_mut().zip(other).for_each(|(x, q)| *x -= along * q);
        }
        let length = dot(own, own).sqrt();
        if length <= 0.0 {
            continue;
        }
        own.iter_mut().for_each(|x| *x /= length);
        let along = dot(own, from);
        from.iter_mut().zip(own.iter()).for_each(|(x, q)| *x -= along * q);
        last = (along, length);
    }
    last
}

/// A number for each mean, over its standard error, with the noise made white.
fn weighed(record: &Pulses, value: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let mut all = Vec::new();
    for (channel, (means, sigma)) in record.means_v.iter().zip(&record.sigma_v).enumerate() {
        let mut own: Vec<f64> = (0..means.len()).map(|at| value(channel, at) / sigma).collect();
        record.whitening[channel].apply(&mut own);
        all.append(&mut own);
    }
    all
}

/// Signals as the record has them: means over its samples, over their errors.
fn sampled(record: &Pulses, traced: &Traced, signals: &[Vec<f64>], shift_s: f64) -> Vec<f64> {
    let first = (record.start_s - shift_s) / traced.interval_s;
    let step = record.interval_s / traced.interval_s;
    let one = |channel: usize, at: usize| {
        let signal = signals.get(channel).map_or(&[][..], Vec::as_slice);
        let samples = at * record.width..(at + 1) * record.width;
        let sum: f64 = samples.map(|n| between(signal, first + n as f64 * step)).sum();
        sum / record.width as f64
    };
    weighed(record, one)
}

/// A signal between its samples, by the cubic through the four nearest; nothing
/// before the impact, and its last value after its end.
fn between(signal: &[f64], place: f64) -> f64 {
    let below = place.floor();
    let x = place - below;
    let sample = |offset: f64| {
        let at = below + offset;
        match at < 0.0 {
            true => 0.0,
            false => signal.get(at as usize).or(signal.last()).copied().unwrap_or(0.0),
        }
    };
    let [a, b, c, d] = [-1.0, 0.0, 1.0, 2.0].map(sample);
    let (back, ahead) = (x + 1.0, x - 1.0);
    let further = x - 2.0;
    -a * x * ahead * further / 6.0 + b * back * ahead * further / 2.0 - c * back * x * further / 2.0
        + d * back * x * ahead / 6.0
}

#[cfg(test)]
#[path = "tests/align.rs"]
mod tests;
