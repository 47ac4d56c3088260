//! Maximum and onset of a pulse by polynomials fitted to a part of it.

use super::{ChannelView, Picked, Systematic};
use crate::error::{MeasureError, Result};
use crate::signal::Pulse;
use crate::signal::linear::LocalPolynomial;
use std::f64::consts::LN_2;

/// Degree and width tried, in this order, where noise leaves what was asked for
/// without a maximum: wide, and at last a parabola.
const IN_NOISE: [(usize, f64); 2] = [(4, 1.2), (2, 0.8)];
/// Deviations by which noise may have sharpened a top, or steepened a flank.
const BY_CHANCE: f64 = 2.0;

/// A curve about its maximum, in units of u; `*_share` are standard deviations for unit noise.
pub(super) struct Top {
    /// Noise, with residuals beyond it.
    pub(super) noise: f64,
    pub(super) height: f64,
    /// Height before an amplifier's low-pass over that, and deviation of its logarithm.
    pub(super) gain: f64,
    pub(super) height_share: f64,
    pub(super) slope_share: f64,
    pub(super) curvature: f64,
    pub(super) curvature_share: f64,
    /// The part of the slope's share that is of the shape, which the samples leave open.
    pub(super) open_share: f64,
    /// How far off the maximum may be by noise, at one deviation of heights: on a flat top farther
    /// than slope and curvature give.
    pub(super) reach: f64,
}

impl Top {
    /// How many times as sharp it is as a Gaussian of the pulse's sides, whose mean is the
    /// geometric one; at least 1, and no more than noise can have made of it. 1 of a clipped pulse,
    /// whose sides are no better known.
    fn sharper(&self, pulse: &Pulse, half: f64) -> f64 {
        if pulse.clipped.is_some() {
            return 1.0;
        }
        let (rise, fall) = pulse.sides_samples;
        let gaussian = 2.0 * LN_2 * half * half / (rise * fall) * self.height;
        let least = -self.curvature - BY_CHANCE * self.noise * self.curvature_share;
        (-self.curvature / gaussian.max(least)).max(1.0)
    }

    /// The pick at u. With s the slope and b the curvature of the curve, the top is at s = 0 and its
    /// variance is var(s)/b²; what lies under the pulse adds its own slope's.
    ///
    /// Noise that sharpens a top by chance also moves it, and must not make its error less: of
    /// noise's part, b is no more than that of a Gaussian as high and as wide at half its height.
    pub(super) fn pick(
        &self,
        view: &ChannelView<'_>,
        pulse: &Pulse,
        fit: &LocalPolynomial,
        u: f64,
    ) -> Picked {
        let noise = self.noise;
        let time = fit.sample(u);
        let moved_by = |slope: f64| slope / -self.curvature * fit.half;
        let by_noise = |share: f64| moved_by(noise * share) * self.sharper(pulse, fit.half);
        // What falls moves a maximum earlier.
        let under = -moved_by(view.fall_under(pulse, time) * fit.half);
        let likely = moved_by(view.likely_fall(pulse, time) * fit.half);
        Picked {
            time_s: time + likely,
            // Of a parabola heights differ by a deviation at two deviations of its maximum.
            sigma_s: by_noise(self.slope_share).max(0.5 * self.reach * fit.half).hypot(under),
            systematic: Systematic {
                superposition_s: under,
                shape_s: by_noise(self.open_share),
                height: 0.0,
            },
            height: self.gain * self.height,
            height_sigma: noise * self.gain * self.height * self.height_share,
            width_s: pulse.width_samples,
            signal_to_noise: self.height / view.noise(pulse),
            misfit: view.misfit(pulse, fit.residual),
        }
    }
}

/// Maximum for a height and a time that need not be free of bias, by a quartic over one width.
pub(super) fn pick_roughly(view: &ChannelView<'_>, pulse: &Pulse) -> Result<Picked> {
    let fit = fit_maximum(view, pulse, 4, pulse.width_samples);
    let picked = fit.map(|(fit, u)| pick_at(view, pulse, &fit, u));
    picked.map_or_else(|| pick_in_noise(view, pulse), Ok)
}

/// Time in samples where noise hides the shape.
pub(super) fn pick_in_noise(view: &ChannelView<'_>, pulse: &Pulse) -> Result<Picked> {
    let mut tries = IN_NOISE.into_iter();
    let (fit, u) = tries
        .find_map(|(degree, width)| fit_maximum(view, pulse, degree, width * pulse.width_samples))
        .ok_or(MeasureError::NoPick(pulse.kind, "maximum"))?;
    let picked = pick_at(view, pulse, &fit, u);
    // Of all that a low-pass does, the delay of a slow signal.
    let [delay, ..] = view.inverse;
    let time_s = picked.time_s - delay;
    Ok(Picked { time_s, ..picked })
}

fn pick_at(view: &ChannelView<'_>, pulse: &Pulse, fit: &LocalPolynomial, u: f64) -> Picked {
    let (at, variances) = (fit.at(u), fit.variances(u));
    let top = Top {
        noise: view.broad_noise(pulse),
        height: at.value,
        gain: 1.0,
        height_share: variances.value.sqrt() / at.value,
        slope_share: variances.slope.sqrt(),
        curvature: at.curvature,
        curvature_share: variances.curvature.sqrt(),
        open_share: 0.0,
        reach: 0.0,
    };
    top.pick(view, pulse, fit, u)
}

