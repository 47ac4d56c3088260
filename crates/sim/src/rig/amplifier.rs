//! The charge amplifier: charges of two piezo discs to one voltage.
//!
//! v = G (S₇ F₇ + S_w F_w), then a high-pass of first order,
//! H(s) = s/(s + ω_h), then a low-pass, a product of [factors](Factor) of first and second
//! order. A step is exact where forces are straight lines between samples: see [`Hold`].

use crate::rig::hold::Hold;
use hertzchain_experiment::{Amplifier as Numbers, Factor};
use std::f64::consts::TAU;

/// Most states: the high-pass's, and four of the low-pass.
const STATES: usize = 5;

/// States of the high-pass and of a low-pass of one factor.
const FEW: usize = 3;

/// An amplifier at work on a sampling grid.
#[derive(Clone, Copy, Debug)]
pub struct Amplifier {
    filter: Filter,
    sensor_v_n: f64,
    wall_v_n: f64,
    input_v: f64,
}

/// The filters with their states: what the high-pass has followed, then each factor's output
/// and, of one of second order, its rate over ω.
#[derive(Clone, Copy, Debug)]
enum Filter {
    Short(Hold<FEW>, [f64; FEW]),
    // With the number of the last factor's output.
    Long(Hold<STATES>, [f64; STATES], usize),
}

impl Amplifier {
    /// At rest, without any input, for samples every `interval_s`.
    #[must_use]
    pub fn new(numbers: &Numbers, interval_s: f64) -> Self {
        let filter = match numbers.factors() {
            [_] => {
                let (a, b, _) = system::<FEW>(numbers);
                Filter::Short(Hold::new(&a, &b, interval_s), [0.0; FEW])
            }
            _ => {
                let (a, b, output) = system::<STATES>(numbers);
                Filter::Long(Hold::new(&a, &b, interval_s), [0.0; STATES], output)
            }
        };
        Self {
            filter,
            sensor_v_n: numbers.gain_v_c * numbers.sensitivity_c_n,
            wall_v_n: numbers.gain_v_c * numbers.wall_sensitivity_c_n,
            input_v: 0.0,
        }
    }

    /// The voltage at the next sample, at which the forces in N are these.
    #[inline]
    pub fn next(&mut self, sensor_n: f64, wall_n: f64) -> f64 {
        let input_v = self.voltage(sensor_n, wall_n);
        let before_v = std::mem::replace(&mut self.input_v, input_v);
        match &mut self.filter {
            Filter::Short(hold, state) => {
                *state = hold.step(state, before_v, input_v);
                state[1]
            }
            Filter::Long(hold, state, output) => {
                *state = hold.step(state, before_v, input_v);
                state[*output]
            }
        }
    }

    /// Voltages at as many samples, at equal times, of forces in N that are smooth between them.
    pub fn follow(&mut self, count: usize, forces_n: impl Fn(usize) -> [f64; 2]) -> Vec<f64> {
        let last = count.saturating_sub(1);
        // Straight lines between samples are h²/12 of the second derivative above the force on
        // average: taken off the samples, that leaves an error of order h⁴.
        let one = |at: usize| {
            let [before, now, after] =
                [at.saturating_sub(1), at, (at + 1).min(last)].map(&forces_n);
            let lowered = |of: usize| now[of] - (before[of] - 2.0 * now[of] + after[of]) / 12.0;
            self.next(lowered(0), lowered(1))
        };
        (0..count).map(one).collect()
    }

    fn voltage(&self, sensor_n: f64, wall_n: f64) -> f64 {
        self.sensor_v_n * sensor_n + self.wall_v_n * wall_n
    }
}

/// A and B of both filters in 1/s, and which state is the output. The input less the first
/// state passes the high-pass; of each factor the output is the next one's input.
fn system<const N: usize>(numbers: &Numbers) -> ([[f64; N]; N], [f64; N], usize) {
    let (mut a, mut b) = ([[0.0; N]; N], [0.0; N]);
    let high = TAU * numbers.high_pass_hz;
    (a[0][0], b[0]) = (-high, high);
    let (mut output, mut next) = (0, 1);
    for factor in numbers.factors() {
        let (rate, driven, damping) = match *factor {
            Factor::One { frequency } => (frequency, next, None),
            Factor::Two { frequency, damping } => (frequency, next + 1, Some(damping)),
        };
        let rate = TAU * numbers.low_pass_hz * rate;
        // Of the state that the input drives.
        match output {
            0 => (a[driven][0], b[driven]) = (-rate, rate),
            before => a[driven][before] = rate,
        }
        a[driven][next] = -rate;
        if let Some(damping) = damping {
            a[next][driven] = rate;
            a[driven][driven] = -damping * rate;
        }
        (output, next) = (next, driven + 1);
    }
    (a, b, output)
}
