//! Shapes of pulses, their fits to whole pulses, and the least spread of a pick.

use super::{ChannelView, Picked, Systematic};
use crate::signal::Pulse;
use crate::signal::error::{SignalError, all_finite};
use crate::signal::linear::{MOST, NormalEquations, Polynomial, Row, levenberg_marquardt};

/// A pulse's shape: 1 at its maximum, at z = 0; its full width at half maximum is 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape(Form);

#[derive(Clone, Debug, PartialEq)]
enum Form {
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
    /// cos^p of one half turn and 0 beyond. p = 6 is the force of a solitary wave of Hertz contacts
    /// in the long-wave limit \[Nesterenko1983\], where overlaps go as cos⁴ and forces as their
    /// power 3/2.
    ///
    /// Powers below 2 have no smooth end and count as 2.
    #[must_use]
    pub fn cos_power(power: f64) -> Self {
        let power = power.max(2.0);
        let turn = 2.0 * 0.5_f64.powf(power.recip()).acos();
        Self(Form::Cos { power, turn })
    }

    /// sech^p: a bell with exponential flanks, as solitary waves of weakly
    /// nonlinear lattices have. Powers below 0.1 count as 0.1.
    #[must_use]
    pub fn sech_power(power: f64) -> Self {
        let power = power.max(0.1);
        let turn = 2.0 * 2.0_f64.powf(power.recip()).acosh();
        Self(Form::Sech { power, turn })
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
        let (top, height, width) = measures(samples).ok_or(SignalError::Option {
            name: "number of samples of the template",
            value: samples.len() as f64,
            expected: "a whole pulse: a maximum with half its height on either side",
        })?;
        Ok(Self(Form::Sampled {
            samples: samples.iter().map(|x| x / height).collect(),
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
    pub(crate) fn slope(&self, z: f64) -> f64 {
        self.value_slope(z).1
    }

    /// Value and slope at z.
    pub(crate) fn value_slope(&self, z: f64) -> (f64, f64) {
        match &self.0 {
            Form::Cos { power, turn } => {
                let cos = (turn * z).cos();
                if (turn * z).abs() >= std::f64::consts::FRAC_PI_2 || cos <= 0.0 {
                    return (0.0, 0.0);
                }
                let below = cos.powf(power - 1.0);
                (below * cos, -power * turn * below * (turn * z).sin())
            }
            Form::Sech { power, turn } => {
                let value = (turn * z).cosh().powf(-power);
                (value, -power * turn * (turn * z).tanh() * value)
            }
            Form::Sampled {
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
    let top = fit.maximum()?;
    let height = fit.at(top).value;
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

/// Time in samples of a shape fitted to a whole pulse: least squares of height, time in samples,
/// width in samples and offset; covariance noise² (JᵀJ)⁻¹. Clipped samples are left out.
pub(super) fn pick(
    view: &ChannelView<'_>,
    pulse: &Pulse,
    shape: &Shape,
    width: f64,
) -> Result<Picked, SignalError> {
    let points = points(view, pulse, width);
    let found = levenberg_marquardt(
        [pulse.height, pulse.at as f64, pulse.width_samples, 0.0],
        |model| is_same_pulse(model, pulse).then(|| normal(&points, model, shape)),
        |model, step| std::array::from_fn(|k| model[k] + step[k]),
        |before, after| (after[1] - before[1]).abs() < 1e-9 * pulse.width_samples,
    );
    let solved = found.and_then(|found| Some((found.normal.solve()?, found)));
    let no_fit = SignalError::NoPick(pulse.kind, "fit of the shape");
    let (solution, found) = solved.ok_or(no_fit)?;
    let [height, time_s, width_s, _] = found.model;
    let noise = view.broad_noise(pulse);
    let sigma = |k: usize| noise * solution.inverse[k][k].sqrt();
    let freedom = points.len().saturating_sub(found.model.len()).max(1);
    Ok(Picked {
        time_s,
        sigma_s: sigma(1),
        systematic: Systematic::default(),
        height,
        height_sigma: sigma(0),
        width_s,
        misfit: view.misfit(pulse, (found.squares / freedom as f64).sqrt()),
    })
}

/// Numbers and heights of the samples to be fitted.
fn points(view: &ChannelView<'_>, pulse: &Pulse, width: f64) -> Vec<(f64, f64)> {
    let half = (0.5 * width * pulse.width_samples).max(3.0);
    let at = pulse.at as f64;
    let (first, heights) = view.window(at - half, at + half);
    let clipped = |sample: usize| {
        let at_end = |range: super::DigitiserRange| range.clips(view.samples[sample]);
        view.range.is_some_and(at_end) || pulse.is_clipped(sample)
    };
    let points = (first..).zip(heights);
    let points = points.filter(|(sample, _)| !clipped(*sample));
    points
        .map(|(sample, height)| (sample as f64, height))
        .collect()
}

/// Normal equations of a step from a model, and the model's sum of squares.
fn normal(points: &[(f64, f64)], model: &[f64; 4], shape: &Shape) -> (NormalEquations, f64) {
    let [height, time, width, offset] = *model;
    let mut normal = NormalEquations::new(model.len());
    let mut squares = 0.0;
    for (at, sample) in points {
        let z = (at - time) / width;
        let (value, slope) = shape.value_slope(z);
        let residual = sample - offset - height * value;
        let by_time = -height * slope / width;
        let mut row: Row = [0.0; MOST];
        row[..4].copy_from_slice(&[value, by_time, by_time * z, 1.0]);
        normal.add(&row, residual);
        squares += residual * residual;
    }
    (normal, squares)
}

/// Still the same pulse: positive, near where it was, not out of all proportion.
fn is_same_pulse([height, time, width, _]: &[f64; 4], pulse: &Pulse) -> bool {
    let widths = width / pulse.width_samples;
    let moved = (time - pulse.at as f64).abs();
    *height > 0.0 && (0.2..5.0).contains(&widths) && moved < pulse.width_samples
}

/// Cramér–Rao bound of a pulse's time in s, the least spread of any unbiased pick, for a known
/// shape in white noise of deviation `noise` a sample: σ ≥ noise/√(Σ_i s'(t_i)²).
///
/// It holds with height, width and offset known. For symmetric shapes it is
/// the same when they are not, as time does not correlate with them. A delay
/// between two pulses has the root of the sum of both squares.
#[must_use]
pub fn cramer_rao_s(shape: &Shape, height: f64, width_s: f64, interval_s: f64, noise: f64) -> f64 {
    // The sum over samples is an integral over z, as good as exact for a smooth bell.
    let step = 1e-3;
    let slopes = (-5000..=5000).map(|i| shape.slope(f64::from(i) * step).powi(2));
    let squares = step * slopes.sum::<f64>() / (width_s * interval_s);
    noise / (height.abs() * squares.sqrt())
}

/// As [`cramer_rao_s`], of a sampled noiseless pulse, by central differences.
#[must_use]
pub fn cramer_rao_of_samples_s(pulse: &[f64], interval_s: f64, noise: f64) -> f64 {
    let slopes = pulse.windows(3).map(|w| 0.5 * (w[2] - w[0]) / interval_s);
    noise / slopes.map(|s| s * s).sum::<f64>().sqrt()
}

#[cfg(test)]
#[path = "../tests/bound.rs"]
mod bound_tests;
#[cfg(test)]
#[path = "../tests/shape.rs"]
mod tests;
