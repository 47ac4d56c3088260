//! The charge amplifier: charges of two piezo discs to one voltage.
//!
//! v = G (S₇ F₇ + S_w F_w), then a high-pass of first order,
//! H(s) = s/(s + ω_h), then a low-pass: ω/(s + ω), or Butterworth's
//! ω²/(s² + √2 ω s + ω²). Exact where forces are straight lines between
//! samples: see [`Hold`].

use crate::hold::{Hold, STATES};
use hertzchain_experiment::{Amplifier as Numbers, LowPass};
use std::f64::consts::{SQRT_2, TAU};

/// An amplifier at work on a sampling grid.
#[derive(Clone, Copy, Debug)]
pub struct Amplifier {
    hold: Hold,
    sensor_v_n: f64,
    wall_v_n: f64,
    /// What the high-pass has followed, what comes out, its rate over ω.
    state: [f64; STATES],
    input_v: f64,
}

impl Amplifier {
    /// At rest, without any input, for samples every `interval_s`.
    #[must_use]
    pub fn new(numbers: &Numbers, interval_s: f64) -> Self {
        let high = TAU * numbers.high_pass_hz;
        let low = TAU * numbers.low_pass_hz;
        let followed = [-high, 0.0, 0.0];
        let (a, b) = match numbers.order {
            LowPass::First => (
                [followed, [-low, -low, 0.0], [0.0; STATES]],
                [high, low, 0.0],
            ),
            LowPass::Second => (
                [followed, [0.0, 0.0, low], [-low, -low, -SQRT_2 * low]],
                [high, 0.0, low],
            ),
        };
        Self {
            hold: Hold::new(&a, &b, interval_s),
            sensor_v_n: numbers.gain_v_c * numbers.sensitivity_c_n,
            wall_v_n: numbers.gain_v_c * numbers.wall_sensitivity_c_n,
            state: [0.0; STATES],
            input_v: 0.0,
        }
    }

    /// The voltage at the next sample, at which the forces in N are these.
    #[inline]
    pub fn next(&mut self, sensor_n: f64, wall_n: f64) -> f64 {
        let input_v = self.voltage(sensor_n, wall_n);
        self.state = self.hold.step(&self.state, self.input_v, input_v);
        self.input_v = input_v;
        self.state[1]
    }

    fn voltage(&self, sensor_n: f64, wall_n: f64) -> f64 {
        self.sensor_v_n * sensor_n + self.wall_v_n * wall_n
    }
}
