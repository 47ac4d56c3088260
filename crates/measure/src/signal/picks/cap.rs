//! Whether a pulse's top is flat because an amplifier clipped it before noise was added.

use super::Sight;
use super::bell::{CUT_OFF, DEGREE, Data, LEVEL, Thought, WIDTH};
use super::normal::{Descent, MOST};
use crate::signal::Pulse;
use std::f64::consts::{LN_2, TAU};

/// Curvature of a whole pulse's logarithm at its maximum over that of a Gaussian as wide, mean and
/// standard deviation: computed ones, dry and wet, have 0.57 to 1.
const CURVATURE: (f64, f64) = (0.85, 0.25);
/// From this curvature on a pulse of which a whole bell leaves no more than noise is not clipped.
const ROUND: f64 = 0.7;
/// Curvature below which a top is rounded off by an amplifier, and deviations by which it is lower.
const FLAT: (f64, f64) = (0.5, 2.5);
/// Share of its height from which on such a pulse is clipped.
const ROUNDED: f64 = 0.65;
/// Range of the curvature of a clipped bell in the same unit.
const CURVATURES: f64 = 2.5;
/// Logarithm of the odds that a pulse is not clipped before its samples are looked at.
const UNCLIPPED: f64 = 5.0;
/// Share of the height at which the middle between both flanks is the middle of the fit.
const SHOULDER: f64 = 0.8;
/// Heights of the clipped bell over its level from which searches begin.
const HIGHER: [f64; 3] = [1.02, 1.15, 1.5];
/// Least height over noise of a pulse whose top is looked at: in more noise clipping moves no
/// maximum beyond its stated error.
const LEAST: f64 = 10.0;
/// Fewest samples across the half maximum of such a pulse.
const FEWEST: f64 = 10.0;
/// Means of neighbouring samples that are enough for either model.
const ENOUGH: usize = 64;

/// First and last sample of a pulse's top if it is clipped: a bell that ends at a level is compared
/// with a whole one by the probability of the samples under each, over all shapes that bells have
/// \[the models' evidence, by Laplace's method\].
pub(crate) fn clipped_top(sight: &Sight<'_>, pulse: &Pulse) -> Option<(usize, usize)> {
    let broad = sight.broad_noise(pulse).max(1e-6 * pulse.height);
    if pulse.width_samples < FEWEST || pulse.height < LEAST * broad {
        return None;
    }
    let (centre, half) = stretch(sight, pulse);
    let data = samples(sight, centre, half, broad)?;
    let mut bell = [0.0; MOST];
    bell[0] = pulse.height.ln();
    bell[2] = -LN_2 * WIDTH * WIDTH;
    let whole = data.descend(bell)?;
    let curvature = whole.model[2] / bell[2];
    let error = curvature_error(&whole, data.noise, bell[2])?;
    // The halves of a pulse that begins to trail are no one bell's, and its curvature is of neither.
    let rounded = curvature + FLAT.1 * error < FLAT.0 && pulse.trailing() < 0.5;
    let left = whole.left / data.noise.powi(2);
    let count = data.points.len() as f64;
    if curvature > ROUND && left < count + 2.0 * (2.0 * count).sqrt() {
        return None;
    }
    let (first, last) = match flat_from(data, &whole, bell, pulse) {
        Some(us) => us,
        None if rounded => return Some(sight.run_above(pulse, ROUNDED * pulse.height)),
        None => return None,
    };
    let sample = |u: f64| (centre + half * u).round().max(0.0) as usize;
    Some((sample(first), sample(last)))
}

