//! Maximum of a polynomial fitted about the largest sample.

use super::polynomial::Polynomial;
use super::{Moved, Picked, Sight};
use crate::signal::Pulse;
use crate::signal::error::SignalError;

/// Degree and width tried, in this order, where noise leaves what was asked for
/// without a maximum: wide, and at last a parabola.
const IN_NOISE: [(usize, f64); 2] = [(4, 1.2), (2, 0.8)];

/// A curve about its maximum, in units of u; shares are deviations for unit noise.
pub(super) struct Top {
    /// Noise, with what the curve leaves beyond it.
    pub(super) noise: f64,
    pub(super) height: f64,
    pub(super) height_share: f64,
    pub(super) slope_share: f64,
    pub(super) bend: f64,
    pub(super) bend_share: f64,
    /// The part of the slope's share that is of the shape, which the samples leave open.
    pub(super) open_share: f64,
    /// How far off the maximum may be by noise, at one deviation of heights: on a flat top farther than
    /// slope and bend say.
    pub(super) reach: f64,
}

/// Deviations by which noise may have sharpened a top, or steepened a flank.
pub(super) const BY_CHANCE: f64 = 2.0;

impl Top {
    /// How many times as sharp it is as a Gaussian of the pulse's sides, whose mean is the
    /// geometric one; at least 1, and no more than noise can have made of it. Not asked of a clipped
    /// pulse, whose sides its flanks tell no better.
    fn sharper(&self, pulse: &Pulse, half: f64) -> f64 {
        if pulse.clipped.is_some() {
            return 1.0;
        }
        let (rise, fall) = pulse.sides_samples;
        let gaussian = 2.0 * std::f64::consts::LN_2 * half * half / (rise * fall) * self.height;
        let least = -self.bend - BY_CHANCE * self.noise * self.bend_share;
        (-self.bend / gaussian.max(least)).max(1.0)
    }
}

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
    asked
        .map(|(fit, u)| picked(sight, pulse, &fit, u))
        .map_or_else(|| in_noise(sight, pulse), Ok)
}

/// Time in samples where noise hides the shape.
pub(super) fn in_noise(sight: &Sight<'_>, pulse: &Pulse) -> Result<Picked, SignalError> {
    let mut tries = IN_NOISE.into_iter();
    let (fit, u) = tries
        .find_map(|(degree, width)| fit(sight, pulse, degree, width * pulse.width_samples))
        .ok_or(SignalError::NoPick {
            place: pulse.place,
            what: "maximum",
        })?;
    let picked = picked(sight, pulse, &fit, u);
    // Of all that a low-pass does, the delay of a slow signal.
    let [delay, _] = sight.inverse;
    let time_s = picked.time_s - delay;
    Ok(Picked { time_s, ..picked })
}

fn picked(sight: &Sight<'_>, pulse: &Pulse, fit: &Polynomial, u: f64) -> Picked {
    let at = fit.course(u);
    let top = Top {
        noise: sight.broad_noise(pulse),
        height: at.value,
        height_share: fit.value_variance(u).sqrt(),
        slope_share: fit.slope_variance(u).sqrt(),
        bend: at.bend,
        bend_share: fit.bend_variance(u).sqrt(),
        open_share: 0.0,
        reach: 0.0,
    };
    finish(sight, pulse, fit, u, &top)
}

/// With s the slope and b the bend of the curve, the top is at s = 0 and its
/// variance is var(s)/b²; what lies under the pulse adds its own slope's.
///
/// Noise that sharpens a top by chance also moves it, and must not make its error less: of noise's
/// part, b is no more than that of a Gaussian as high and as wide at half its height.
pub(super) fn finish(
    sight: &Sight<'_>,
    pulse: &Pulse,
    fit: &Polynomial,
    u: f64,
    top: &Top,
) -> Picked {
    let noise = top.noise;
    let time = fit.sample(u);
    let moved_by = |slope: f64| slope / -top.bend * fit.half;
    let by_noise = |share: f64| moved_by(noise * share) * top.sharper(pulse, fit.half);
    // What falls moves a maximum earlier.
    let under = -moved_by(sight.fall_under(pulse, time) * fit.half);
    let likely = moved_by(sight.likely_fall(pulse, time) * fit.half);
    Picked {
        time_s: time + likely,
        // Of a parabola heights differ by a deviation at two deviations of its maximum.
        sigma_s: by_noise(top.slope_share)
            .max(0.5 * top.reach * fit.half)
            .hypot(under),
        moved: Moved {
            under_s: under,
            shape_s: by_noise(top.open_share),
        },
        height: top.height,
        height_sigma: noise * top.height_share,
        width_s: pulse.width_samples,
        misfit: sight.misfit(pulse, fit.left),
    }
}

/// The polynomial over so many samples, centred on its own maximum to half a
/// sample, and where that is.
fn fit(sight: &Sight<'_>, pulse: &Pulse, degree: usize, length: f64) -> Option<(Polynomial, f64)> {
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
