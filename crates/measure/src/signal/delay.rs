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
mod tests {
    use super::*;

    fn bump(count: usize, at: f64, width: f64) -> Vec<f64> {
        (0..count)
            .map(|i| ((i as f64 - at) / width).cosh().powi(-4))
            .collect()
    }

    #[test]
    fn delay_of_a_shifted_pulse_is_its_shift() {
        for shift in [-7.3, -0.5, 0.0, 0.25, 12.0, 31.77] {
            let delay = delay_by_cross_correlation(
                &bump(200, 90.0, 9.0),
                &bump(220, 90.0 + shift, 9.0),
                2e-6,
            );
            // The remainder of the quartic at 9 samples a width is 4e-5 of a sample.
            assert!(
                (delay.unwrap() - 2e-6 * shift).abs() < 1e-4 * 2e-6,
                "{shift}: {delay:?}"
            );
        }
    }

    #[test]
    fn delay_ignores_the_height_of_the_pulses() {
        let first = bump(100, 40.0, 6.0);
        let second: Vec<f64> = bump(100, 51.5, 6.0).iter().map(|x| 1e4 * x).collect();
        let delay = delay_by_cross_correlation(&first, &second, 1.0).unwrap();
        // As above, at 6 samples a width.
        assert!((delay - 11.5).abs() < 1e-3, "{delay}");
    }

    #[test]
    fn silence_and_nonsense_have_no_delay() {
        let pulse = bump(20, 10.0, 2.0);
        assert_eq!(delay_by_cross_correlation(&[], &pulse, 1.0), None);
        assert_eq!(delay_by_cross_correlation(&pulse, &[0.0; 20], 1.0), None);
        assert_eq!(
            delay_by_cross_correlation(&pulse, &[f64::NAN; 20], 1.0),
            None
        );
    }
}
