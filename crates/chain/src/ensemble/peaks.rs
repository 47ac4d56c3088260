//! From samples to a signal with its maxima.

use super::number::Number;
use super::record::Samples;
use super::weights::Schedule;
use crate::observe::{LEAST_SHARE, Maximum, Shape, Signal, Stretch};
use crate::sensor::Sensor;

/// Samples on either side of the highest that its polynomial goes through.
const REACH: usize = 3;
const POINTS: usize = 2 * REACH + 1;

/// Steps in contact times of which a peak's interpolations are compared, at least: samples of shorter ones
/// see no kink beyond 0.05 contact times, where another maximum may hide (motor oil at 0.1553 m/s).
const LEAST_COMPARED: f64 = 0.017;

#[derive(Clone, Copy)]
pub(super) struct Clock<'a> {
    pub schedule: &'a Schedule,
    pub step_s: f64,
    /// In contact times.
    pub step: f64,
}

impl Clock<'_> {
    pub(super) fn time_s(&self, step: usize) -> f64 {
        self.step_s * self.schedule.time(step)
    }
}

/// What a lane's sensor showed until its last step.
#[derive(Clone, Copy)]
pub(super) struct LaneTrace<'a, N, const W: usize> {
    pub samples: Samples<'a, N, W>,
    pub last_step: usize,
    pub clock: Clock<'a>,
    /// What is not above this is no signal.
    pub silent: f64,
    /// Least height times time of a pulse, in N s.
    pub least_n_s: f64,
}

impl<N: Number<W>, const W: usize> LaneTrace<'_, N, W> {
    /// The signal: its maxima, from steps whose samples are above both
    /// neighbours or below both, and with `shape` all that is above its floor.
    pub(super) fn signal(self, sensor: Sensor, extremes: &[usize], shape: bool) -> Signal {
        let mut largest = 0.0_f64;
        let mut maxima = Vec::with_capacity(8);
        let extremes = extremes.iter().copied();
        for step in extremes.take_while(|&step| step < self.last_step) {
            let value = self.samples.at(step);
            largest = largest.max(value.abs());
            let high = value > self.samples.at(step + 1);
            if high && value > self.silent.max(LEAST_SHARE * largest) {
                maxima.push(self.maximum(step));
            }
        }
        let stretches = match shape {
            true => self.stretches(self.silent.max(LEAST_SHARE * largest)),
            false => Vec::new(),
        };
        Signal::assembled(sensor, (stretches, maxima), self.least_n_s)
    }

    /// Quartics through five samples each, where steps are equal and anything
    /// is seen.
    fn stretches(self, floor: f64) -> Vec<Stretch> {
        let first = self.clock.schedule.first_full_step();
        let starts = (first..self.last_step.saturating_sub(3)).step_by(4);
        let stretch = |start: usize| Stretch {
            start_s: self.clock.time_s(start),
            length_s: 4.0 * self.clock.step_s,
            values: std::array::from_fn(|i| self.samples.at(start + i)),
        };
        let seen = |stretch: &Stretch| stretch.values.iter().any(|value| value.abs() > floor);
        starts.map(stretch).filter(seen).collect()
    }

    /// The maximum near the highest of neighbouring samples: of the polynomial
    /// of degree six through seven samples, between the neighbours. Too few
    /// samples are their own maximum.
    fn maximum(self, step: usize) -> (Maximum, Shape) {
        let schedule = self.clock.schedule;
        if self.last_step < POINTS {
            let maximum = Maximum { time_s: self.clock.time_s(step), value: self.samples.at(step) };
            return (maximum, Shape::UNKNOWN);
        }
        let from = (step - 1).saturating_sub(REACH).min(self.last_step - POINTS) + 1;
        let middle = schedule.time(step);
        let nodes: [f64; POINTS] = std::array::from_fn(|i| schedule.time(from + i) - middle);
        let values = std::array::from_fn(|i| self.samples.at(from + i));
        let equidistant = from >= schedule.first_full_step() && step == from + REACH;
        let polynomial = match equidistant {
            true => through_equidistant(values),
            false => through(nodes, values),
        };
        let at = step - from;
        let at = highest(&polynomial, nodes[at - 1], nodes[at + 1]);
        let (value, _, curvature) = derivatives(&polynomial, at);
        let maximum = Maximum { time_s: self.clock.step_s * (middle + at), value };
        let step_s = self.clock.step_s;
        let interpolation = self.interpolation(step, curvature);
        let shape = Shape {
            sharpness_per_s2: -curvature / (value * step_s * step_s),
            interpolation_s: step_s * interpolation,
        };
        (maximum, shape)
    }

    /// How far apart, in steps, the interpolations of a maximum with this curvature are.
    fn interpolation(self, step: usize, curvature: f64) -> f64 {
        let apart = (LEAST_COMPARED / self.clock.step).ceil().max(1.0) as usize;
        let (before, after) = (step.checked_sub(REACH * apart), step + REACH * apart);
        let full = self.clock.schedule.first_full_step();
        let Some(first) = before.filter(|&first| first >= full && after <= self.last_step) else {
            return f64::INFINITY;
        };
        let values = std::array::from_fn(|i| self.samples.at(first + i * apart));
        let apart = apart as f64;
        apart * quartic_differs(through_equidistant(values), apart * apart * curvature)
    }
}

