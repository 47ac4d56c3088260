//! Maximum of a polynomial fitted about the largest sample.

use super::polynomial::Polynomial;
use super::{Picked, Sight};
use crate::Pulse;
use crate::error::SignalError;

/// Degree and width tried, in this order, where noise leaves what was asked for
/// without a maximum: wide, and at last a parabola.
const IN_NOISE: [(usize, f64); 2] = [(4, 1.2), (2, 0.8)];

/// As [`pick`], for a height and a time that need not be free of bias.
pub(super) fn roughly(sight: &Sight<'_>, pulse: &Pulse) -> Result<Picked, SignalError> {
    pick(sight, pulse, 4, 1.0)
}

/// Time in samples.
///
/// With p the polynomial and V the covariance of its coefficients, the top is
/// at p' = 0 and its variance is var(p')/p''².
pub(super) fn pick(
    sight: &Sight<'_>,
    pulse: &Pulse,
    degree: usize,
    width: f64,
) -> Result<Picked, SignalError> {
    let no_top = || SignalError::NoPick {
        place: pulse.place,
        what: "maximum",
    };
    let mut tries = [(degree, width)].into_iter().chain(IN_NOISE);
    let found = tries.find_map(|(degree, width)| fit(sight, pulse, degree, width));
    let (fit, u) = found.ok_or_else(no_top)?;
    let top = fit.course(u);
    let noise = sight.broad_noise(pulse);
    Ok(Picked {
        time_s: fit.sample(u),
        sigma_s: noise * fit.slope_variance(u).sqrt() / -top.bend * fit.half(),
        height: top.value,
        height_sigma: noise * fit.value_variance(u).sqrt(),
        width_s: pulse.width_samples,
        misfit: sight.misfit(pulse, fit.left),
    })
}

/// The polynomial, centred on its own maximum to half a sample, and where that is.
fn fit(sight: &Sight<'_>, pulse: &Pulse, degree: usize, width: f64) -> Option<(Polynomial, f64)> {
    let half = (0.5 * width * pulse.width_samples).max(2.0);
    let reach = 2.0 * half + 2.0;
    let begun = pulse.at as f64;
    let (first, heights) = sight.window(begun - reach, begun + reach);
    let mut centre = begun;
    for _ in 0..6 {
        let fit = Polynomial::through(&heights, first as f64, centre, half, degree)?;
        let u = fit.top()?;
        let next = fit.sample(u).round();
        if next == centre {
            return Some((fit, u));
        }
        if (next - begun).abs() > half + 2.0 {
            return None;
        }
        centre = next;
    }
    // Two neighbouring centres that point at each other: either will do.
    let fit = Polynomial::through(&heights, first as f64, centre, half, degree)?;
    let u = fit.top()?;
    Some((fit, u))
}
