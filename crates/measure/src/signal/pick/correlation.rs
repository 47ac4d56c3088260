//! Where a template correlates best with the signal, and the delay between two sampled pulses.

use super::polynomial::pick_roughly;
use super::{ChannelView, Picked};
use crate::error::{MeasureError, Result};
use crate::signal::Pulse;
use crate::signal::filters::triangular_mean;

/// Half the length of a template, in full widths at half maximum: a bell is
/// down to some 10⁻⁴ there.
const REACH: f64 = 1.4;
/// Length of the running means that smooth a noisy template, in full widths: without
/// them noise of the template times noise of the signal spoils the correlation,
/// and with them hardly any of the pulse is lost.
const SMOOTHING: f64 = 0.2;
/// Lags, as a share of a template's length, between which the curvature of a correlation is taken:
/// a third of a width or so, over which noise does not hide it and a bell's falls short of it by
/// 6 %.
const APART: f64 = 0.3 / (2.0 * REACH);
/// Least share of a template's slopes squared that is taken for the pulse's, not noise's.
const LEAST: f64 = 0.25;

/// The incident pulse as template. An offset of the signal adds the same to its correlation at all
/// lags, and so does not matter.
pub(super) struct Correlator {
    template: Vec<f64>,
    top: f64,
    /// Σ t'² over its samples.
    slopes: f64,
    /// Sample and pick of the pulse itself, which is as noisy: its time is its maximum's.
    own: (usize, Picked),
}

impl Correlator {
    pub(super) fn new(sensor: &ChannelView<'_>, pulse: &Pulse) -> Result<Self> {
        if pulse.clipped.is_some() {
            let what = "top to be a template, clipped as it is,";
            return Err(MeasureError::NoPick(pulse.kind, what));
        }
        let picked = pick_roughly(sensor, pulse)?;
        let reach = REACH * pulse.width_samples;
        let at = picked.time_s;
        let (first, heights) = sensor.window(at - reach, at + reach);
        let length = (SMOOTHING * pulse.width_samples) as usize | 1;
        let template = triangular_mean(&heights, length);
        let slopes = template.windows(3).map(|three| 0.5 * (three[2] - three[0]));
        let slopes = slopes.map(|s| s * s).sum::<f64>();
        let noise = sensor.broad_noise(pulse);
        // Slopes of the smoothed noise have 2/length³ of its variance a sample.
        let of_noise = 2.0 * heights.len() as f64 * noise * noise / (length as f64).powi(3);
        let of_pulse = (slopes - of_noise).max(LEAST * slopes);
        let sigma_s = noise / of_pulse.sqrt();
        Ok(Self {
            template,
            top: at - first as f64,
            slopes,
            own: (pulse.at, picked.by_fit(at, sigma_s, None)),
        })
    }

    /// Time in samples. Variance: noise² Σ t'²/(Σ t' s')², with t the template, its own noise
    /// included, and s the signal, Σ t' s' being the curvature of their correlation. Noise of the
    /// record's own pulse counts at the incident pulse, as it is common to all delays against it:
    /// noise²/Σ t'², without the noise in t.
    pub(super) fn pick(&self, view: &ChannelView<'_>, pulse: &Pulse) -> Result<Picked> {
        if self.own.0 == pulse.at {
            return Ok(self.own.1);
        }
        let at_top = pick_roughly(view, pulse)?;
        let best = self.best_lag(view, pulse);
        let none = MeasureError::NoPick(pulse.kind, "largest correlation");
        let (time_s, curvature) = best.ok_or(none)?;
        let sigma_s = view.broad_noise(pulse) * self.slopes.sqrt() / curvature;
        Ok(at_top.by_fit(time_s, sigma_s, None))
    }

