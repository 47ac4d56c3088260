//! Shapes of pulses.

use crate::signal::error::{SignalError, all_finite};
use crate::signal::picks::polynomial::Polynomial;

/// A pulse's shape: 1 at its maximum, at z = 0; its full width at half maximum is 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape(Kind);

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    /// cos^power(turn · z) while |turn · z| < π/2.
    Cos { power: f64, turn: f64 },
    /// sech^power(turn · z).
    Sech { power: f64, turn: f64 },
    /// Samples, of which `width` make a full width, with the maximum at `top`.
    Sampled {
        samples: Vec<f64>,
        top: f64,
        width: f64,
    },
}

impl Shape {
    /// cos^p of one half turn and 0 beyond: a bell that ends. p = 6 is the force
    /// of a solitary wave of Hertz contacts in the long-wave limit
    /// \[Nesterenko1983\], where overlaps go as cos⁴ and forces as their power 3/2.
    ///
    /// Powers below 2 have no smooth end and count as 2.
    #[must_use]
    pub fn cos_power(power: f64) -> Self {
        let power = power.max(2.0);
        let turn = 2.0 * 0.5_f64.powf(power.recip()).acos();
        Self(Kind::Cos { power, turn })
    }

    /// sech^p: a bell with exponential flanks, as solitary waves of weakly
    /// nonlinear lattices have. Powers below 0.1 count as 0.1.
    #[must_use]
    pub fn sech_power(power: f64) -> Self {
        let power = power.max(0.1);
        let turn = 2.0 * 2.0_f64.powf(power.recip()).acosh();
        Self(Kind::Sech { power, turn })
    }

    /// The shape of a sampled pulse that starts and ends near 0; its largest
    /// maximum is its time, its sampling interval does not matter.
    ///
    /// Between samples by cubics with a continuous slope (Catmull–Rom).
    ///
    /// # Errors
    /// Fewer than 8 samples; not finite; no maximum inside, or no half height on
    /// either side of it.
    pub fn sampled(samples: &[f64]) -> Result<Self, SignalError> {
        SignalError::enough(samples.len(), 8)?;
        all_finite(samples)?;
        let no_top = SignalError::Option {
            name: "number of samples of the template",
            value: samples.len() as f64,
            expected: "a whole pulse: a maximum with half its height on either side",
        };
        let (top, height, width) = measures(samples).ok_or(no_top)?;
        let samples = samples.iter().map(|x| x / height).collect();
        Ok(Self(Kind::Sampled {
            samples,
            top,
            width,
        }))
    }

    /// Value at z.
    #[must_use]
    pub fn value(&self, z: f64) -> f64 {
        self.value_slope(z).0
    }

    /// Slope at z.
    #[must_use]
    pub fn slope(&self, z: f64) -> f64 {
        self.value_slope(z).1
    }

    /// Value and slope at z.
    #[must_use]
    pub fn value_slope(&self, z: f64) -> (f64, f64) {
        match &self.0 {
            Kind::Cos { power, turn } => {
                let cos = (turn * z).cos();
                if (turn * z).abs() >= std::f64::consts::FRAC_PI_2 || cos <= 0.0 {
                    return (0.0, 0.0);
                }
                let below = cos.powf(power - 1.0);
                (below * cos, -power * turn * below * (turn * z).sin())
            }
            Kind::Sech { power, turn } => {
                let value = (turn * z).cosh().powf(-power);
                (value, -power * turn * (turn * z).tanh() * value)
            }
            Kind::Sampled {
                samples,
                top,
                width,
            } => {
                let (value, slope) = cubic(samples, top + z * width);
                (value, slope * width)
            }
        }
    }
}

/// Maximum in samples, height, and full width at half maximum of a sampled pulse.
fn measures(samples: &[f64]) -> Option<(f64, f64, f64)> {
    let largest = |best: usize, i: usize| {
        if samples[i] > samples[best] { i } else { best }
    };
    let at = (0..samples.len()).fold(0, largest);
    let half = 0.5 * samples[at];
    let left = (0..at).rev().find(|i| samples[*i] < half)?;
    let right = (at..samples.len()).find(|i| samples[*i] < half)?;
    // Near enough for a quartic to follow any bell.
    let reach = (0.2 * (right - left) as f64).max(2.0);
    let fit = Polynomial::through(samples, 0.0, at as f64, reach, 4)?;
    let top = fit.top()?;
    let height = fit.course(top).value;
    let crossing = |out: usize, inner: usize| {
        let (low, high) = (samples[out], samples[inner]);
        let part = (0.5 * height - low) / (high - low);
        out as f64 + part * (inner as f64 - out as f64)
    };
    let width = crossing(right, right - 1) - crossing(left, left + 1);
    (height > 0.0 && width > 1.0).then(|| (fit.sample(top), height, width))
}

/// Value and slope a sample of the cubic through four samples; 0 outside.
fn cubic(samples: &[f64], at: f64) -> (f64, f64) {
    if !(at >= 0.0 && at <= (samples.len() - 1) as f64) {
        return (0.0, 0.0);
    }
    let left = (at as usize).min(samples.len() - 2);
    let u = at - left as f64;
    let get = |i: Option<usize>, end: f64| i.and_then(|i| samples.get(i)).copied().unwrap_or(end);
    let (b, c) = (samples[left], samples[left + 1]);
    let a = get(left.checked_sub(1), b);
    let d = get(Some(left + 2), c);
    let linear = 0.5 * (c - a);
    let square = a - 2.5 * b + 2.0 * c - 0.5 * d;
    let cube = 0.5 * (d - a) + 1.5 * (b - c);
    let value = b + u * (linear + u * (square + u * cube));
    (value, linear + u * (2.0 * square + 3.0 * u * cube))
}

#[cfg(test)]
#[path = "tests/shape.rs"]
mod tests;
