//! Times picked on one sampled pulse.

/// A local maximum between samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// When, in s after the first sample.
    pub time_s: f64,
    /// How much, in the samples' unit.
    pub value: f64,
}

/// The largest sample, refined by the parabola through it and its neighbours.
///
/// A parabola costs about (interval/width)² of the width, which for a pulse
/// of some 50 µs at 1 µs is 1e-5 of a time of flight. The first of equal
/// samples counts; a sample at either end is not refined. `None` without
/// finite samples.
#[must_use]
pub fn largest_peak(samples: &[f64], interval_s: f64) -> Option<Peak> {
    let finite = samples
        .iter()
        .enumerate()
        .filter(|(_, value)| value.is_finite());
    let (at, value) = finite.reduce(|best, next| if next.1 > best.1 { next } else { best })?;
    let neighbours = at.checked_sub(1).and_then(|left| samples.get(left..at + 2));
    let (shift, value) = match neighbours {
        Some(&[left, middle, right]) => parabola_top(left, middle, right),
        _ => (0.0, *value),
    };
    Some(Peak {
        time_s: (at as f64 + shift) * interval_s,
        value,
    })
}

/// Top of the parabola through values at −1, 0 and 1.
fn parabola_top(left: f64, middle: f64, right: f64) -> (f64, f64) {
    let curvature = left - 2.0 * middle + right;
    if curvature >= 0.0 || !curvature.is_finite() {
        return (0.0, middle);
    }
    let slope = 0.5 * (right - left);
    (-slope / curvature, middle - 0.5 * slope * slope / curvature)
}

/// First time in s after the first sample at which the signal rises through a
/// threshold, by linear interpolation between the two samples around it.
///
/// `Some(0.0)` when the first sample is already there, `None` when none is.
#[must_use]
pub fn onset_s(samples: &[f64], interval_s: f64, threshold: f64) -> Option<f64> {
    let after = samples.iter().position(|value| *value >= threshold)?;
    let Some(before) = after.checked_sub(1) else {
        return Some(0.0);
    };
    let (low, high) = (samples[before], samples[after]);
    let part = (threshold - low) / (high - low);
    let part = if part.is_finite() { part } else { 1.0 };
    Some((before as f64 + part) * interval_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peak_of_a_sampled_parabola_is_exact() {
        let samples: Vec<f64> = (0..9)
            .map(|i| 5.0 - 0.3 * (f64::from(i) - 4.3).powi(2))
            .collect();
        let peak = largest_peak(&samples, 2.0).unwrap();
        // Rounding only.
        assert!((peak.time_s - 8.6).abs() < 1e-13);
        assert!((peak.value - 5.0).abs() < 1e-13);
    }

    #[test]
    fn peak_at_an_end_is_the_sample() {
        assert_eq!(
            largest_peak(&[3.0, 2.0], 1.0),
            Some(Peak {
                time_s: 0.0,
                value: 3.0
            })
        );
        assert_eq!(largest_peak(&[f64::NAN], 1.0), None);
        assert_eq!(largest_peak(&[], 1.0), None);
    }

    #[test]
    fn onset_of_a_ramp_is_where_it_meets_the_threshold() {
        assert_eq!(onset_s(&[0.0, 0.0, 1.0, 2.0], 0.5, 0.25), Some(0.625));
        assert_eq!(onset_s(&[1.0, 2.0], 0.5, 0.25), Some(0.0));
        assert_eq!(onset_s(&[0.0, 0.1], 0.5, 0.25), None);
    }
}
