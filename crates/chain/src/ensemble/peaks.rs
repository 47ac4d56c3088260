//! From samples to a signal with its maxima.

use super::record::Samples;
use super::weights::Schedule;
use crate::observe::{Maximum, Signal, Stretch};
use crate::sensor::Sensor;

/// Samples on either side of the highest that its polynomial goes through.
const REACH: usize = 3;
const POINTS: usize = 2 * REACH + 1;

/// Samples below this fraction of the largest so far are not kept.
const KEPT: f64 = 1e-4;

/// Times of a lane's samples.
#[derive(Clone, Copy)]
pub(super) struct Clock<'a> {
    pub schedule: &'a Schedule,
    pub step_s: f64,
}

impl Clock<'_> {
    /// Time of a step in s.
    pub fn time_s(&self, step: usize) -> f64 {
        self.step_s * self.schedule.time(step)
    }
}

/// The signal of a sensor from its samples up to a step; what is not above
/// `silent` is none.
pub(super) fn signal(
    sensor: Sensor,
    samples: Samples<'_>,
    last_step: usize,
    clock: Clock<'_>,
    silent: f64,
) -> Signal {
    let seen = (last_step + 1).saturating_sub(samples.first());
    let trace = Trace {
        samples,
        count: seen.min(samples.count()),
        clock,
    };
    let mut largest = 0.0_f64;
    let mut maxima = Vec::with_capacity(8);
    let (mut before, mut value) = (f64::INFINITY, f64::INFINITY);
    for i in 0..trace.count {
        let after = samples.at(i);
        if value >= before && value > after && value > silent.max(KEPT * largest) {
            maxima.extend((i > 1).then(|| trace.maximum(i - 1)));
        }
        largest = largest.max(after.abs());
        (before, value) = (value, after);
    }
    let stretches = trace.stretches(silent.max(KEPT * largest));
    Signal::assembled(sensor, stretches, maxima)
}

/// The samples of a lane with their times.
#[derive(Clone, Copy)]
struct Trace<'a> {
    samples: Samples<'a>,
    count: usize,
    clock: Clock<'a>,
}

impl Trace<'_> {
    /// Quartics through five samples each, where steps are equal and anything
    /// is seen.
    fn stretches(self, floor: f64) -> Vec<Stretch> {
        let first = self.samples.first();
        let growing = self.clock.schedule.first_full_step().saturating_sub(first);
        let mut stretches = Vec::with_capacity(self.count / 4);
        for start in (growing..self.count.saturating_sub(4)).step_by(4) {
            let values: [f64; 5] = std::array::from_fn(|k| self.samples.at(start + k));
            if values.iter().any(|value| value.abs() > floor) {
                stretches.push(Stretch {
                    start_s: self.clock.time_s(first + start),
                    length_s: 4.0 * self.clock.step_s,
                    values,
                });
            }
        }
        stretches
    }

    /// The maximum near the highest of neighbouring samples: of the polynomial
    /// of degree six through seven samples, between the neighbours. Too few
    /// samples are their own maximum.
    fn maximum(self, at: usize) -> Maximum {
        let first = self.samples.first();
        if self.count < POINTS {
            return Maximum {
                time_s: self.clock.time_s(first + at),
                value: self.samples.at(at),
            };
        }
        let from = at.saturating_sub(REACH).min(self.count - POINTS);
        let schedule = self.clock.schedule;
        let middle = schedule.time(first + at);
        let nodes: [f64; POINTS] =
            std::array::from_fn(|i| schedule.time(first + from + i) - middle);
        let values = std::array::from_fn(|i| self.samples.at(from + i));
        let polynomial = through(nodes, values);
        let at = at - from;
        let at = highest(&polynomial, nodes[at - 1], nodes[at + 1]);
        let (value, ..) = derivatives(&polynomial, at);
        Maximum {
            time_s: self.clock.step_s * (middle + at),
            value,
        }
    }
}

/// Coefficients of the polynomial through points, by divided differences.
fn through(nodes: [f64; POINTS], mut differences: [f64; POINTS]) -> [f64; POINTS] {
    for order in 1..POINTS {
        for i in (order..POINTS).rev() {
            let span = nodes[i] - nodes[i - order];
            differences[i] = (differences[i] - differences[i - 1]) / span;
        }
    }
    let mut polynomial = [0.0; POINTS];
    for i in (0..POINTS).rev() {
        for power in (1..POINTS).rev() {
            polynomial[power] = polynomial[power - 1] - nodes[i] * polynomial[power];
        }
        polynomial[0] = differences[i] - nodes[i] * polynomial[0];
    }
    polynomial
}

/// Value, slope and curvature.
fn derivatives(polynomial: &[f64; POINTS], at: f64) -> (f64, f64, f64) {
    let sums = polynomial.iter().rev();
    sums.fold((0.0, 0.0, 0.0), |(p, d, c), k| {
        (p * at + k, d * at + p, c * at + 2.0 * d)
    })
}

/// Where the slope passes 0 from above, by Newton's method in a bracket.
fn highest(polynomial: &[f64; POINTS], mut low: f64, mut high: f64) -> f64 {
    let mut at = 0.0_f64.clamp(low, high);
    for _ in 0..50 {
        let (_, slope, curvature) = derivatives(polynomial, at);
        if slope > 0.0 {
            low = at
        } else {
            high = at
        }
        let next = at - slope / curvature;
        let next = if curvature < 0.0 && next > low && next < high {
            next
        } else {
            0.5 * (low + high)
        };
        if (next - at).abs() <= 1e-12 {
            return next;
        }
        at = next;
    }
    at
}
