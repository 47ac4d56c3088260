//! Where walkers start.

use super::SamplingError;
use super::density::{admitted, ln_densities};
use crate::chance::{Chance, Purpose};
use crate::covariance::Covariance;
use crate::{Fit, Parameter, Problem};

/// Times that a walker without a density is tried again, nearer to the optimum.
const TRIALS: usize = 30;
/// Start of a walker along a direction that the data do not resolve, in units of scales.
const UNRESOLVED: f64 = 0.1;

/// Walkers of one ensemble around the optimum, spread like the covariance
/// within the bounds, and their ln densities.
pub(super) fn ball(
    problem: &dyn Problem,
    (fit, covariance): (&Fit, &Covariance),
    count: usize,
    chance: (u64, u32),
) -> Result<(Vec<Vec<f64>>, Vec<f64>), SamplingError> {
    let mut chance = Chance::new(chance.0, Purpose::Ball(chance.1));
    let draw = |size: f64, chance: &mut Chance| {
        let displacement = displacement(problem.parameters(), fit, covariance, chance);
        let places = fit.point.iter().zip(displacement).zip(problem.parameters());
        places
            .map(|((middle, d), parameter)| inside(middle + size * d, parameter))
            .collect::<Vec<f64>>()
    };
    let mut walkers: Vec<Vec<f64>> = (0..count).map(|_| draw(1.0, &mut chance)).collect();
    let mut densities = ln_densities(problem, fit.loss, &walkers);
    let sound = |walker: &[f64], density: f64| density.is_finite() && admitted(problem, walker);
    for trial in 1..=TRIALS {
        let lost: Vec<usize> = (0..count)
            .filter(|i| !sound(&walkers[*i], densities[*i]))
            .collect();
        if lost.is_empty() {
            return Ok((walkers, densities));
        }
        let size = 0.7_f64.powf(trial as f64);
        let again: Vec<Vec<f64>> = lost.iter().map(|_| draw(size, &mut chance)).collect();
        let found = ln_densities(problem, fit.loss, &again);
        for ((place, walker), density) in lost.into_iter().zip(again).zip(found) {
            (walkers[place], densities[place]) = (walker, density);
        }
    }
    Err(SamplingError::NoPlace)
}

fn displacement(
    parameters: &[Parameter],
    fit: &Fit,
    covariance: &Covariance,
    chance: &mut Chance,
) -> Vec<f64> {
    let mut displacement = covariance.displacement(|| chance.normal());
    for direction in &covariance.unresolved {
        let parts = direction
            .iter()
            .zip(parameters)
            .map(|(d, p)| (d / p.scale).abs());
        let size = UNRESOLVED * chance.normal() / parts.fold(f64::MIN_POSITIVE, f64::max);
        for (sum, part) in displacement.iter_mut().zip(direction) {
            *sum += size * part;
        }
    }
    for binding in &fit.binding {
        // The density falls by e over 1/push from the bound; `inside` mirrors.
        let width = binding
            .push
            .recip()
            .min(parameters[binding.parameter].scale);
        displacement[binding.parameter] += width * chance.normal();
    }
    displacement
}

/// Mirrored at a bound that it passes; halfway between both if that passes the other.
fn inside(value: f64, parameter: &Parameter) -> f64 {
    let (lower, upper) = (parameter.lower, parameter.upper);
    let mirrored = match value {
        value if value < lower => 2.0 * lower - value,
        value if value > upper => 2.0 * upper - value,
        value => value,
    };
    if parameter.admits(mirrored) {
        mirrored
    } else {
        0.5 * (lower + upper)
    }
}
