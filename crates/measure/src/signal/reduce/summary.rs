//! Mean and spread of repeated measurements.

use crate::signal::Estimate;

/// Repeated measurements of one quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// How many.
    pub count: usize,
    /// Their mean.
    pub mean: f64,
    /// Standard deviation of one, with n − 1; not a number for one alone.
    pub deviation: f64,
    /// Standard error of the mean, deviation/√n; of one alone, its own sigma.
    pub error: f64,
    /// Mean weighted by 1/σ², with the error that follows from the σ alone.
    /// Equal to mean and error where a σ is 0 or not finite.
    pub weighted: Estimate,
    /// Σ ((x − weighted mean)/σ)²; near count − 1 if the σ explain the spread.
    pub chi_square: f64,
}

/// Summarises measurements; those that are not finite are left out. `None` if
/// nothing is left.
///
/// The plain mean and its error belong to what varies from shot to shot, the
/// weighted ones to what the σ describe. Where chi-square is far above count − 1,
/// shots vary by more than their own errors, and the plain ones count.
#[must_use]
pub fn summary(measured: &[Estimate]) -> Option<Summary> {
    let kept = measured.iter().filter(|m| m.value.is_finite());
    let kept: Vec<Estimate> = kept.copied().collect();
    let count = kept.len();
    // About the first: differences keep the digits of a small spread.
    let first = kept.first()?;
    let n = count as f64;
    let mean = first.value + kept.iter().map(|m| m.value - first.value).sum::<f64>() / n;
    let squares: f64 = kept.iter().map(|m| (m.value - mean).powi(2)).sum();
    let deviation = (squares / (n - 1.0)).sqrt();
    let error = if count == 1 {
        first.sigma
    } else {
        deviation / n.sqrt()
    };
    let plain = Estimate {
        value: mean,
        sigma: error,
    };
    let (weighted, chi_square) = weighted(&kept, mean).unwrap_or((plain, f64::NAN));
    Some(Summary {
        count,
        mean,
        deviation,
        error,
        weighted,
        chi_square,
    })
}

fn weighted(kept: &[Estimate], about: f64) -> Option<(Estimate, f64)> {
    let weight = |m: &Estimate| m.sigma.powi(2).recip();
    let all: f64 = kept.iter().map(weight).sum();
    if !all.is_finite() || all <= 0.0 {
        return None;
    }
    let shift: f64 = kept.iter().map(|m| weight(m) * (m.value - about)).sum();
    let value = about + shift / all;
    let misses = kept.iter().map(|m| weight(m) * (m.value - value).powi(2));
    let sigma = all.recip().sqrt();
    Some((Estimate { value, sigma }, misses.sum()))
}
