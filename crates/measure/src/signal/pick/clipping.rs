//! Clipped tops: whether a pulse has one, and the whole pulse by its flanks.

use super::ChannelView;
use super::log_polynomial::{BellData, CUT_OFF, DEGREE, LEVEL, ShapePrior, WIDTH};
use crate::signal::linear::{LinearSolution, MOST, Optimum, Row};
use crate::signal::{Pulse, statistics};
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
/// Logarithm of the prior odds that a pulse is not clipped.
const UNCLIPPED: f64 = 5.0;
/// Share of the height at which the middle between both flanks is the middle of the fit.
const SHOULDER: f64 = 0.8;
/// Heights of the clipped bell over its level from which searches begin.
const HIGHER: [f64; 3] = [1.02, 1.15, 1.5];
/// Least height over noise, and fewest samples across the half maximum, of a pulse whose top is
/// tested: in more noise clipping moves no maximum beyond its stated error.
const LEAST: f64 = 10.0;
const FEWEST: f64 = 10.0;
/// Means of neighbouring samples that are enough for either model.
const ENOUGH: usize = 64;

/// First and last sample of a pulse's top if it is clipped: a bell that ends at a level is compared
/// with a whole one by the probability of the samples under each, over all shapes that bells have
/// \[the models' evidence, by Laplace's method\].
pub(crate) fn clipped_top(view: &ChannelView<'_>, pulse: &Pulse) -> Option<(usize, usize)> {
    let broad = view.broad_noise(pulse).max(1e-6 * pulse.height);
    if pulse.width_samples < FEWEST || pulse.height < LEAST * broad {
        return None;
    }
    // The middle between its flanks, and how far from there bells are fitted.
    let (first, last) = view.run_above(pulse, SHOULDER * pulse.height);
    let centre = (0.5 * (first + last) as f64).round();
    let (rise, fall) = pulse.sides_samples;
    let (left, right) = (pulse.at as f64 - rise, pulse.at as f64 + fall);
    let half = WIDTH * (centre - left).min(right - centre);
    let data = samples(view, centre, half, broad)?;
    let mut bell = [0.0; MOST];
    bell[0] = pulse.height.ln();
    bell[2] = -LN_2 * WIDTH * WIDTH;
    let whole = data.fit(bell)?;
    let curvature = whole.model[2] / bell[2];
    let error = curvature_error(&whole, data.noise, bell[2])?;
    // The halves of an asymmetric pulse are no one bell's, and its curvature is of neither.
    let rounded = curvature + FLAT.1 * error < FLAT.0 && pulse.asymmetry() < 0.5;
    let squares = whole.squares / data.noise.powi(2);
    let count = data.points.len() as f64;
    if curvature > ROUND && squares < count + 2.0 * (2.0 * count).sqrt() {
        return None;
    }
    let (first, last) = match level_range(data, &whole, bell, pulse) {
        Some(us) => us,
        None if rounded => return Some(view.run_above(pulse, ROUNDED * pulse.height)),
        None => return None,
    };
    let sample = |u: f64| (centre + half * u).round().max(0.0) as usize;
    Some((sample(first), sample(last)))
}

/// Between which u a bell ends at a level, if that is likelier than the whole one.
fn level_range(
    mut data: BellData,
    whole: &Optimum<Row>,
    mut bell: Row,
    pulse: &Pulse,
) -> Option<(f64, f64)> {
    let count = data.points.len() as f64;
    data.capped = true;
    bell[LEVEL] = pulse.height;
    let fits = HIGHER.iter().filter_map(|higher| {
        let mut start = bell;
        start[0] += higher.ln();
        start[2] *= 1.0 + higher.log2();
        data.fit(start)
    });
    let capped = fits.min_by(|a, b| a.squares.total_cmp(&b.squares))?;
    let least = whole.squares.min(capped.squares) / count;
    let noise = data.noise.max(least.sqrt());
    let of_whole = evidence(whole, noise) + curvature_evidence(whole, noise, bell[2])?;
    let range = pulse.height * CURVATURES * 0.5 * CUT_OFF;
    let of_capped = evidence(&capped, noise) - range.ln();
    let us = data.points.iter().map(|(u, _)| *u);
    let mut on_top = us.filter(|u| data.is_capped(&capped.model, *u));
    let first = on_top.next()?;
    let last = on_top.next_back().unwrap_or(first);
    (of_capped - of_whole > UNCLIPPED).then_some((first, last))
}

