//! The fixed-point iteration behind the solitary shape.

use super::grid::CosineGrid;
use crate::chain::ChainError;
use crate::theory::not_converged;

/// The spectrum counts as resolved when its last tenth is below this; the
/// coefficients add up to the peak, 1, so this is a share of the peak.
const RESOLVED: f64 = 3e-16;
/// Coefficients after the last one above this are rounding and are dropped.
const NEGLIGIBLE: f64 = 1e-17;
/// First grid tried, points a bead.
const COARSEST: usize = 8;
/// Finest grid tried, points a bead; reached only if the spectrum never falls off.
const FINEST: usize = 128;
/// The slowest exponent, 1.02, needs about half of these.
const MOST_STEPS: usize = 5000;
/// A fixed point worse than this is reported as a failure.
const ACCEPTED: f64 = 1e-13;

/// The solved shape, in the units of [`super::SolitaryShape`].
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Solution {
    /// The shape is zero to rounding farther out, beads.
    pub half_window: f64,
    /// Cosine coefficients of the force shape pⁿ.
    pub force: Vec<f64>,
    /// σ.
    pub speed_squared: f64,
    /// ∫ pⁿ dx.
    pub force_area: f64,
    /// ∫ pⁿ⁺¹ dx.
    pub work_area: f64,
    /// ∫ V² dx with V the mean of pⁿ over a bead.
    pub velocity_square_area: f64,
}

/// Solves for the shape on grids twice as fine each, until the spectrum is resolved.
pub(super) fn solve(exponent: f64) -> Result<Solution, ChainError> {
    let half_window = half_window_beads(exponent);
    let mut per_bead = COARSEST;
    while per_bead <= FINEST {
        let grid = CosineGrid::new(half_window, per_bead);
        let found = fixed_point(&grid, exponent)?;
        if resolved(&found.force) {
            return Ok(measured(&grid, exponent, half_window, found));
        }
        per_bead *= 2;
    }
    Err(not_converged("spectrum of the solitary wave", RESOLVED))
}

fn measured(grid: &CosineGrid, exponent: f64, half_window: usize, found: FixedPoint) -> Solution {
    let velocity = grid.samples(&filtered(grid, &found.force, 1));
    let powers = |power: f64| found.overlap.iter().map(move |p| p.powf(power));
    Solution {
        half_window: half_window as f64,
        speed_squared: found.speed_squared,
        force_area: grid.integral(powers(exponent)),
        work_area: grid.integral(powers(exponent + 1.0)),
        velocity_square_area: grid.integral(velocity.iter().map(|v| v * v)),
        force: without_rounding(found.force),
    }
}

fn without_rounding(mut coefficients: Vec<f64>) -> Vec<f64> {
    let last = coefficients.iter().rposition(|a| a.abs() > NEGLIGIBLE);
    coefficients.truncate(last.map_or(0, |mode| mode + 1));
    coefficients
}

struct FixedPoint {
    overlap: Vec<f64>,
    force: Vec<f64>,
    speed_squared: f64,
}

/// p ← Λ∗pⁿ / (Λ∗pⁿ)(0). Fixing the peak removes the one growing direction
/// (factor n), evenness removes the translation (factor 1); what is left
/// shrinks by about 1/n a step.
fn fixed_point(grid: &CosineGrid, exponent: f64) -> Result<FixedPoint, ChainError> {
    let variance = gaussian_variance(exponent);
    let mut overlap: Vec<f64> = grid.positions().map(|x| (-0.5 * x * x / variance).exp()).collect();
    let mut change = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let (next, _, _) = iterate(grid, exponent, &overlap);
        let last_change = change;
        change = largest_difference(&next, &overlap);
        overlap = next;
        let at_rounding = change >= last_change && change < ACCEPTED;
        if at_rounding || change == 0.0 {
            break;
        }
    }
    if change > ACCEPTED {
        return Err(not_converged("solitary wave iteration", change));
    }
    let (overlap, force, speed_squared) = iterate(grid, exponent, &overlap);
    Ok(FixedPoint { overlap, force, speed_squared })
}

fn iterate(grid: &CosineGrid, exponent: f64, overlap: &[f64]) -> (Vec<f64>, Vec<f64>, f64) {
    let powers: Vec<f64> = overlap.iter().map(|p| p.max(0.0).powf(exponent)).collect();
    let force = grid.coefficients(&powers);
    let mut next = grid.samples(&filtered(grid, &force, 2));
    let peak = next.first().copied().unwrap_or(1.0);
    next.iter_mut().for_each(|p| *p = (*p / peak).max(0.0));
    (next, force, peak)
}

fn filtered(grid: &CosineGrid, coefficients: &[f64], times: i32) -> Vec<f64> {
    let damp = |(mode, a): (usize, &f64)| a * sinc(0.5 * grid.wavenumber(mode)).powi(times);
    coefficients.iter().enumerate().map(damp).collect()
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

fn resolved(coefficients: &[f64]) -> bool {
    let tail = coefficients.len() / 10 + 1;
    let last = coefficients.iter().rev().take(tail);
    last.map(|a| a.abs()).fold(0.0, f64::max) < RESOLVED
}

/// For n → 1 the wave is a Gaussian whose variance s solves s = s/n + 1/6
/// (1/6 is the variance of Λ): the start of the iteration, and an upper bound
/// of the true wave's tails.
fn gaussian_variance(exponent: f64) -> f64 {
    exponent / (6.0 * (exponent - 1.0))
}

fn half_window_beads(exponent: f64) -> usize {
    // e^−40 is below the rounding of 1.
    let log_rounding = 40.0;
    (2.0 * log_rounding * gaussian_variance(exponent)).sqrt().ceil() as usize + 1
}

/// sin(x)/x: the factor of averaging over a bead, at x half the wave number.
pub(super) fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}