    /// Where the template's maximum lies when the correlation is largest, and its curvature there,
    /// a sample squared.
    fn best_lag(&self, view: &ChannelView<'_>, pulse: &Pulse) -> Option<(f64, f64)> {
        let search = (0.5 * pulse.width_samples).ceil() + 3.0;
        let length = self.template.len();
        let start = (pulse.at as f64 - self.top - search).round();
        let lags = 2 * search as usize + 1;
        let apart = ((APART * length as f64) as usize).max(1);
        let from = start - apart as f64;
        // 0 outside the record.
        let padded = |i: usize| {
            let at = from + i as f64;
            let height = (at >= 0.0).then(|| view.height(at as usize));
            height.flatten().unwrap_or(0.0)
        };
        let heights: Vec<f64> = (0..length + lags + 2 * apart).map(padded).collect();
        let at = |lag: usize| -> f64 {
            let pairs = self.template.iter().zip(&heights[lag..]);
            pairs.map(|(a, b)| a * b).sum()
        };
        let correlations: Vec<f64> = (apart..apart + lags).map(at).collect();
        let (best, refined) = refined_maximum(&correlations)?;
        let curvature = 2.0 * correlations[best] - at(best) - at(best + 2 * apart);
        let curvature = curvature / (apart * apart) as f64;
        let time = start + best as f64 + refined + self.top;
        (curvature > 0.0).then_some((time, curvature))
    }
}

/// Delay in s of `later` against `earlier`: the lag of the largest
/// cross-correlation Σ_i earlier_i · later_{i+k}, both taken as 0 outside their
/// samples, refined between samples by the quartic through the five
/// correlations around the largest.
///
/// Negative when `later` comes first. `None` when either slice is empty, is 0
/// throughout or holds numbers that are not finite. The cost is the product of the two lengths.
pub fn delay_by_cross_correlation(earlier: &[f64], later: &[f64], interval_s: f64) -> Option<f64> {
    let behind = isize::try_from(earlier.len()).ok()?;
    let ahead = isize::try_from(later.len()).ok()?;
    let correlation = |lag: isize| -> f64 {
        let skip = |n: isize| usize::try_from(n).unwrap_or(0);
        let later = later.iter().skip(skip(lag));
        let pairs = earlier.iter().skip(skip(-lag)).zip(later);
        pairs.map(|(a, b)| a * b).sum()
    };
    // Two lags beyond either end keep the five points inside.
    let first = -behind - 1;
    let correlations: Vec<f64> = (first..ahead + 2).map(correlation).collect();
    let (best, refined) = refined_maximum(&correlations)?;
    Some(((first + best as isize) as f64 + refined) * interval_s)
}

/// Index of the largest positive value, the first of equals, and where the quartic through it and
/// two neighbours on either side is largest.
fn refined_maximum(values: &[f64]) -> Option<(usize, f64)> {
    let mut best: Option<usize> = None;
    for (i, value) in values.iter().enumerate() {
        if !value.is_finite() {
            return None;
        }
        if *value > best.map_or(0.0, |b| values[b]) {
            best = Some(i);
        }
    }
    let best = best?;
    let five = values.get(best.checked_sub(2)?..best + 3)?;
    Some((best, quartic_maximum(five.try_into().ok()?)))
}

/// Where the quartic through values at −2..=2 is largest near 0.
fn quartic_maximum([a, b, c, d, e]: [f64; 5]) -> f64 {
    let slope = (a - 8.0 * b + 8.0 * d - e) / 12.0;
    let curvature = (-a + 16.0 * b - 30.0 * c + 16.0 * d - e) / 12.0;
    let third = (-a + 2.0 * b - 2.0 * d + e) / 2.0;
    let fourth = a - 4.0 * b + 6.0 * c - 4.0 * d + e;
    let mut at = 0.0;
    // Newton's method on the rate; a parabola's answer is its first iterate.
    for _ in 0..8 {
        let rate = slope + at * (curvature + at * (third / 2.0 + at * fourth / 6.0));
        let bend = curvature + at * (third + at * fourth / 2.0);
        if bend >= 0.0 || bend.is_nan() {
            return 0.0;
        }
        at = (at - rate / bend).clamp(-1.0, 1.0);
    }
    at
}

#[cfg(test)]
#[path = "../tests/delay.rs"]
mod tests;
