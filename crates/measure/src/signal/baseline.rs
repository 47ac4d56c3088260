//! Baseline and noise of a quiet stretch.

use crate::error::{MeasureError, Result, all_finite};
use crate::signal::statistics::{mean, median_and_spread, squares_about_mean};

/// Offset and noise of a channel at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Baseline {
    /// Value at rest, in the samples' unit.
    pub offset: f64,
    /// Standard deviation of one sample.
    pub noise: f64,
    /// 1 + 2 Σ ρ_k over the noise's autocorrelation ρ, 1 for white noise: the factor by which
    /// correlation raises the variance of a mean over many samples.
    pub correlation: f64,
    /// Number of samples of the quiet stretch; 0 if there was none.
    pub quiet_samples: usize,
    /// Standard deviation of the offset where there was no such stretch, in the samples' unit; else 0.
    pub offset_sigma: f64,
}

impl Baseline {
    /// Noise for averages over many samples: √(noise² · correlation).
    pub(crate) fn broad_noise(&self) -> f64 {
        self.noise * self.correlation.sqrt()
    }
}

/// Baseline and noise of samples before the first pulse.
///
/// Samples beyond five robust standard deviations of the median are left out of mean and standard
/// deviation.
///
/// # Errors
/// [`MeasureError::TooShort`] below 8 samples, [`MeasureError::NotFinite`].
pub fn baseline(quiet: &[f64]) -> Result<Baseline> {
    MeasureError::enough(quiet.len(), 8)?;
    all_finite(quiet)?;
    let calm = calm(quiet);
    let (centre, spread) = median_and_spread(&calm).unwrap_or_default();
    let differences = || calm.iter().map(|x| x - centre);
    // The digitiser's step: a spread of 0 must not leave out what is one step off.
    let steps = differences().map(f64::abs).filter(|d| *d > 0.0);
    let step = steps.fold(f64::INFINITY, f64::min);
    let step = if step.is_finite() { step } else { 0.0 };
    let reach = (5.0 * spread).max(3.0 * step);
    // Differences from the median keep the digits of a small noise on a large offset.
    let inner: Vec<f64> = differences().filter(|d| d.abs() <= reach).collect();
    let mean = mean(&inner);
    let noise = (squares_about_mean(&inner) / (inner.len() as f64 - 1.0).max(1.0)).sqrt();
    let clipped = differences().map(|d| (d - mean).clamp(-reach, reach));
    Ok(Baseline {
        offset: centre + mean,
        noise,
        correlation: correlation(&clipped.collect::<Vec<_>>()),
        quiet_samples: quiet.len(),
        offset_sigma: 0.0,
    })
}

const PARTS: usize = 64;
/// Robust deviations of the parts' means beyond which one holds more than noise.
const MORE: f64 = 4.0;

/// The samples without parts whose mean lies far off, and their neighbours: a small pulse before
/// the first one, or crosstalk, is no noise.
fn calm(quiet: &[f64]) -> Vec<f64> {
    let length = (quiet.len() / PARTS).max(8);
    let parts: Vec<&[f64]> = quiet.chunks(length).collect();
    let means: Vec<f64> = parts.iter().map(|part| mean(part)).collect();
    let (centre, spread) = median_and_spread(&means).unwrap_or_default();
    let is_off = |at: usize| {
        let mean = means.get(at);
        mean.is_some_and(|mean| (mean - centre).abs() > MORE * spread)
    };
    let is_calm = |at: &usize| !(is_off(*at) || is_off(at + 1) || (*at > 0 && is_off(at - 1)));
    let calm = (0..parts.len()).filter(is_calm);
    let calm: Vec<f64> = calm.flat_map(|at| parts[at]).copied().collect();
    match spread > 0.0 && 2 * calm.len() > quiet.len() {
        true => calm,
        false => quiet.to_vec(),
    }
}

/// 1 + 2 Σ ρ_k until the first ρ_k within twice its own error, which in white noise is the first of all, or below
/// 0 where neighbours are alike: the half periods of a sine would cancel, though a pulse sees one of them.
fn correlation(noise: &[f64]) -> f64 {
    let lagged = |k: usize| -> f64 {
        let later = noise.iter().skip(k);
        noise.iter().zip(later).map(|(a, b)| a * b).sum()
    };
    let power = lagged(0);
    let least = 2.0 / (noise.len() as f64).sqrt();
    let alike = lagged(1) > 0.0;
    let mut sum = 1.0;
    for k in 1..noise.len() / 4 {
        let rho = lagged(k) / power;
        if rho.abs() < least || rho.is_nan() || (alike && rho < 0.0) {
            break;
        }
        sum += 2.0 * rho;
    }
    sum.max(0.1)
}

#[cfg(test)]
#[path = "tests/baseline.rs"]
mod tests;
