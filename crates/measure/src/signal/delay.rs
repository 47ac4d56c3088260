//! Delay between two sampled pulses.

/// Delay in s of `later` against `earlier`: the lag of the largest
/// cross-correlation Σ_i earlier_i · later_{i+k}, both taken as 0 outside their
/// samples, refined between samples by the quartic through the five
/// correlations around the largest.
///
/// Negative when `later` comes first. `None` when either slice is empty, is 0
/// throughout or holds numbers that are not finite.
///
/// The sum is taken directly, so the cost is the product of the two lengths.
#[must_use]
pub fn delay_by_cross_correlation(earlier: &[f64], later: &[f64], interval_s: f64) -> Option<f64> {
    let behind = isize::try_from(earlier.len()).ok()?;
    let ahead = isize::try_from(later.len()).ok()?;
    let lags: Vec<isize> = (-behind - 1..ahead + 2).collect();
    let correlations: Vec<f64> = lags
        .iter()
        .map(|&k| correlation(earlier, later, k))
        .collect();
    let best = largest(&correlations)?;
    // Two lags beyond either end keep the five points inside.
    let five: [f64; 5] = correlations.get(best - 2..best + 3)?.try_into().ok()?;
    Some((lags[best] as f64 + quartic_maximum(five)) * interval_s)
}

fn correlation(earlier: &[f64], later: &[f64], lag: isize) -> f64 {
    let skip = |n: isize| usize::try_from(n).unwrap_or(0);
    let later = later.iter().skip(skip(lag));
    earlier
        .iter()
        .skip(skip(-lag))
        .zip(later)
        .map(|(a, b)| a * b)
        .sum()
}

/// Index of the largest positive value; the first of equals.
pub(crate) fn largest(values: &[f64]) -> Option<usize> {
    let mut best: Option<usize> = None;
    for (i, value) in values.iter().enumerate() {
        if !value.is_finite() {
            return None;
        }
        if *value > best.map_or(0.0, |b| values[b]) {
            best = Some(i);
        }
    }
    best
}

/// Where the quartic through values at −2..=2 is largest near 0.
pub(crate) fn quartic_maximum([a, b, c, d, e]: [f64; 5]) -> f64 {
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
#[path = "tests/delay.rs"]
mod tests;
