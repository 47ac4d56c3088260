//! Where the rising flank passes a share of the maximum.

use super::local_model::{self, BY_CHANCE};
use super::polynomial::Polynomial;
use super::{Moved, Picked, Sight};
use crate::signal::Pulse;
use crate::signal::error::SignalError;

/// Half the width of the fit of the flank, in full widths at half maximum.
const REACH: f64 = 0.18;

/// Time in samples.
///
/// The maximum h is that of a local model. The last sample below f h before it
/// is where the flank passes, roughly; a cubic fitted about that says where,
/// finely. Variance: (var(cubic) + f² var(h))/slope², with no more of a slope than a Gaussian as
/// steep at half its height has there: what noise adds to it by chance makes the time no surer.
pub(super) fn pick(sight: &Sight<'_>, pulse: &Pulse, fraction: f64) -> Result<Picked, SignalError> {
    let top = local_model::roughly(sight, pulse)?;
    before(sight, pulse, fraction, top)
}

/// Share of the height at which a pulse is clipped up to which its flank can be fitted.
const FREE: f64 = 0.7;

/// As [`pick`], with the maximum that the flanks of a clipped pulse tell.
pub(super) fn of_clipped(
    sight: &Sight<'_>,
    pulse: &Pulse,
    fraction: f64,
    top: Picked,
) -> Result<Picked, SignalError> {
    match fraction * top.height < FREE * pulse.height {
        true => before(sight, pulse, fraction, top),
        false => Err(SignalError::NoPick {
            place: pulse.place,
            what: "rising flank up to that share, clipped as it is,",
        }),
    }
}

fn before(
    sight: &Sight<'_>,
    pulse: &Pulse,
    fraction: f64,
    top: Picked,
) -> Result<Picked, SignalError> {
    let no_crossing = || SignalError::NoPick {
        place: pulse.place,
        what: "rising flank",
    };
    let threshold = fraction * top.height;
    let rough = rough(sight, pulse, top.time_s, threshold).ok_or_else(no_crossing)?;
    let (fit, u) = fit(sight, pulse, rough, threshold).ok_or_else(no_crossing)?;
    let noise = sight.broad_noise(pulse);
    let slope = likely_slope(pulse, fraction, top.height, noise, &fit, u) / fit.half;
    let of_value = noise * noise * fit.value_variance(u);
    let of_height = (fraction * top.height_sigma).powi(2);
    Ok(Picked {
        time_s: fit.sample(u),
        sigma_s: (of_value + of_height).sqrt() / slope,
        moved: Moved::default(),
        misfit: sight.misfit(pulse, fit.left),
        ..top
    })
}

/// Slope at u, less what noise may have added.
fn likely_slope(
    pulse: &Pulse,
    fraction: f64,
    height: f64,
    noise: f64,
    fit: &Polynomial,
    u: f64,
) -> f64 {
    let slope = fit.course(u).slope;
    // y = h 2^(−z²), with z from the maximum in half widths of the rise.
    let z = (-fraction.log2()).sqrt();
    let steepness = 2.0 * std::f64::consts::LN_2 * z * fraction * height;
    let gaussian = steepness * fit.half / pulse.sides_samples.0;
    let least = slope - BY_CHANCE * noise * fit.slope_variance(u).sqrt();
    slope.min(gaussian.max(least))
}

/// Middle between the last sample below the threshold before the top and the
/// first above it near that: noise moves both apart, not their middle.
fn rough(sight: &Sight<'_>, pulse: &Pulse, top: f64, threshold: f64) -> Option<f64> {
    let reach = 2.5 * pulse.width_samples + 2.0;
    let (first, heights) = sight.window(top - reach, top);
    let last = heights.iter().rposition(|h| *h < threshold)?;
    let span = (0.4 * pulse.width_samples) as usize;
    let early = last.saturating_sub(span);
    let above = heights[early..].iter().position(|h| *h >= threshold);
    let earliest = above.map_or(last, |i| (early + i).min(last + 1));
    Some(first as f64 + 0.5 * (last as f64 + earliest as f64))
}

fn fit(sight: &Sight<'_>, pulse: &Pulse, rough: f64, threshold: f64) -> Option<(Polynomial, f64)> {
    let half = (REACH * pulse.width_samples).max(2.0);
    let (first, heights) = sight.window(rough - 3.0 * half, rough + 3.0 * half);
    let through = |centre, half, degree| {
        let fit = Polynomial::through(&heights, first as f64, centre, half, degree)?;
        let u = fit.rise_through(threshold)?;
        Some((fit, u))
    };
    // A second time about the place just found, for a window that noise did not choose.
    let again = |(fit, u): (Polynomial, f64), half, degree| {
        let centre = fit.sample(u);
        through(centre, half, degree).unwrap_or((fit, u))
    };
    let cubic = through(rough, half, 3).map(|once| again(once, half, 3));
    // Noise can bend a cubic away from the threshold; a longer line meets it.
    let longer = 1.4 * half;
    cubic.or_else(|| through(rough, longer, 1).map(|once| again(once, longer, 1)))
}
