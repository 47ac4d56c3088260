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
mod tests {
    use super::*;

    #[test]
    fn bound_of_a_sech_squared_is_its_closed_form() {
        // s = sech²(z/a): ∫ s'² dz = 16/(15 a), and the width is 2 a arcosh √2.
        let (noise, width, interval) = (0.01, 60e-6, 1e-6);
        let a = width / (2.0 * 2.0_f64.sqrt().acosh());
        let by_hand = noise / (16.0 / (15.0 * a) / interval).sqrt();
        let found = cramer_rao_s(&Shape::sech_power(2.0), 1.0, width, interval, noise);
        // The sum over z in steps of a thousandth.
        assert!((found / by_hand - 1.0).abs() < 1e-6, "{found} {by_hand}");
    }

    #[test]
    fn both_forms_of_the_bound_agree() {
        let shape = Shape::cos_power(6.0);
        let pulse: Vec<f64> = (0..300)
            .map(|i| 7.0 * shape.value((f64::from(i) - 150.2) / 60.0))
            .collect();
        let sampled = cramer_rao_of_samples_s(&pulse, 1e-6, 0.07);
        let known = cramer_rao_s(&shape, 7.0, 60e-6, 1e-6, 0.07);
        // Central differences at 60 samples a width.
        assert!((sampled / known - 1.0).abs() < 2e-3, "{sampled} {known}");
    }
}
