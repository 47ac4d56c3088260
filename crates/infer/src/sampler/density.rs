//! Logarithm of the posterior density.

use crate::least_squares::Merit;
use crate::{Loss, Prior, Problem};

/// ln of likelihood times priors up to a constant, for points within bounds;
/// −∞ where the model fails.
pub(super) fn ln_densities(problem: &dyn Problem, loss: Loss, points: &[Vec<f64>]) -> Vec<f64> {
    let merit = Merit::new(problem, loss);
    let mut found = problem.residuals(points).into_iter();
    let density = |point: &Vec<f64>| {
        let valued = found.next().map(|found| merit.value(point, &found));
        match valued {
            Some(Ok(valued)) => -valued.cost - measure(problem, point),
            _ => f64::NEG_INFINITY,
        }
    };
    points.iter().map(density).collect()
}

/// Σ ln θ over log-normal priors, which are densities over θ itself here.
fn measure(problem: &dyn Problem, point: &[f64]) -> f64 {
    let parameters = problem.parameters().iter().zip(point);
    parameters
        .filter(|(p, _)| matches!(p.prior, Prior::LogNormal { .. }))
        .map(|(_, value)| value.ln())
        .sum()
}

/// Whether a point is within all bounds.
pub(super) fn admitted(problem: &dyn Problem, point: &[f64]) -> bool {
    let mut parameters = problem.parameters().iter().zip(point);
    parameters.all(|(parameter, value)| parameter.admits(*value))
}
