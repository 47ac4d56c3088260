//! A pulse's shape fitted to the whole of it.

use super::{ChannelView, Picked, Systematic};
use crate::error::{MeasureError, Result};
use crate::signal::Pulse;
use crate::signal::linear::{NormalEquations, levenberg_marquardt};

/// A pulse's shape cos^p of one half turn, and 0 beyond: 1 at its maximum, at z = 0; its full width
/// at half maximum is 1. p = 6 is the force of a solitary wave of Hertz contacts in the long-wave
/// limit \[Nesterenko1983\], where overlaps go as cos⁴ and forces as their power 3/2.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    power: f64,
    turn: f64,
}

impl Shape {
    /// Powers below 2 have no smooth end and count as 2.
    pub fn cos_power(power: f64) -> Self {
        let power = power.max(2.0);
        let turn = 2.0 * 0.5_f64.powf(power.recip()).acos();
        Self { power, turn }
    }

    /// Value at z.
    pub fn value(&self, z: f64) -> f64 {
        self.value_slope(z).0
    }

    fn value_slope(&self, z: f64) -> (f64, f64) {
        let Self { power, turn } = self;
        let cos = (turn * z).cos();
        if (turn * z).abs() >= std::f64::consts::FRAC_PI_2 || cos <= 0.0 {
            return (0.0, 0.0);
        }
        let below = cos.powf(power - 1.0);
        (below * cos, -power * turn * below * (turn * z).sin())
    }
}

/// Time in samples of a shape fitted to a whole pulse: least squares of height, time in samples,
/// width in samples and offset; covariance noise² (JᵀJ)⁻¹. Clipped samples are left out.
pub(super) fn pick(
    view: &ChannelView<'_>,
    pulse: &Pulse,
    shape: &Shape,
    width: f64,
) -> Result<Picked> {
    let points = points(view, pulse, width);
    let found = levenberg_marquardt(
        [pulse.height, pulse.at as f64, pulse.width_samples, 0.0],
        |model| is_same_pulse(model, pulse).then(|| normal(&points, model, shape)),
        |model, step| std::array::from_fn(|k| model[k] + step[k]),
        |before, after| (after[1] - before[1]).abs() < 1e-9 * pulse.width_samples,
    );
    let solved = found.and_then(|found| Some((found.normal.solve()?, found)));
    let no_fit = MeasureError::NoPick(pulse.kind, "fit of the shape");
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
        signal_to_noise: height / view.noise(pulse),
        misfit: view.misfit(pulse, (found.squares / freedom as f64).sqrt()),
    })
}

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
    points.map(|(sample, height)| (sample as f64, height)).collect()
}

fn normal(points: &[(f64, f64)], model: &[f64; 4], shape: &Shape) -> (NormalEquations<4>, f64) {
    let [height, time, width, offset] = *model;
    let mut normal = NormalEquations::new(model.len());
    let mut squares = 0.0;
    for (at, sample) in points {
        let z = (at - time) / width;
        let (value, slope) = shape.value_slope(z);
        let residual = sample - offset - height * value;
        let by_time = -height * slope / width;
        normal.add(&[value, by_time, by_time * z, 1.0], residual);
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

#[cfg(test)]
#[path = "../tests/shape.rs"]
mod tests;