/// What is fitted: means of neighbours where there are many.
fn samples(view: &ChannelView<'_>, centre: f64, half: f64, noise: f64) -> Option<BellData> {
    let (start, heights) = view.window(centre - half, centre + half);
    let together = (heights.len() / ENOUGH).max(1);
    let mean = |(number, of): (usize, &[f64])| {
        let at = (number * together) as f64 + 0.5 * (of.len() as f64 - 1.0);
        ((start as f64 + at - centre) / half, statistics::mean(of))
    };
    let points = heights.chunks(together).enumerate().map(mean);
    // Where a step of the digitiser exceeds the noise, neighbours are rounded the same way.
    let step = view.normalisation.step;
    let averaged = view.normalisation.baseline.noise >= 0.5 * step;
    let data = BellData {
        points: points.filter(|(u, _)| u.abs() <= 1.0).collect(),
        degree: DEGREE,
        noise: match averaged {
            true => noise / (together as f64).sqrt(),
            false => noise.max(0.5 * step),
        },
        prior: ShapePrior::of_flanks(1.0, 1.0),
        capped: false,
    };
    (data.points.len() > MOST).then_some(data)
}

/// Logarithm of the samples' probability under a model, averaged over all its parameters.
fn evidence(found: &Optimum<Row>, noise: f64) -> f64 {
    let variance = noise * noise;
    let determinant = found.normal.log_determinant().unwrap_or(f64::INFINITY);
    let parameters = MOST as f64;
    -0.5 * (found.squares / variance + determinant - parameters * (TAU * variance).ln())
}

/// Standard error of a whole bell's curvature over that of a Gaussian as wide.
fn curvature_error(whole: &Optimum<Row>, noise: f64, gaussian: f64) -> Option<f64> {
    Some(noise * whole.normal.solve()?.inverse[2][2].sqrt() / gaussian.abs())
}

/// Logarithm of the probability of a whole bell's curvature, given that of a Gaussian as wide.
fn curvature_evidence(whole: &Optimum<Row>, noise: f64, gaussian: f64) -> Option<f64> {
    let (mean, spread) = CURVATURE;
    let error = curvature_error(whole, noise, gaussian)?;
    let variance = spread * spread + error * error;
    let off = whole.model[2] / gaussian - mean;
    Some(-0.5 * (off * off / variance + (TAU * variance).ln()))
}

/// Share of the height at which a pulse is clipped down to which its flanks are fitted.
const FOOT: f64 = 0.25;
const FEWEST_NEXT: usize = 4;

/// A Gaussian through the flanks of a clipped pulse; in samples.
pub(super) struct Flanks {
    pub(super) at: f64,
    height: f64,
    width: f64,
}

impl Flanks {
    /// By the parabola through the logarithms of the samples beside the clipped ones. Weights
    /// are squares of heights: so much less is the logarithm's noise.
    pub(super) fn new(view: &ChannelView<'_>, pulse: &Pulse) -> Option<Self> {
        let (first, last) = pulse.clipped?;
        let middle = 0.5 * (first as f64 + last as f64);
        let half = pulse.width_samples.max(4.0);
        let samples = flank_samples(view, pulse, (first, last)).into_iter();
        let equations = samples.map(|(sample, height)| {
            let u = (sample - middle) / half;
            ([height, height * u, height * u * u], height * height.ln())
        });
        let [constant, slope, curvature] = LinearSolution::of(3, equations)?.values;
        let u = -0.5 * slope / curvature;
        let found = Self {
            at: middle + half * u,
            height: (constant + 0.5 * slope * u).exp(),
            width: 2.0 * half * (LN_2 / -curvature).sqrt(),
        };
        let inside = (found.at - middle).abs() < half && found.height >= pulse.height;
        (curvature < 0.0 && inside).then_some(found)
    }

    pub(super) fn pulse(&self, clipped: &Pulse) -> Pulse {
        Pulse {
            height: self.height,
            width_samples: self.width,
            sides_samples: (0.5 * self.width, 0.5 * self.width),
            ..*clipped
        }
    }

    /// From the maximum to where the flanks are at their feet.
    pub(super) fn half(&self, clipped: &Pulse) -> f64 {
        let foot = FOOT * clipped.height / self.height;
        let deep = (-foot.ln() / LN_2).sqrt();
        (0.5 * self.width * deep).max(4.0)
    }
}

/// Samples and heights from the clipped ones to the foot on the steeper side, and as far on the
/// other: the tail of an asymmetric pulse, or what it stands on, is no flank.
fn flank_samples(
    view: &ChannelView<'_>,
    pulse: &Pulse,
    (first, last): (usize, usize),
) -> Vec<(f64, f64)> {
    let foot = FOOT * pulse.height;
    let tall = |at: usize| Some((at as f64, view.height(at).filter(|height| *height > foot)?));
    let whole = |at: &usize| !pulse.is_clipped(*at);
    let before = (0..first).rev().filter(whole).map_while(tall);
    let after = (last..view.samples.len()).filter(whole).map_while(tall);
    let (before, after): (Vec<_>, Vec<_>) = (before.collect(), after.collect());
    let shorter = before.len().min(after.len()).max(FEWEST_NEXT);
    let both = before.into_iter().take(shorter);
    both.chain(after.into_iter().take(shorter)).collect()
}
