//! Droop of a first-order high-pass, and its inverse.

use crate::error::{SignalError, all_finite};

/// Passes samples through a first-order high-pass, τ y' + y = τ x', from rest.
///
/// It moves the maximum of a pulse whose second derivative there is x'' < 0 and whose
/// height is h to where x' = h/τ, that is by h/(τ x''): earlier. A time of flight is off by the
/// difference of two such shifts.
///
/// By the trapezoidal rule: y_n (1 + k) = y_{n−1} (1 − k) + x_n − x_{n−1} with
/// k = interval/(2τ).
///
/// # Errors
/// Interval or time constant not positive; samples not finite.
pub fn droop(
    samples: &mut [f64],
    interval_s: f64,
    time_constant_s: f64,
) -> Result<(), SignalError> {
    let k = half_step(samples, interval_s, time_constant_s)?;
    let (mut x_before, mut y_before) = (0.0, 0.0);
    for sample in samples {
        let x = *sample;
        *sample = (y_before * (1.0 - k) + x - x_before) / (1.0 + k);
        (x_before, y_before) = (x, *sample);
    }
    Ok(())
}

/// Takes the droop of a first-order high-pass out again: the exact inverse of
/// [`droop`], x_n = y_n + (1/τ) · (trapezoidal integral of y up to n).
///
/// Take the offset away first: the inverse makes a ramp of it, offset/τ a
/// second. White noise of deviation σ gains a random walk of deviation
/// σ √n · interval/τ after n samples.
///
/// # Errors
/// Interval or time constant not positive; samples not finite.
pub fn undroop(
    samples: &mut [f64],
    interval_s: f64,
    time_constant_s: f64,
) -> Result<(), SignalError> {
    let k = half_step(samples, interval_s, time_constant_s)?;
    let (mut integral, mut before) = (0.0, 0.0);
    for sample in samples {
        let y = *sample;
        integral += k * (y + before);
        *sample = y + integral;
        before = y;
    }
    Ok(())
}

fn half_step(samples: &[f64], interval_s: f64, time_constant_s: f64) -> Result<f64, SignalError> {
    SignalError::positive("sampling interval in s", interval_s)?;
    SignalError::positive("time constant of the high-pass in s", time_constant_s)?;
    all_finite(samples)?;
    Ok(0.5 * interval_s / time_constant_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Shape;

    fn bell() -> Vec<f64> {
        let shape = Shape::cos_power(6.0);
        (0..2000)
            .map(|i| shape.value((f64::from(i) - 700.0) / 50.0))
            .collect()
    }

    #[test]
    fn the_inverse_gives_back_what_the_high_pass_took() {
        let clean = bell();
        let mut samples = clean.clone();
        droop(&mut samples, 1e-6, 2e-3).unwrap();
        assert!(samples[1200] < -0.02, "an undershoot follows the pulse");
        undroop(&mut samples, 1e-6, 2e-3).unwrap();
        for (back, clean) in samples.iter().zip(&clean) {
            // Rounding, summed over 2,000 steps.
            assert!((back - clean).abs() < 1e-12);
        }
    }

    #[test]
    fn a_time_constant_of_nothing_is_refused() {
        assert!(undroop(&mut [0.0; 4], 1e-6, 0.0).is_err());
        assert!(undroop(&mut [f64::INFINITY; 4], 1e-6, 1.0).is_err());
        assert!(droop(&mut [0.0; 4], f64::NAN, 1.0).is_err());
    }
}