/// Where a bell that ends at a level does so, if it is likelier than the whole one.
fn flat_from(
    mut data: Data,
    whole: &Descent<[f64; MOST]>,
    mut bell: [f64; MOST],
    pulse: &Pulse,
) -> Option<(f64, f64)> {
    let count = data.points.len() as f64;
    data.capped = true;
    bell[LEVEL] = pulse.height;
    let capped = best_capped(&data, bell)?;
    let least = whole.left.min(capped.left) / count;
    let noise = data.noise.max(least.sqrt());
    let of_whole = evidence(whole, noise) + expected(whole, noise, bell[2])?;
    let range = pulse.height * CURVATURES * 0.5 * CUT_OFF;
    let of_capped = evidence(&capped, noise) - range.ln();
    let on_top = data.points.iter().map(|(u, _)| *u);
    let mut on_top = on_top.filter(|u| data.is_capped(&capped.model, *u));
    let first = on_top.next()?;
    let last = on_top.next_back().unwrap_or(first);
    (of_capped - of_whole > UNCLIPPED).then_some((first, last))
}

/// Middle of a pulse between its flanks, and how far from there bells are fitted.
fn stretch(sight: &Sight<'_>, pulse: &Pulse) -> (f64, f64) {
    let (first, last) = sight.run_above(pulse, SHOULDER * pulse.height);
    let centre = (0.5 * (first + last) as f64).round();
    let (rise, fall) = pulse.sides_samples;
    let (left, right) = (pulse.at as f64 - rise, pulse.at as f64 + fall);
    (centre, WIDTH * (centre - left).min(right - centre))
}

/// What is fitted: means of neighbours where there are many.
fn samples(sight: &Sight<'_>, centre: f64, half: f64, noise: f64) -> Option<Data> {
    let (start, heights) = sight.window(centre - half, centre + half);
    let together = (heights.len() / ENOUGH).max(1);
    let mean = |(number, of): (usize, &[f64])| {
        let at = (number * together) as f64 + 0.5 * (of.len() as f64 - 1.0);
        let height = of.iter().sum::<f64>() / of.len() as f64;
        ((start as f64 + at - centre) / half, height)
    };
    let points = heights.chunks(together).enumerate().map(mean);
    // Where a step of the digitiser exceeds the noise, neighbours are rounded the same way.
    let level = &sight.upright.level;
    let averaged = level.noise >= 0.5 * sight.upright.step;
    let data = Data {
        points: points.filter(|(u, _)| u.abs() <= 1.0).collect(),
        degree: DEGREE,
        noise: match averaged {
            true => noise / (together as f64).sqrt(),
            false => noise.max(0.5 * sight.upright.step),
        },
        thought: Thought::of_flanks(1.0, 1.0),
        capped: false,
    };
    (data.points.len() > MOST).then_some(data)
}

fn best_capped(data: &Data, bell: [f64; MOST]) -> Option<Descent<[f64; MOST]>> {
    let starts = HIGHER.iter().map(|higher| {
        let mut start = bell;
        start[0] += higher.ln();
        start[2] *= 1.0 + higher.log2();
        start
    });
    let found = starts.filter_map(|start| data.descend(start));
    found.min_by(|a, b| a.left.total_cmp(&b.left))
}

/// Logarithm of the samples' probability under a model, averaged over all its parameters.
fn evidence(found: &Descent<[f64; MOST]>, noise: f64) -> f64 {
    let variance = noise * noise;
    let determinant = found.normal.log_determinant().unwrap_or(f64::INFINITY);
    let parameters = MOST as f64;
    -0.5 * (found.left / variance + determinant - parameters * (TAU * variance).ln())
}

/// Standard error of a whole bell's curvature over that of a Gaussian as wide.
fn curvature_error(whole: &Descent<[f64; MOST]>, noise: f64, gaussian: f64) -> Option<f64> {
    Some(noise * whole.normal.solve()?.inverse[2][2].sqrt() / gaussian.abs())
}

/// Logarithm of the probability of a whole bell's curvature, given that of a Gaussian as wide.
fn expected(whole: &Descent<[f64; MOST]>, noise: f64, gaussian: f64) -> Option<f64> {
    let (mean, spread) = CURVATURE;
    let error = curvature_error(whole, noise, gaussian)?;
    let variance = spread * spread + error * error;
    let off = whole.model[2] / gaussian - mean;
    Some(-0.5 * (off * off / variance + (TAU * variance).ln()))
}
