//! Where several descents start.

use crate::chance::{Chance, Purpose};
use crate::{Parameter, Prior};

/// `count` points: first where the parameters start, then seeded ones spread
/// over what priors and bounds allow.
pub(crate) fn starts(parameters: &[Parameter], count: usize, seed: u64) -> Vec<Vec<f64>> {
    let first = parameters.iter().map(|p| p.start).collect();
    let others = (1..count).map(|number| {
        let number = u32::try_from(number).unwrap_or(u32::MAX);
        let mut chance = Chance::new(seed, Purpose::Start(number));
        parameters.iter().map(|p| spread(p, &mut chance)).collect()
    });
    std::iter::once(first).chain(others).collect()
}

/// Two bounds of one sign farther apart than this are spread over by logarithm.
const WIDE_RATIO: f64 = 10.0;

/// Factor to either side of a positive number that has no two bounds.
const AROUND: f64 = 10.0;

/// From the prior if there is one, else between the bounds if both exist, else by the
/// logarithm around a positive start, else a normal number as wide as the scale; never
/// beyond a bound.
fn spread(parameter: &Parameter, chance: &mut Chance) -> f64 {
    let (lower, upper) = (parameter.lower, parameter.upper);
    let value = match parameter.prior {
        Prior::Normal { mean, sd } => mean + sd * chance.normal(),
        Prior::LogNormal { median, ln_sd } => median * (ln_sd * chance.normal()).exp(),
        Prior::Flat if lower > 0.0 && upper.is_finite() && upper > WIDE_RATIO * lower => {
            lower * (upper / lower).powf(chance.uniform())
        }
        Prior::Flat if lower.is_finite() && upper.is_finite() => {
            lower + (upper - lower) * chance.uniform()
        }
        Prior::Flat if lower >= 0.0 && parameter.start > 0.0 => {
            parameter.start * AROUND.powf(2.0 * chance.uniform() - 1.0)
        }
        Prior::Flat => parameter.start + parameter.scale * chance.normal(),
    };
    value.clamp(lower, upper)
}
