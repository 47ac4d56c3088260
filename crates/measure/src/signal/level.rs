//! Baseline and noise of a quiet stretch.

use crate::signal::error::{SignalError, all_finite};

/// Offset and noise of a channel at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Value at rest, in the samples' unit.
    pub offset: f64,
    /// Standard deviation of one sample.
    pub noise: f64,
    /// 1 + 2 Σ ρ_k over the noise's autocorrelation ρ: 1 when neighbouring
    /// samples are independent. A mean over many samples has this times the
    /// variance it would have then.
    pub correlation: f64,
    /// From how many samples the above was found; 0 if there was no quiet stretch.
    pub quiet_samples: usize,
}

impl Level {
    /// Noise that counts in whatever averages over many samples: √(noise² · correlation).
    #[must_use]
    pub fn broad_noise(&self) -> f64 {
        self.noise * self.correlation.sqrt()
    }
}

/// Standard deviation over median absolute deviation, normal distribution.
pub(crate) const NORMAL_MAD: f64 = 1.482_602_218_505_602;

/// Median, by partial sorting; the lower middle one of an even number. `None` without values.
#[must_use]
pub fn median(values: &[f64]) -> Option<f64> {
    let mut values = values.to_vec();
    let middle = values.len().checked_sub(1)? / 2;
    let (_, median, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    Some(*median)
}

/// Median and 1.4826 times the median absolute deviation from it.
pub(crate) fn median_and_spread(values: &[f64]) -> Option<(f64, f64)> {
    let centre = median(values)?;
    let far: Vec<f64> = values.iter().map(|x| (x - centre).abs()).collect();
    Some((centre, NORMAL_MAD * median(&far)?))
}

/// Baseline and noise of samples before the first pulse.
///
/// Median and median absolute deviation mark what is beyond five standard
/// deviations; mean and standard deviation are taken of the rest. So a stray
/// spike does no harm, and steps of a coarse digitiser do not show.
///
/// # Errors
/// [`SignalError::TooShort`] below 8 samples, [`SignalError::NotFinite`].
pub fn level(quiet: &[f64]) -> Result<Level, SignalError> {
    SignalError::enough(quiet.len(), 8)?;
    all_finite(quiet)?;
    let calm = calm(quiet);
    let quiet_samples = quiet.len();
    let quiet = calm.as_slice();
    let (centre, spread) = median_and_spread(quiet).unwrap_or_default();
    let reach = (5.0 * spread).max(3.0 * smallest_step(quiet, centre));
    // Differences from the median keep the digits of a small noise on a large offset.
    let kept = |x: &f64| Some(x - centre).filter(|d| d.abs() <= reach);
    let inner: Vec<f64> = quiet.iter().filter_map(kept).collect();
    let mean = inner.iter().sum::<f64>() / inner.len() as f64;
    let squares: f64 = inner.iter().map(|d| (d - mean).powi(2)).sum();
    let noise = (squares / (inner.len() as f64 - 1.0).max(1.0)).sqrt();
    let clipped: Vec<f64> = quiet
        .iter()
        .map(|x| (x - centre - mean).clamp(-reach, reach))
        .collect();
    Ok(Level {
        offset: centre + mean,
        noise,
        correlation: correlation(&clipped),
        quiet_samples,
    })
}

/// Parts into which a quiet stretch is divided.
const PARTS: usize = 64;
/// Robust deviations of the parts' means beyond which one holds more than noise.
const MORE: f64 = 4.0;

/// The samples but for parts whose mean lies far off, and their neighbours: a small pulse before the first
/// one, or what crosses over from another channel, is no noise.
fn calm(quiet: &[f64]) -> Vec<f64> {
    let length = (quiet.len() / PARTS).max(8);
    let parts: Vec<&[f64]> = quiet.chunks(length).collect();
    let mean = |part: &&[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let means: Vec<f64> = parts.iter().map(mean).collect();
    let (centre, spread) = median_and_spread(&means).unwrap_or_default();
    let is_off = |at: usize| {
        let mean = means.get(at);
        mean.is_some_and(|mean| (mean - centre).abs() > MORE * spread)
    };
    let is_calm = |at: &usize| !(is_off(*at) || is_off(at + 1) || (*at > 0 && is_off(at - 1)));
    let calm = (0..parts.len()).filter(is_calm);
    let kept: Vec<f64> = calm.flat_map(|at| parts[at]).copied().collect();
    // Where that is not plain, all of them are.
    match spread > 0.0 && 2 * kept.len() > quiet.len() {
        true => kept,
        false => quiet.to_vec(),
    }
}

/// Smallest difference from `centre` that is not 0: the digitiser's step, if there is one.
fn smallest_step(samples: &[f64], centre: f64) -> f64 {
    let steps = samples.iter().map(|x| (x - centre).abs());
    let least = steps.filter(|d| *d > 0.0).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

/// 1 + 2 Σ ρ_k until the first ρ_k within twice its own error, which in white
/// noise is the first of all.
fn correlation(noise: &[f64]) -> f64 {
    let lagged = |k: usize| -> f64 {
        let later = noise.iter().skip(k);
        noise.iter().zip(later).map(|(a, b)| a * b).sum()
    };
    let power = lagged(0);
    let least = 2.0 / (noise.len() as f64).sqrt();
    let mut sum = 1.0;
    for k in 1..noise.len() / 4 {
        let rho = lagged(k) / power;
        if rho.abs() < least || rho.is_nan() {
            break;
        }
        sum += 2.0 * rho;
    }
    sum.max(0.1)
}

#[cfg(test)]
#[path = "tests/level.rs"]
mod tests;
