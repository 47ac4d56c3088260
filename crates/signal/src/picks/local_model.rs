//! Maximum of a polynomial fitted about the largest sample.

use super::polynomial::Polynomial;
use super::{Picked, Sight};
use crate::Pulse;
use crate::error::SignalError;

/// Degrees and widths from smooth to close, in full widths.
const SMOOTH: [(usize, f64); 2] = [(6, 0.8), (8, 0.8)];
/// Closer still, in widths of the steeper flank: for pulses with a tail.
const CLOSE: [(usize, f64); 2] = [(8, 0.8), (8, 0.55)];
/// Degree and width tried, in this order, where noise leaves what was asked for
/// without a maximum: wide, and at last a parabola.
const IN_NOISE: [(usize, f64); 2] = [(4, 1.2), (2, 0.8)];
/// Deviations by which the squares that a fit leaves may exceed those of noise.
const ADEQUATE: f64 = 3.0;

/// A polynomial and where on it the maximum is.
type Top = (Polynomial, f64);

/// As [`pick`], for a height and a time that need not be free of bias.
pub(super) fn roughly(sight: &Sight<'_>, pulse: &Pulse) -> Result<Picked, SignalError> {
    pick(sight, pulse, 4, 1.0)
}

/// Time in samples, by the polynomial that was asked for.
pub(super) fn pick(
    sight: &Sight<'_>,
    pulse: &Pulse,
    degree: usize,
    width: f64,
) -> Result<Picked, SignalError> {
    let asked = fit(sight, pulse, degree, width * pulse.width_samples);
    finish(sight, pulse, asked.or_else(|| in_noise(sight, pulse)))
}

/// Time in samples, by the smoothest polynomial that leaves no more than noise.
pub(super) fn maximum(sight: &Sight<'_>, pulse: &Pulse) -> Result<Picked, SignalError> {
    let noise = sight.noise(pulse);
    let mut best = None;
    let wide = SMOOTH.map(|(degree, width)| (degree, width * pulse.width_samples));
    let steep = pulse.steep_width_samples();
    let close = CLOSE.map(|(degree, width)| (degree, width * steep));
    for (degree, length) in wide.into_iter().chain(close) {
        let Some((found, u)) = fit(sight, pulse, degree, length) else {
            continue;
        };
        let freedom = found.freedom as f64;
        let squares = (found.left / noise).powi(2);
        best = Some((found, u));
        if squares < 1.0 + ADEQUATE * (2.0 / freedom).sqrt() {
            break;
        }
    }
    finish(sight, pulse, best.or_else(|| in_noise(sight, pulse)))
}

fn in_noise(sight: &Sight<'_>, pulse: &Pulse) -> Option<Top> {
    let mut tries = IN_NOISE.into_iter();
    tries.find_map(|(degree, width)| fit(sight, pulse, degree, width * pulse.width_samples))
}

/// With p the polynomial and V the covariance of its coefficients, the top is
/// at p' = 0 and its variance is var(p')/p''².
fn finish(sight: &Sight<'_>, pulse: &Pulse, top: Option<Top>) -> Result<Picked, SignalError> {
    let (fit, u) = top.ok_or(SignalError::NoPick {
        place: pulse.place,
        what: "maximum",
    })?;
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

/// The polynomial over so many samples, centred on its own maximum to half a
/// sample, and where that is.
fn fit(sight: &Sight<'_>, pulse: &Pulse, degree: usize, length: f64) -> Option<Top> {
    let half = (0.5 * length).max(2.0);
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
