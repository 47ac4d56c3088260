//! Hum and drift: a slow baseline fitted around a channel's pulses, and subtracted under them.

use std::ops::Range;

use crate::signal::linear::{LinearSolution, LocalPolynomial, Row, differentiated, powers};
use crate::signal::statistics::{mean, median, median_and_spread, squares_about_mean};
use crate::signal::{Found, Pulse};

/// Highest degree of the baseline: over a shot of 3 ms mains hum of 20 % is a cubic to 0.1 %.
const HIGHEST: usize = 3;
/// Widths before a pulse's maximum, and after the last one's, that are not baseline.
pub(super) const MARGIN: f64 = 2.0;
/// Times of flight before the first pulse over which the baseline is fitted.
const BEFORE: f64 = 1.5;
const FEWEST: usize = 64;
/// Parts of what is before the first pulse whose means show a drift, or hum, and the ratio of variances
/// from which on it is one: by chance in 1 of 5,000 records.
const PARTS: usize = 16;
const SIGNIFICANT: f64 = 15.0;
/// Share of the first pulse's height below which a drift moves no maximum.
const LEAST: f64 = 1e-4;
/// Standard errors by which means of parts may be off the baseline: more is a step, or a tail.
const MOST_OFF: f64 = 3.0;
/// Places at which a step is tried at a time, and samples on either side of it.
const PLACES: usize = 16;
const EACH_SIDE: usize = 8;
/// Degree of a polynomial that follows what is smooth better than one with a step does.
const WAVY: usize = 7;

pub(super) struct Detrended {
    pub(super) samples: Vec<f64>,
    first: usize,
    half: f64,
    fit: BackgroundFit,
}

impl Detrended {
    /// The record less its baseline, if that changes significantly before the first pulse. `pulses`
    /// are those of this channel in order, `time` is that of flight in samples.
    ///
    /// Polynomials are fitted to the quiet stretch and to the second half of what lies between the
    /// first two pulses, where the first one's tail has gone by; with a step at one of these samples
    /// where they follow no polynomial. What lies before and after is that of `without_hum`, if there is
    /// such a record.
    pub(super) fn new(
        samples: &[f64],
        without_hum: Option<&[f64]>,
        pulses: &[Pulse],
        time: f64,
    ) -> Option<Self> {
        let (one, last) = (pulses.first()?, pulses.last()?);
        let margin = |pulse: &Pulse| (MARGIN * pulse.width_samples) as usize;
        let quiet_end = one.at.checked_sub(margin(one))?;
        let first = quiet_end.saturating_sub((BEFORE * time) as usize);
        let quiet = samples.get(first..quiet_end).filter(|quiet| quiet.len() >= FEWEST)?;
        if !drifts(quiet, LEAST * one.height) {
            return None;
        }
        let gap = pulses.get(1).map_or(0..0, |two| {
            let middle = usize::midpoint(one.at, two.at).max(one.at + 2 * margin(one));
            middle..two.at.saturating_sub(margin(two))
        });
        let end = (last.at + margin(last)).min(samples.len() - 1);
        let half = (end - first) as f64;
        let stretches = [first..quiet_end, gap];
        let background = Background { samples, stretches, first, half };
        let best = background.smooth().filter(|fit| background.holds(fit));
        let best = best.or_else(|| background.stepped().filter(|fit| background.holds(fit)))?;
        let level = best.solution.values[0];
        let own = |at: usize| samples[at] - (background.value(&best, at.min(end)) - level);
        if let Some(calm) = without_hum {
            let shift = level - mean(&calm[first..quiet_end]);
            let mut without: Vec<f64> = calm.iter().map(|sample| sample + shift).collect();
            (first..=end).for_each(|at| without[at] = own(at));
            return Some(Self { samples: without, first, half, fit: best });
        }
        let mut without = samples.to_vec();
        (first..samples.len()).for_each(|at| without[at] = own(at));
        // What lies before is quiet as well; each part has its own baseline.
        for part in without[..first].rchunks_mut(quiet_end - first) {
            let length = part.len() as f64;
            if let Some(own) =
                LocalPolynomial::through(part, 0.0, 0.5 * length, 0.5 * length, HIGHEST)
            {
                for (at, sample) in part.iter_mut().enumerate() {
                    let u = (at as f64 - 0.5 * length) / (0.5 * length);
                    *sample -= own.at(u).value - level;
                }
            }
        }
        Some(Self { samples: without, first, half, fit: best })
    }

    /// Standard error in samples of a maximum of this height and width, as the slope of the baseline
    /// beneath it is open.
    pub(super) fn time_error(&self, at: f64, height: f64, width: f64) -> f64 {
        let mut row = differentiated(&powers((at - self.first as f64) / self.half));
        // A step in it has no slope.
        row[self.fit.degree + 1..].fill(0.0);
        let slope = self.fit.noise * self.fit.solution.variance(&row).sqrt() / self.half;
        time_error(slope, height, width)
    }

    /// Standard error of a height there, as the baseline beneath it is open.
    pub(super) fn height_error(&self, at: f64) -> f64 {
        let mut row = powers((at - self.first as f64) / self.half);
        row[self.fit.degree + 1..].fill(0.0);
        self.fit.noise * self.fit.solution.variance(&row).sqrt()
    }
}

/// By how much a slope beneath it moves a maximum of this height and width: slope over curvature,
/// that of a Gaussian.
pub(super) fn time_error(slope: f64, height: f64, width: f64) -> f64 {
    slope * width * width / (8.0 * std::f64::consts::LN_2 * height)
}

