//! The maximum of a pulse before an amplifier's low-pass, from that behind it.

use super::normal::MOST;
use super::polynomial::Polynomial;
use crate::signal::error::SignalError;
use std::f64::consts::{SQRT_2, TAU};

/// An amplifier's low-pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bandwidth {
    /// Its corner in Hz, where 3 dB are missing.
    pub corner_hz: f64,
    /// 1: one pole. 2: a Butterworth filter's two.
    pub order: usize,
}

impl Bandwidth {
    /// Coefficients a and b of the inverse x = y + a y′ + b y″, in samples.
    pub(crate) fn inverse(&self, interval_s: f64) -> Result<[f64; 2], SignalError> {
        SignalError::positive("corner of the amplifier's low-pass in Hz", self.corner_hz)?;
        let samples = (TAU * self.corner_hz * interval_s).recip();
        match self.order {
            1 => Ok([samples, 0.0]),
            2 => Ok([SQRT_2 * samples, samples * samples]),
            order => Err(SignalError::Option {
                name: "order of the amplifier's low-pass",
                value: order as f64,
                expected: "1 or 2",
            }),
        }
    }
}

/// Slope over value of x = y + a y′ + b y″ at one place of a bell y, in units of u.
pub(super) struct Slope {
    pub(super) value: f64,
    /// Its own rate of change.
    pub(super) bend: f64,
    /// How it changes with the coefficients of the bell's logarithm.
    pub(super) row: [f64; MOST],
}

impl Slope {
    /// Of y = exp(Σ c_k u^k), with a and b in samples.
    pub(super) fn of(bell: &Polynomial, [a, b]: [f64; 2], u: f64) -> Self {
        let (a, b) = (a / bell.half, b / bell.half.powi(2));
        let rows = derivatives(u);
        let of = |row: &[f64; MOST]| -> f64 {
            let terms = row.iter().zip(&bell.solution.values);
            terms.take(bell.degree + 1).map(|(r, c)| r * c).sum()
        };
        let [p, q, r, s] = rows.each_ref().map(of);
        // y′ = p y, y″ = (q + p²) y, y‴ = (r + 3 p q + p³) y.
        let weights = [
            1.0 + 2.0 * a * p + 3.0 * b * (q + p * p),
            a + 3.0 * b * p,
            b,
        ];
        Self {
            value: p + a * (q + p * p) + b * (r + 3.0 * p * q + p.powi(3)),
            bend: weights[0] * q + weights[1] * r + weights[2] * s,
            row: std::array::from_fn(|k| (0..3).map(|i| weights[i] * rows[i][k]).sum()),
        }
    }

    /// Where it falls through 0, from the bell's own maximum on.
    pub(super) fn top(bell: &Polynomial, inverse: [f64; 2], from: f64) -> Option<f64> {
        let mut u = from;
        for _ in 0..40 {
            let at = Self::of(bell, inverse, u);
            let by = (at.bend < 0.0).then(|| -at.value / at.bend)?;
            u += by.clamp(-0.2, 0.2);
            if u.is_nan() || u.abs() > 1.0 {
                return None;
            }
            if by.abs() < 1e-12 {
                break;
            }
        }
        Some(u)
    }
}

/// Rows of the first four derivatives of Σ c_k u^k.
fn derivatives(u: f64) -> [[f64; MOST]; 4] {
    let mut rows = [[0.0; MOST]; 4];
    for (order, row) in rows.iter_mut().enumerate() {
        for (k, term) in row.iter_mut().enumerate().skip(order + 1) {
            let falling: usize = (0..=order).map(|i| k - i).product();
            *term = falling as f64 * u.powi((k - order - 1) as i32);
        }
    }
    rows
}
