//! Hum in records much longer than a shot, where it is as high as pulses and wider.

use crate::signal::linear::{LinearSolution, Row, differentiated, powers};
use crate::signal::statistics::{mean, median, median_and_spread, squares_about_mean};
use crate::signal::{Found, Pulse};

/// Half the stretch in s that one cubic follows: a quarter of a period of 250 Hz, many pulses wide.
const HALF_S: f64 = 1e-3;
/// Means of samples in half a stretch, and cubics in it.
const MEANS: usize = 96;
const CUBICS: usize = 3;
/// Shorter records, in halves of a stretch, have hum that is one cubic under a shot.
const SHORTEST: usize = 4;
/// Standard errors by which medians of stretches spread where there is hum.
const SPREADS: f64 = 3.0;
/// Pulses have at most this share of half a stretch as their width, else cubics follow them.
const WIDEST: f64 = 0.1;
/// Parts of what lies before the first pulse whose means show hum, and by how much more than without it.
const PARTS: usize = 16;
const SIGNIFICANT: f64 = 15.0;
/// Rounds of least squares of distances, then of squares without what is far off.
const ROUNDS: [usize; 2] = [8, 4];
/// Robust deviations from which on a mean is no hum but a pulse.
const FAR: f64 = 4.7;
const DEGREE: usize = 3;

/// A record less its hum, which keeps the level it began with; `None` where it is too short or has none.
pub(super) fn without_hum(samples: &[f64], interval_s: f64) -> Option<Vec<f64>> {
    let length = ((HALF_S / interval_s) as usize / MEANS).max(1);
    let means: Vec<f64> = samples.chunks_exact(length).map(mean).collect();
    if means.len() < SHORTEST * MEANS || !wanders(&means) {
        return None;
    }
    let spacing = MEANS / CUBICS;
    let knots: Vec<[f64; 2]> =
        (0..=means.len() / spacing).map(|k| hum_at(&means, k * spacing)).collect::<Option<_>>()?;
    let apart = (spacing * length) as f64;
    let level = knots[0][0];
    let hum = |at: usize| {
        let place = (at as f64 - 0.5 * (length as f64 - 1.0)) / apart;
        let first = (place.max(0.0) as usize).min(knots.len() - 2);
        between([knots[first], knots[first + 1]], place - first as f64)
    };
    Some(samples.iter().enumerate().map(|(at, sample)| sample - (hum(at) - level)).collect())
}

/// Whether stretches lie at other levels than noise alone would leave them.
fn wanders(means: &[f64]) -> bool {
    let levels = means.chunks_exact(MEANS).filter_map(median_and_spread);
    let (levels, noises): (Vec<f64>, Vec<f64>) = levels.unzip();
    let noise = median(&noises).unwrap_or_default() / (MEANS as f64).sqrt();
    median_and_spread(&levels).is_some_and(|(_, spread)| spread > SPREADS * noise)
}

/// Value of the hum at a mean, and its slope over the distance of two knots: of a cubic about it from
/// which pulses stand out.
fn hum_at(means: &[f64], centre: usize) -> Option<[f64; 2]> {
    let first = centre.saturating_sub(MEANS);
    let near = means.get(first..means.len().min(centre + MEANS + 1))?;
    let row = |i: usize| powers(((first + i) as f64 - centre as f64) / MEANS as f64);
    let mut weights = vec![1.0; near.len()];
    let mut found = [0.0; 2];
    for round in 0..ROUNDS[0] + ROUNDS[1] {
        let weighted = near.iter().enumerate().zip(&weights);
        let equations =
            weighted.map(|((i, mean), weight)| (row(i).map(|x| x * weight), mean * weight));
        let cubic = LinearSolution::of(DEGREE + 1, equations)?;
        let value = |row: &Row| cubic.value(row);
        let off: Vec<f64> = near.iter().enumerate().map(|(i, y)| y - value(&row(i))).collect();
        found = [value(&powers(0.0)), value(&differentiated(&powers(0.0))) / CUBICS as f64];
        let (_, spread) = median_and_spread(&off)?;
        if spread <= 0.0 {
            break;
        }
        let weight = |off: &f64| match round < ROUNDS[0] {
            true => (off.abs() / spread).max(0.1).sqrt().recip(),
            false => (1.0 - (off / (FAR * spread)).powi(2)).max(0.0),
        };
        weights = off.iter().map(weight).collect();
    }
    Some(found)
}

/// The cubic with these values and slopes at 0 and 1.
fn between([[a, slope_a], [b, slope_b]]: [[f64; 2]; 2], u: f64) -> f64 {
    let v = 1.0 - u;
    a * v * v * (1.0 + 2.0 * u) + b * u * u * (1.0 + 2.0 * v) + u * v * (slope_a * v - slope_b * u)
}

/// Whether pulses that were found without it show that it is hum: it is seen before the first one, and
/// they are much narrower than what cubics follow.
pub(super) fn is_hum(found: &Found, samples: &[f64], without: &[f64], interval_s: f64) -> bool {
    let narrow = |pulse: &Pulse| pulse.width_samples * interval_s <= WIDEST * HALF_S;
    let Some(first) = found.incident.filter(|_| found.wall.is_some()) else { return false };
    let end = first.at.saturating_sub((2.0 * first.width_samples) as usize);
    if !found.pulses().all(narrow) || end as f64 * interval_s < HALF_S {
        return false;
    }
    let variance = |samples: &[f64]| {
        let means = samples[..end].chunks_exact(end / PARTS).map(mean);
        squares_about_mean(&means.collect::<Vec<_>>())
    };
    variance(samples) > SIGNIFICANT * variance(without)
}
