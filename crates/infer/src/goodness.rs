//! Goodness of fit: chi-square, runs of equal sign, the largest residual.

use crate::identify::directions_at;
use crate::least_squares::DOUBTFUL;
use crate::{Fit, Loss, Problem};
use hertzchain_measure::signal::ChiSquare;
use std::ops::Range;

/// How well a fit describes its data.
#[derive(Clone, Debug, PartialEq)]
pub struct Goodness {
    /// Chi-square of data and priors together; `None` if there are no more of them than parameters.
    pub chi_square: Option<ChiSquare>,
    /// Numbers that a robust fit leaves out of chi-square as outliers.
    pub outliers: usize,
    /// √(χ²/degrees of freedom): what all σ would have to be multiplied by.
    pub birge_ratio: Option<f64>,
    /// Runs of equal sign in the order of the data; `None` where there is no chi-square.
    pub runs: Option<Runs>,
    /// The measured number with the largest residual.
    pub largest: Option<Largest>,
}

/// A measured number whose residual is the largest.
#[derive(Clone, Debug, PartialEq)]
pub struct Largest {
    /// Number of its residual.
    pub residual: usize,
    /// What was measured.
    pub label: String,
    /// Its distance in standard errors of that distance.
    pub sigmas: f64,
}

/// p below which data reject a model: of a thousand fits of right models one is rejected.
pub(crate) const LEAST_BY_CHANCE: f64 = 1e-3;

/// Chi-square of standardised residuals, with the degrees of freedom f of their σ, and the fitted
/// number of parameters.
///
/// A σ of few shots is widened by √(f/(f − 4)) for the parameters' errors, which makes squares of
/// residuals (f − 4)/(f − 2) on average: they are taken to 1. They are those of Student's t, whose
/// variance is (3(f − 2)/(f − 4) − 1)/2 times as large as that of normal deviates.
pub(crate) fn chi_square_of(
    residuals: impl Iterator<Item = (f64, f64)>,
    fitted: usize,
) -> Option<ChiSquare> {
    let (mut value, mut spread, mut count) = (0.0, 0.0, 0_usize);
    for (residual, freedom) in residuals {
        let student = if freedom.is_finite() { (freedom - 2.0) / (freedom - 4.0) } else { 1.0 };
        value += student * residual * residual;
        spread += 0.5 * (3.0 * student - 1.0);
        count += 1;
    }
    ChiSquare::of(value, count.checked_sub(fitted)?, spread / count.max(1) as f64)
}

/// The same of a fit's data and priors.
pub(crate) fn chi_square_of_fit(fit: &Fit, fitted: usize) -> Option<ChiSquare> {
    let data = fit.residuals.iter().copied().zip(fit.freedoms.iter().copied());
    chi_square_of(data.chain(priors(fit)), fitted)
}

fn priors(fit: &Fit) -> impl Iterator<Item = (f64, f64)> {
    fit.priors.iter().map(|residual| (*residual, f64::INFINITY))
}

/// Residuals beyond so many standard errors are outliers to a robust fit, up to a share of all.
const OUTLIER: f64 = 4.0;
const MOST_OUTLIERS: f64 = 0.2;

impl Goodness {
    /// Of a fit of a problem.
    pub fn new(problem: &dyn Problem, fit: &Fit) -> Self {
        Self::with_nuisances(0, problem, fit)
    }

    /// Of a fit in whose residuals so many nuisance parameters were at their best. As many degrees
    /// of freedom are left as data and priors have numbers more than the combinations of parameters
    /// that they determine.
    pub fn with_nuisances(nuisances: usize, problem: &dyn Problem, fit: &Fit) -> Self {
        let outliers = outliers(fit);
        let data = fit.residuals.iter().copied().zip(fit.freedoms.iter().copied());
        let data = data.filter(|(residual, _)| outliers == 0 || residual.abs() < OUTLIER);
        let chi_square = chi_square_of(data.chain(priors(fit)), nuisances + fit.rank);
        Self {
            outliers,
            birge_ratio: chi_square.map(|found| (found.value / found.freedom as f64).sqrt()),
            chi_square,
            // As many numbers as parameters are met, but for rounding: its signs mean nothing.
            runs: chi_square.and_then(|_| runs(&fit.residuals)),
            // Where a curve jumps, derivatives do not say what follows a number.
            largest: largest_residual(problem, fit, 0..fit.residuals.len()).filter(|_| {
                fit.ending.converged() || fit.jacobian.worst_disagreement() <= DOUBTFUL
            }),
        }
    }

    /// Whether the data reject the model (p < 0.001).
    pub fn is_rejected(&self) -> bool {
        self.chi_square.is_some_and(|found| found.probability < LEAST_BY_CHANCE)
    }
}

