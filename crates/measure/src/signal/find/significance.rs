//! Whether a maximum after the wall's pulse stands out of the noise on a falling background.

use super::smooth::{Maximum, Smooth};
use super::track::Track;
use crate::signal::picks::normal::{MOST, Normal};
use std::f64::consts::LN_2;

/// Standard errors of its height above the background that a return has at least: noise alone reaches
/// as many in less than 0.2 % of shots.
pub(super) const LEAST: f64 = 4.3;
/// Widths on either side of a maximum over which background and bell are fitted.
const REACH: f64 = 1.25;
/// Widths of the first pulse from which on a maximum may be a hump of the background; returns of computed
/// rows have up to 2.1.
const HUMP: f64 = 3.0;
/// Least and largest width of a return in widths of the first pulse.
const WIDTHS: (f64, f64) = (0.5, 2.5);

/// Keeps, of the maxima between two samples, those that stand out; whether any did not.
pub(super) fn retain(
    maxima: &mut Vec<Maximum>,
    track: &Track<'_>,
    smooth: &Smooth,
    (from, to): (f64, f64),
) -> bool {
    let before = maxima.len();
    maxima.retain(|maximum| {
        let at = maximum.at as f64;
        at <= from || at >= to || stands_out(maximum, track, smooth)
    });
    maxima.len() < before
}

/// Standard error of a bell's height above a background, for unit noise, by its width in samples.
pub(super) fn error_of_height(width: f64) -> f64 {
    // Of a Gaussian and a line fitted over 2.5 widths.
    1.6 / width.sqrt()
}

/// Least squares of a Gaussian as wide as the maximum is, and of a straight line: a background that falls
/// ever more slowly lies below its chord and only makes the Gaussian lower. What is so wide that it may be
/// the background's own hump must hold a pulse as wide as the first one beside a parabola.
fn stands_out(maximum: &Maximum, track: &Track<'_>, smooth: &Smooth) -> bool {
    let (rise, fall) = smooth.sides(maximum);
    if 2.0 * rise.min(fall) > HUMP * track.width {
        return deviations(maximum, track, track.width, 4) > LEAST;
    }
    // Noise may have made the maximum narrower than its pulse.
    let own = (rise + fall).clamp(WIDTHS.0 * track.width, WIDTHS.1 * track.width);
    let mut widths = [own, track.width].into_iter();
    widths.any(|width| deviations(maximum, track, width, 3) > LEAST)
}

/// Height of a Gaussian of this width beside a polynomial, in its standard errors.
fn deviations(maximum: &Maximum, track: &Track<'_>, width: f64, terms: usize) -> f64 {
    let reach = (REACH * width) as usize;
    let first = maximum.at.saturating_sub(reach);
    let last = (maximum.at + reach + 1).min(track.samples.len());
    let mut normal = Normal::new(terms);
    for (i, sample) in track.samples[first..last].iter().enumerate() {
        let u = ((first + i) as f64 - maximum.at as f64) / width;
        let mut row = [0.0; MOST];
        row[..4].copy_from_slice(&[(-4.0 * LN_2 * u * u).exp(), 1.0, u, u * u]);
        normal.add(&row, track.upright.height(*sample));
    }
    let noise = track.upright.level.broad_noise();
    let found = normal.solve();
    found.map_or(0.0, |found| {
        found.values[0] / (noise * found.inverse[0][0].sqrt())
    })
}
