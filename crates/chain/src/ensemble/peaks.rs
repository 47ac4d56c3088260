//! From samples to a signal with its maxima.

use super::record::Samples;
use super::weights::Schedule;
use crate::observe::{KEPT, Maximum, Signal, Stretch};
use crate::sensor::Sensor;

/// Samples on either side of the highest that its polynomial goes through.
const REACH: usize = 3;
const POINTS: usize = 2 * REACH + 1;

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
    let values = samples.until(last_step);
    let trace = Trace {
        values: &values,
        clock,
    };
    let mut largest = 0.0_f64;
    let mut maxima = Vec::with_capacity(8);
    for (i, around) in values.windows(3).enumerate() {
        let [rise, fall] = [around[1] - around[0], around[1] - around[2]];
        // Between extremes nothing is the largest yet.
        if rise * fall < 0.0 {
            continue;
        }
        let value = around[1];
        largest = largest.max(value.abs());
        if rise >= 0.0 && fall > 0.0 && value > silent.max(KEPT * largest) {
            maxima.push(trace.maximum(i + 1));
        }
    }
    let stretches = trace.stretches(silent.max(KEPT * largest));
    Signal::assembled(sensor, stretches, maxima)
}

/// The samples of a lane from step 1 on, with their times.
#[derive(Clone, Copy)]
struct Trace<'a> {
    values: &'a [f64],
    clock: Clock<'a>,
}

impl Trace<'_> {
    /// Quartics through five samples each, where steps are equal and anything
    /// is seen.
    fn stretches(self, floor: f64) -> Vec<Stretch> {
        let first = self.clock.schedule.first_full_step();
        let full = self.values.get(first - 1..).unwrap_or_default();
        let mut stretches = Vec::with_capacity(full.len() / 4);
        for (i, five) in full.windows(5).step_by(4).enumerate() {
            if five.iter().any(|value| value.abs() > floor) {
                stretches.push(Stretch {
                    start_s: self.clock.time_s(first + 4 * i),
                    length_s: 4.0 * self.clock.step_s,
                    values: [five[0], five[1], five[2], five[3], five[4]],
                });
            }
        }
        stretches
    }

    /// The maximum near the highest of neighbouring samples: of the polynomial
    /// of degree six through seven samples, between the neighbours. Too few
    /// samples are their own maximum.
    fn maximum(self, at: usize) -> Maximum {
        let step = at + 1;
        if self.values.len() < POINTS {
            return Maximum {
                time_s: self.clock.time_s(step),
                value: self.values[at],
            };
        }
        let from = at.saturating_sub(REACH).min(self.values.len() - POINTS);
        let schedule = self.clock.schedule;
        let middle = schedule.time(step);
        let nodes: [f64; POINTS] = std::array::from_fn(|i| schedule.time(from + 1 + i) - middle);
        let values = std::array::from_fn(|i| self.values[from + i]);
        let equidistant = from + 1 >= schedule.first_full_step() && at == from + REACH;
        let polynomial = match equidistant {
            true => through_equidistant(values),
            false => through(nodes, values),
        };
        let at = at - from;
        let at = highest(&polynomial, nodes[at - 1], nodes[at + 1]);
        let (value, ..) = derivatives(&polynomial, at);
        Maximum {
            time_s: self.clock.step_s * (middle + at),
            value,
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equidistant_samples_need_no_differences() {
        let nodes = std::array::from_fn(|i| i as f64 - 3.0);
        let values = std::array::from_fn(|i| (0.7 * i as f64).sin() + 0.1 * (i * i) as f64);
        let [quick, slow] = [through_equidistant(values), through(nodes, values)];
        for (quick, slow) in quick.into_iter().zip(slow) {
            // Rounding alone.
            assert!((quick - slow).abs() < 1e-13, "{quick} {slow}");
        }
    }
}