/// The polynomial over so many samples, centred on its own maximum to half a
/// sample, and where that is.
fn fit_maximum(
    view: &ChannelView<'_>,
    pulse: &Pulse,
    degree: usize,
    length: f64,
) -> Option<(LocalPolynomial, f64)> {
    let half = (0.5 * length).max(2.0);
    let reach = 2.0 * half + 2.0;
    let begun = pulse.at as f64;
    let (first, heights) = view.window(begun - reach, begun + reach);
    let (mut centre, mut left) = (begun, 6);
    loop {
        let fit = LocalPolynomial::through(&heights, first as f64, centre, half, degree)?;
        let u = fit.maximum()?;
        let next = fit.sample(u).round();
        // Two neighbouring centres that point at each other: either will do.
        if next == centre || left == 0 {
            return Some((fit, u));
        }
        if (next - begun).abs() > half + 2.0 {
            return None;
        }
        (centre, left) = (next, left - 1);
    }
}

/// Half the width of the fit of the flank, in full widths at half maximum.
const FLANK: f64 = 0.18;
/// Share of the height at which a pulse is clipped up to which its flank can be fitted.
const FREE: f64 = 0.7;

/// Time in samples at which the rising flank passes a share f of the maximum `top`.
///
/// The maximum h is that of a local polynomial, or of a clipped pulse's flanks. The last sample below f h before it is the rough
/// crossing; a cubic fitted about that gives the fine one. Variance: (var(cubic) + f² var(h))/slope²,
/// with no more of a slope than a Gaussian as steep at half its height has there: what noise adds to
/// it by chance must not lower the error.
pub(super) fn pick_onset(
    view: &ChannelView<'_>,
    pulse: &Pulse,
    fraction: f64,
    top: Picked,
) -> Result<Picked> {
    if pulse.clipped.is_some() && fraction * top.height >= FREE * pulse.height {
        let what = "rising flank up to that share, clipped as it is,";
        return Err(MeasureError::NoPick(pulse.kind, what));
    }
    let threshold = fraction * top.height;
    let crossing = rough_crossing(view, pulse, top.time_s, threshold);
    let (fit, u) = crossing
        .and_then(|rough| fit_crossing(view, pulse, rough, threshold))
        .ok_or(MeasureError::NoPick(pulse.kind, "rising flank"))?;
    let noise = view.broad_noise(pulse);
    let variances = fit.variances(u);
    // y = h 2^(−z²), with z from the maximum in half widths of the rise.
    let z = (-fraction.log2()).sqrt();
    let steepness = 2.0 * LN_2 * z * fraction * top.height;
    let gaussian = steepness * fit.half / pulse.sides_samples.0;
    let slope = fit.at(u).slope;
    let least = slope - BY_CHANCE * noise * variances.slope.sqrt();
    let slope = slope.min(gaussian.max(least)) / fit.half;
    let of_value = noise * noise * variances.value;
    let of_height = (fraction * top.height_sigma).powi(2);
    let sigma_s = (of_value + of_height).sqrt() / slope;
    Ok(top.by_fit(fit.sample(u), sigma_s, view.misfit(pulse, fit.residual)))
}

/// Middle between the last sample below the threshold before the top and the
/// first above it near that: noise moves both apart, not their middle.
fn rough_crossing(view: &ChannelView<'_>, pulse: &Pulse, top: f64, threshold: f64) -> Option<f64> {
    let reach = 2.5 * pulse.width_samples + 2.0;
    let (first, heights) = view.window(top - reach, top);
    let last = heights.iter().rposition(|h| *h < threshold)?;
    let span = (0.4 * pulse.width_samples) as usize;
    let early = last.saturating_sub(span);
    let above = heights[early..].iter().position(|h| *h >= threshold);
    let earliest = above.map_or(last, |i| (early + i).min(last + 1));
    Some(first as f64 + 0.5 * (last as f64 + earliest as f64))
}

fn fit_crossing(
    view: &ChannelView<'_>,
    pulse: &Pulse,
    rough: f64,
    threshold: f64,
) -> Option<(LocalPolynomial, f64)> {
    let half = (FLANK * pulse.width_samples).max(2.0);
    let (first, heights) = view.window(rough - 3.0 * half, rough + 3.0 * half);
    let through = |centre, half, degree| {
        let fit = LocalPolynomial::through(&heights, first as f64, centre, half, degree)?;
        let u = fit.rise_through(threshold)?;
        Some((fit, u))
    };
    // A second time about the place just found, for a window that noise did not choose.
    let again = |(fit, u): (LocalPolynomial, f64), half, degree| {
        let centre = fit.sample(u);
        through(centre, half, degree).unwrap_or((fit, u))
    };
    let cubic = through(rough, half, 3).map(|once| again(once, half, 3));
    // Noise can bend a cubic away from the threshold; a longer line meets it.
    let longer = 1.4 * half;
    cubic.or_else(|| through(rough, longer, 1).map(|once| again(once, longer, 1)))
}