/// Residuals that a robust fit leaves out of chi-square: few that are far off.
fn outliers(fit: &Fit) -> usize {
    let beyond = fit.residuals.iter().filter(|residual| residual.abs() >= OUTLIER).count();
    let are_few = beyond as f64 <= MOST_OUTLIERS * fit.residuals.len() as f64;
    if fit.loss != Loss::Squares && are_few { beyond } else { 0 }
}

/// Difference of squared distances below which either of two numbers that share errors may be the
/// one that is off: odds of less than seven.
const EITHER: f64 = 4.0;

/// Share of a number's own information below which no other checks it.
const UNCHECKED: f64 = 1e-6;

/// The measured number, of those with these residuals, that has the largest distance from what the
/// model makes of all others.
///
/// Residuals of numbers that share errors are combinations of them. So each number y is left out in
/// turn: with u = ∂r/∂y and H the projector on what the fitted combinations can change,
/// uᵀ r/√(uᵀ (1 − H) u) is its distance from what is left, in standard errors [Baarda1968]. Numbers
/// that others do not check have none.
pub fn largest_residual(problem: &dyn Problem, fit: &Fit, of: Range<usize>) -> Option<Largest> {
    let responses = problem.responses(&fit.point).ok()?;
    let directions = directions_at(problem.parameters(), fit);
    let distance = |at: usize| {
        let own = [(at, 1.0)];
        let response = responses.as_ref().map_or(&own[..], |all| &all[at]);
        let along = |direction: &[f64]| -> f64 {
            response.iter().map(|(row, change)| change * direction[*row]).sum()
        };
        let whole: f64 = response.iter().map(|(_, change)| change * change).sum();
        let free = whole - directions.iter().map(|one| along(one).powi(2)).sum::<f64>();
        (free > UNCHECKED * whole).then(|| (at, along(&fit.residuals) / free.sqrt()))
    };
    let all: Vec<(usize, f64)> = of.filter_map(distance).collect();
    let (residual, sigmas) = *all.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let shares = |other: usize| {
        responses.as_ref().is_some_and(|all| {
            let mut rows = all[residual].iter().map(|(row, _)| row);
            rows.any(|row| all[other].iter().any(|(own, _)| own == row))
        })
    };
    let is_as_large = |(other, size): &&(usize, f64)| {
        *other != residual && sigmas.powi(2) - size.powi(2) < EITHER && shares(*other)
    };
    let others = all.iter().filter(is_as_large);
    let others = others.map(|(other, _)| format!(" or {}", problem.residual_label(*other)));
    let label = problem.residual_label(residual) + &others.collect::<String>();
    Some(Largest { residual, label, sigmas })
}

/// Runs of equal sign in a row of residuals: too few mean that the curve's shape is wrong, though
/// each point may be near it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Runs {
    /// Number of runs.
    pub count: usize,
    /// Number expected of chance.
    pub expected: f64,
    /// Probability of as few or fewer.
    pub probability_fewer: f64,
    /// Probability of as many or more.
    pub probability_more: f64,
}

/// Runs test of Wald and Wolfowitz [WaldWolfowitz1940], exact: the share of all orders of these
/// signs that have as few runs, or as many. Zeros are left out. `None` if all signs are equal.
///
/// Residuals of a fit are not quite independent: with few points to a parameter the probabilities
/// are rough.
pub fn runs(residuals: &[f64]) -> Option<Runs> {
    let signs = residuals.iter().filter(|r| **r != 0.0).map(|r| *r > 0.0);
    let signs: Vec<bool> = signs.collect();
    let above = signs.iter().filter(|s| **s).count();
    let below = signs.len() - above;
    if above == 0 || below == 0 {
        return None;
    }
    let count = 1 + signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let share = |range: std::ops::RangeInclusive<usize>| -> f64 {
        range.map(|runs| run_probability(runs, above, below)).sum()
    };
    Some(Runs {
        count,
        expected: 1.0 + 2.0 * above as f64 * below as f64 / signs.len() as f64,
        probability_fewer: share(2..=count).min(1.0),
        probability_more: share(count..=signs.len()).min(1.0),
    })
}

/// Share of the orders of two kinds of signs that have so many runs.
fn run_probability(runs: usize, above: usize, below: usize) -> f64 {
    let ways = |a: usize, b: usize| {
        let (a, b) = (ln_binomial(above - 1, a), ln_binomial(below - 1, b));
        (a + b - ln_binomial(above + below, above)).exp()
    };
    let half = runs / 2;
    match runs.is_multiple_of(2) {
        true => 2.0 * ways(half - 1, half - 1),
        false => ways(half, half - 1) + ways(half - 1, half),
    }
}

/// ln of n over k; −∞ where there is no way to choose.
fn ln_binomial(n: usize, k: usize) -> f64 {
    if k > n {
        return f64::NEG_INFINITY;
    }
    let k = k.min(n - k);
    (0..k).map(|i| ((n - i) as f64 / (i + 1) as f64).ln()).sum()
}

#[cfg(test)]
#[path = "tests/goodness.rs"]
mod tests;
