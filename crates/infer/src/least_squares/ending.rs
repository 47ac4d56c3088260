//! What a descent's end means once derivatives are known better.

use super::descent::{Ending, Reached, SMALL_FALL};
use super::fit::Binding;
use super::jacobian::{EXTRAPOLATED, Jacobian, ROUNDING};
use super::merit::Linear;
use crate::Parameter;
use crate::identify::{is_weak, sized};
use crate::linear::{dot, norm, svd};

/// Disagreement of derivatives by two step sizes from which they tell nothing of where a
/// minimum is.
const DOUBTFUL: f64 = 0.1;

/// Why a descent ended, in the light of derivatives by two step sizes: one that came to no
/// rest has done so if all that χ² is still to fall lies along combinations that the data
/// leave open. There a descent's own derivatives tell noise, and the minimum is a line.
pub(super) fn ending(
    parameters: &[Parameter],
    best: &Reached,
    (linear, jacobian): (&Linear, &Jacobian),
    binding: &[Binding],
) -> Ending {
    let restless = matches!(
        best.ending,
        Ending::Stuck { .. } | Ending::Iterations { .. }
    );
    if !restless || jacobian.worst_disagreement() > DOUBTFUL {
        return best.ending.clone();
    }
    let sizes = sized(parameters, &best.point);
    let held = |k: &usize| binding.iter().any(|b| b.parameter == *k);
    let loose = (0..parameters.len()).filter(|k| !held(k));
    let loose: Vec<Loose> = loose
        .map(|k| Loose {
            column: linear.columns[k]
                .iter()
                .map(|x| x * sizes[k].scale)
                .collect(),
            slope: linear.gradient[k] * sizes[k].scale,
            doubt: ROUNDING + EXTRAPOLATED * jacobian.disagreement[k],
        })
        .collect();
    match determined_fall(&loose) {
        Some(expected_fall) if expected_fall < SMALL_FALL => Ending::Open { expected_fall },
        _ => best.ending.clone(),
    }
}

/// A parameter that no bound holds, in units of its size.
struct Loose {
    column: Vec<f64>,
    /// Slope of the cost.
    slope: f64,
    /// Share of the column's length that it may be wrong by.
    doubt: f64,
}

/// Expected fall of the cost along combinations that the rows determine; `None` if that
/// is all of them.
fn determined_fall(loose: &[Loose]) -> Option<f64> {
    let columns: Vec<Vec<f64>> = loose.iter().map(|one| one.column.clone()).collect();
    let errors = loose.iter().map(|one| one.doubt * norm(&one.column));
    let floor = norm(&errors.collect::<Vec<f64>>());
    let slopes: Vec<f64> = loose.iter().map(|one| one.slope).collect();
    let found = svd(&columns);
    let pairs = found.values.iter().zip(&found.right);
    let known = pairs.filter(|(value, _)| !is_weak(**value, floor));
    let falls = known.map(|(value, direction)| 0.5 * (dot(direction, &slopes) / value).powi(2));
    let falls: Vec<f64> = falls.collect();
    (falls.len() < loose.len()).then(|| falls.iter().sum())
}

#[cfg(test)]
#[path = "tests/ending.rs"]
mod tests;
