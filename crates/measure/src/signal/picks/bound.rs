//! The least spread any unbiased picker can have.

use super::Shape;

/// Cramér–Rao bound of a pulse's time in s, for a known shape in white noise of
/// deviation `noise` a sample: σ ≥ noise/√(Σ_i s'(t_i)²).
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
    let slopes = pulse.windows(3).map(|three| match three {
        [left, _, right] => 0.5 * (right - left) / interval_s,
        _ => 0.0,
    });
    noise / slopes.map(|s| s * s).sum::<f64>().sqrt()
}

#[cfg(test)]
#[path = "tests/bound.rs"]
mod tests;