/// Stretches of a channel without pulses, and the unit of the polynomials through them.
struct Background<'a> {
    samples: &'a [f64],
    stretches: [Range<usize>; 2],
    first: usize,
    half: f64,
}

/// A polynomial with a step, if it has one, as its last term.
struct BackgroundFit {
    solution: LinearSolution,
    degree: usize,
    step: Option<usize>,
    noise: f64,
    /// Schwarz's, which weighs squares against parameters.
    criterion: f64,
}

impl Background<'_> {
    fn members(&self) -> impl Iterator<Item = usize> + Clone {
        self.stretches.iter().cloned().flatten()
    }

    fn row(&self, at: usize, degree: usize, step: Option<usize>) -> Row {
        let mut row = powers((at as f64 - self.first as f64) / self.half);
        if let Some(step) = step {
            row[degree + 1] = f64::from(u8::from(at >= step));
        }
        row
    }

    fn value(&self, fit: &BackgroundFit, at: usize) -> f64 {
        fit.solution.value(&self.row(at, fit.degree, fit.step))
    }

    fn smooth(&self) -> Option<BackgroundFit> {
        let fits = (1..=HIGHEST).filter_map(|degree| self.fit(degree, None));
        fits.min_by(|a, b| a.criterion.total_cmp(&b.criterion))
    }

    /// With a step where that leaves least, found among ever closer places. `None` if it is at an
    /// end of a stretch, where it may as well be under a pulse, or if it is smooth: a pulse's tail.
    fn stepped(&self) -> Option<BackgroundFit> {
        let members: Vec<usize> = self.members().collect();
        let (mut low, mut high) = (EACH_SIDE, members.len().checked_sub(EACH_SIDE)?);
        let fit = |i: &usize| Some((*i, self.fit(HIGHEST, Some(*members.get(*i)?))?));
        loop {
            let apart = high.checked_sub(low)?.div_ceil(PLACES).max(1);
            let places: Vec<usize> = (low..=high).step_by(apart).collect();
            let fits = places.iter().filter_map(fit);
            let (i, best) = fits.min_by(|a, b| a.1.criterion.total_cmp(&b.1.criterion))?;
            if apart == 1 {
                let around = members.get(i.checked_sub(EACH_SIDE)?..i + EACH_SIDE)?;
                let is_within = around[2 * EACH_SIDE - 1] - around[0] == 2 * EACH_SIDE - 1;
                let smooth = self.fit(WAVY, None)?;
                return (is_within && best.noise < smooth.noise).then_some(best);
            }
            (low, high) = (low.max(i.saturating_sub(apart)), high.min(i + apart));
        }
    }

    fn fit(&self, degree: usize, step: Option<usize>) -> Option<BackgroundFit> {
        let terms = degree + 1 + usize::from(step.is_some());
        let members = self.members();
        let equation = |at: usize| (self.row(at, degree, step), self.samples[at]);
        let solution = LinearSolution::of(terms, members.clone().map(equation))?;
        let mut found = BackgroundFit { solution, degree, step, noise: 0.0, criterion: 0.0 };
        let squares = members.clone().map(|at| (self.samples[at] - self.value(&found, at)).powi(2));
        let (squares, count) = (squares.sum::<f64>(), members.count() as f64);
        found.noise = (squares / (count - terms as f64)).sqrt();
        found.criterion = count * squares.max(f64::MIN_POSITIVE).ln() + terms as f64 * count.ln();
        Some(found)
    }

    /// Whether the means of four parts of each stretch follow it.
    fn holds(&self, fit: &BackgroundFit) -> bool {
        self.stretches.iter().all(|stretch| {
            let error = fit.noise / (stretch.len() as f64 / 4.0).sqrt();
            let parts = stretch.clone().collect::<Vec<_>>();
            parts.chunks(stretch.len().div_ceil(4).max(1)).all(|part| {
                let off: f64 = part.iter().map(|at| self.samples[*at] - self.value(fit, *at)).sum();
                (off / part.len() as f64).abs() <= MOST_OFF * error
            })
        })
    }
}

/// Whether means of parts follow a cubic much more closely than they follow a constant.
fn drifts(quiet: &[f64], least: f64) -> bool {
    let length = quiet.len() / PARTS;
    let mean = |part: &[f64]| part.iter().map(|x| x - quiet[0]).sum::<f64>() / part.len() as f64;
    let means: Vec<f64> = quiet.chunks_exact(length).take(PARTS).map(mean).collect();
    let middle = 0.5 * (PARTS as f64 - 1.0);
    let Some(cubic) = LocalPolynomial::through(&means, 0.0, middle, middle, HIGHEST) else {
        return false;
    };
    let all = squares_about_mean(&means);
    let left = cubic.residual.powi(2) * cubic.freedom;
    let explained = all - left;
    explained > PARTS as f64 * least * least
        && explained / HIGHEST as f64 > SIGNIFICANT * left / cubic.freedom
}

// Hum in records much longer than a shot, where it is as high as pulses and wider.

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
/// Rounds of least squares of distances, then of squares without what is far off.
const ROUNDS: [usize; 2] = [8, 4];
/// Robust deviations from which on a mean is no hum but a pulse.
const FAR: f64 = 4.7;

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
        let cubic = LinearSolution::of(HIGHEST + 1, equations)?;
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
    let end = first.at.saturating_sub((MARGIN * first.width_samples) as usize);
    if !found.pulses().all(narrow) || end as f64 * interval_s < HALF_S {
        return false;
    }
    let variance = |samples: &[f64]| {
        let means = samples[..end].chunks_exact(end / PARTS).map(mean);
        squares_about_mean(&means.collect::<Vec<_>>())
    };
    variance(samples) > SIGNIFICANT * variance(without)
}
