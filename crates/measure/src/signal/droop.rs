//! Droop of a first-order high-pass, taken out again.

use crate::signal::error::{SignalError, all_finite};

/// Takes the droop of a first-order high-pass out: the exact inverse of
/// τ y' + y = τ x' from rest by the trapezoidal rule,
/// x_n = y_n + (1/τ) · (trapezoidal integral of y up to n).
///
/// A high-pass moves the maximum of a pulse whose second derivative there is x'' < 0 and whose
/// height is h to where x' = h/τ, that is by h/(τ x''): earlier. A time of flight is off by the
/// difference of two such shifts.
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
    SignalError::positive("sampling interval in s", interval_s)?;
    SignalError::positive("time constant of the high-pass in s", time_constant_s)?;
    all_finite(samples)?;
    let k = 0.5 * interval_s / time_constant_s;
    let (mut integral, mut before) = (0.0, 0.0);
    for sample in samples {
        let y = *sample;
        integral += k * (y + before);
        *sample = y + integral;
        before = y;
    }
    Ok(())
}
