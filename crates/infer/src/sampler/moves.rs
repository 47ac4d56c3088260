//! Proposals from the other half of an ensemble.

use crate::chance::Chance;

/// A proposed place and what decides on it.
pub(super) struct Proposal {
    pub point: Vec<f64>,
    /// Added to the difference of ln densities.
    pub ln_factor: f64,
    /// The place is taken if this is below that sum.
    pub ln_uniform: f64,
}

/// A proposal for one walker from those that stand still meanwhile.
pub(super) fn propose(
    walker: &[f64],
    others: &[Vec<f64>],
    differential_share: f64,
    chance: &mut Chance,
) -> Proposal {
    let differential = chance.uniform() < differential_share;
    let (point, ln_factor) = if differential {
        (difference(walker, others, chance), 0.0)
    } else {
        stretch(walker, others, chance)
    };
    // 1 − u is never 0.
    let ln_uniform = (1.0 - chance.uniform()).ln();
    Proposal {
        point,
        ln_factor,
        ln_uniform,
    }
}

/// Stretch move [GoodmanWeare2010]: along the line to another walker, by z with
/// density ∝ 1/√z between ½ and 2; accepted with z^(d−1) times the ratio of densities.
fn stretch(walker: &[f64], others: &[Vec<f64>], chance: &mut Chance) -> (Vec<f64>, f64) {
    let other = &others[chance.below(others.len())];
    let z = 0.5 * (1.0 + chance.uniform()).powi(2);
    let pairs = walker.iter().zip(other);
    let point = pairs.map(|(x, o)| o + z * (x - o)).collect();
    (point, (walker.len() as f64 - 1.0) * z.ln())
}

/// Spread of the length of difference moves, so that they reach everywhere.
const LENGTHS: f64 = 0.1;

/// Differential evolution [TerBraak2006]: by the difference of two other walkers
/// times about 2.38/√(2d); as likely there as back.
fn difference(walker: &[f64], others: &[Vec<f64>], chance: &mut Chance) -> Vec<f64> {
    let first = chance.below(others.len());
    let second = (first + 1 + chance.below(others.len() - 1)) % others.len();
    let optimal = 2.38 / (2.0 * walker.len() as f64).sqrt();
    let length = optimal * (1.0 + LENGTHS * chance.normal());
    let pairs = others[first].iter().zip(&others[second]);
    let step = pairs.map(|(a, b)| length * (a - b));
    walker.iter().zip(step).map(|(x, s)| x + s).collect()
}
