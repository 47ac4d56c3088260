//! Hum and drift: a slow baseline fitted around a channel's pulses, and subtracted under them.

use crate::signal::Pulse;
use crate::signal::linear::{
    LinearSolution, LocalPolynomial, NormalEquations, differentiated, powers,
};

/// Highest degree of the baseline: over a shot of 3 ms mains hum of 20 % is a cubic to 0.1 %.
const HIGHEST: usize = 3;
/// Widths before a pulse's maximum, and after the last one's, that are not baseline.
const MARGIN: f64 = 2.0;
/// Times of flight before the first pulse over which the baseline is fitted.
const BEFORE: f64 = 1.5;
const FEWEST: usize = 64;
/// Parts of the quiet stretch whose means show a drift, and the ratio of variances from which on it
/// is one: by chance in 1 of 5,000 records.
const PARTS: usize = 16;
const SIGNIFICANT: f64 = 15.0;
/// Share of the first pulse's height below which a drift moves no maximum.
const LEAST: f64 = 1e-4;
/// Standard errors by which means of parts may be off the baseline: more is a step, or a tail.
const MOST_OFF: f64 = 3.0;

pub(super) struct Detrended {
    pub(super) samples: Vec<f64>,
    first: usize,
    half: f64,
    solution: LinearSolution,
    noise: f64,
}

impl Detrended {
    /// The record less its baseline, if that changes significantly before the first pulse. `pulses`
    /// are those of this channel in order, `time` is that of flight in samples.
    ///
    /// Polynomials are fitted to the quiet stretch and to the second half of what lies between the
    /// first two pulses, where the first one's tail has gone by.
    pub(super) fn new(samples: &[f64], pulses: &[Pulse], time: f64) -> Option<Self> {
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
        let members: Vec<usize> = (first..quiet_end).chain(gap.clone()).collect();
        let fit = |degree| fit(samples, &members, (first, half), degree);
        let fits = (1..=HIGHEST).filter_map(fit);
        let best = fits.min_by(|a, b| a.criterion.total_cmp(&b.criterion))?;
        let off = |range: std::ops::Range<usize>| {
            let error = best.noise / (range.len() as f64 / 4.0).sqrt();
            let parts = range.clone().collect::<Vec<_>>();
            let mut means = parts.chunks(range.len().div_ceil(4).max(1)).map(|part| {
                let miss =
                    |at: &usize| samples[*at] - best.value((*at as f64 - first as f64) / half);
                part.iter().map(miss).sum::<f64>() / part.len() as f64
            });
            means.any(|mean| mean.abs() > MOST_OFF * error)
        };
        if off(first..quiet_end) || off(gap) {
            return None;
        }
        let level = best.solution.values[0];
        let mut without = samples.to_vec();
        for (at, sample) in without.iter_mut().enumerate().skip(first) {
            *sample -= best.value((at.min(end) - first) as f64 / half) - level;
        }
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
        let (solution, noise) = (best.solution, best.noise);
        Some(Self { samples: without, first, half, solution, noise })
    }

    /// Standard error in samples of a maximum of this height and width, as the slope of the baseline
    /// beneath it is open: slope over curvature, that of a Gaussian.
    pub(super) fn time_error(&self, at: f64, height: f64, width: f64) -> f64 {
        let row = differentiated(&powers((at - self.first as f64) / self.half));
        let slope = self.noise * self.solution.variance(&row).sqrt() / self.half;
        slope * width * width / (8.0 * std::f64::consts::LN_2 * height)
    }
}

struct PolynomialFit {
    solution: LinearSolution,
    degree: usize,
    noise: f64,
    /// Schwarz's, which weighs squares against parameters.
    criterion: f64,
}

impl PolynomialFit {
    fn value(&self, u: f64) -> f64 {
        let terms = powers(u).into_iter().zip(self.solution.values);
        terms.take(self.degree + 1).map(|(power, c)| power * c).sum()
    }
}

fn fit(
    samples: &[f64],
    members: &[usize],
    (first, half): (usize, f64),
    degree: usize,
) -> Option<PolynomialFit> {
    let u = |at: usize| (at as f64 - first as f64) / half;
    let mut normal = NormalEquations::new(degree + 1);
    members.iter().for_each(|at| normal.add(&powers(u(*at)), samples[*at]));
    let mut found = PolynomialFit { solution: normal.solve()?, degree, noise: 0.0, criterion: 0.0 };
    let squares = members.iter().map(|at| (samples[*at] - found.value(u(*at))).powi(2));
    let (squares, count) = (squares.sum::<f64>(), members.len() as f64);
    found.noise = (squares / (count - degree as f64 - 1.0)).sqrt();
    found.criterion = count * squares.max(f64::MIN_POSITIVE).ln() + degree as f64 * count.ln();
    Some(found)
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
    let level = means.iter().sum::<f64>() / PARTS as f64;
    let all: f64 = means.iter().map(|mean| (mean - level).powi(2)).sum();
    let left = cubic.residual.powi(2) * cubic.freedom;
    let explained = all - left;
    explained > PARTS as f64 * least * least
        && explained / HIGHEST as f64 > SIGNIFICANT * left / cubic.freedom
}
