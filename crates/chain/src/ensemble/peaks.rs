//! From samples to a signal with its maxima.

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

/// The signal of a sensor from its samples, the first of which is that of
/// step `first`; what is not above `silent` is none.
pub(super) fn signal(
    sensor: Sensor,
    values: &[f64],
    first: usize,
    clock: Clock<'_>,
    silent: f64,
) -> Signal {
    let mut largest = 0.0_f64;
    let mut maxima = Vec::new();
    for (i, around) in values.windows(3).enumerate() {
        let value = around[1];
        largest = largest.max(value.abs());
        let highest = value >= around[0] && value > around[2];
        if highest && value > silent.max(KEPT * largest) && values.len() >= POINTS {
            maxima.push(maximum(values, i + 1, first, clock));
        }
    }
    let floor = silent.max(KEPT * largest);
    Signal::assembled(sensor, stretches(values, first, clock, floor), maxima)
}

/// Quartics through five samples each, where steps are equal and anything is seen.
fn stretches(values: &[f64], first: usize, clock: Clock<'_>, floor: f64) -> Vec<Stretch> {
    // At steps that do not depend on the first sample.
    let full_from = clock.schedule.first_full_step().next_multiple_of(4);
    let growing = first.next_multiple_of(4).max(full_from) - first;
    let full = values.get(growing..).unwrap_or_default();
    let seen = |five: &[f64]| five.iter().any(|value| value.abs() > floor);
    let fives = full.windows(5).step_by(4).enumerate();
    fives
        .filter(|(_, five)| seen(five))
        .map(|(i, five)| Stretch {
            start_s: clock.time_s(first + growing + 4 * i),
            length_s: 4.0 * clock.step_s,
            values: std::array::from_fn(|k| five[k]),
        })
        .collect()
}

/// The maximum near the highest of neighbouring samples: of the polynomial of
/// degree six through seven samples, between the neighbours.
fn maximum(values: &[f64], at: usize, first: usize, clock: Clock<'_>) -> Maximum {
    let from = at.saturating_sub(REACH).min(values.len() - POINTS);
    let middle = clock.schedule.time(first + at);
    let nodes: [f64; POINTS] =
        std::array::from_fn(|i| clock.schedule.time(first + from + i) - middle);
    let polynomial = through(nodes, std::array::from_fn(|i| values[from + i]));
    let at = at - from;
    let at = highest(&polynomial, nodes[at - 1], nodes[at + 1]);
    let (value, ..) = derivatives(&polynomial, at);
    Maximum {
        time_s: clock.step_s * (middle + at),
        value,
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