/// The polynomial through seven samples a step apart, about the middle one.
fn through_equidistant([a, b, c, d, e, f, g]: [f64; POINTS]) -> [f64; POINTS] {
    // Odd and even parts alone: differences and sums of what lies opposite.
    let (odd1, odd2, odd3) = (e - c, f - b, g - a);
    let (even1, even2, even3) = (e + c, f + b, g + a);
    [
        d,
        (45.0 * odd1 - 9.0 * odd2 + odd3) / 60.0,
        (270.0 * even1 - 27.0 * even2 + 2.0 * even3 - 490.0 * d) / 360.0,
        (8.0 * odd2 - 13.0 * odd1 - odd3) / 48.0,
        (12.0 * even2 - 39.0 * even1 - even3 + 56.0 * d) / 144.0,
        (5.0 * odd1 - 4.0 * odd2 + odd3) / 240.0,
        (15.0 * even1 - 6.0 * even2 + even3 - 20.0 * d) / 720.0,
    ]
}

/// How far apart, in steps, the maxima of the polynomial and of the quartic through its five middle
/// samples may be: a kink near the top, or another maximum, moves both.
///
/// Their slopes differ by a₅ (5x⁴ − 15x² + 4) + a₆ (6x⁵ − 20x³ + 8x), x from the middle. Each term is
/// taken as large as it gets within half a step of it: what they cancel depends on where a kink lies.
fn quartic_differs([.., a5, a6]: [f64; POINTS], curvature: f64) -> f64 {
    (4.0 * a5.abs() + 2.0 * a6.abs()) / -curvature.min(-0.0)
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

fn derivatives(polynomial: &[f64; POINTS], at: f64) -> (f64, f64, f64) {
    let sums = polynomial.iter().rev();
    sums.fold((0.0, 0.0, 0.0), |(p, d, c), k| (p * at + k, d * at + p, c * at + 2.0 * d))
}

/// Where the slope passes 0 from above, by Newton's method in a bracket.
fn highest(polynomial: &[f64; POINTS], mut low: f64, mut high: f64) -> f64 {
    // That of the parabola about the middle, which may have none, or none here.
    let vertex = -0.5 * polynomial[1] / polynomial[2];
    let mut at = match vertex > low && vertex < high {
        true => vertex,
        false => 0.0_f64.clamp(low, high),
    };
    for _ in 0..50 {
        let (_, slope, curvature) = derivatives(polynomial, at);
        if slope > 0.0 {
            low = at
        } else {
            high = at
        }
        let next = at - slope / curvature;
        let next =
            if curvature < 0.0 && next > low && next < high { next } else { 0.5 * (low + high) };
        // What is left is the square of the last change, about.
        if (next - at).abs() <= 1e-5 {
            return next;
        }
        at = next;
    }
    at
}

#[cfg(test)]
#[path = "tests/peaks.rs"]
mod tests;
