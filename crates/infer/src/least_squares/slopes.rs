//! Derivatives of residuals by differences.

use super::merit::{Merit, Valued};
use crate::{ModelError, Parameter, Prior, Residuals};

/// Derivatives at a point, one column for each parameter asked for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Slopes {
    /// ∂r/∂θ: rows of the data, then of the priors.
    pub columns: Vec<Vec<f64>>,
    /// ∂(Σ ln σ)/∂θ.
    pub ln_sigma: Vec<f64>,
}

/// Two neighbours of a point along one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stencil {
    pub parameter: usize,
    offsets: [f64; 2],
}

impl Stencil {
    /// Neighbours at ±`step`; both on one side, at one and two steps, where a
    /// bound is in the way; nearer if the bounds leave less room.
    pub(super) fn new(parameter: usize, of: &Parameter, value: f64, step: f64) -> Self {
        let step = step.min(0.25 * (of.upper - of.lower));
        let pairs = [[-step, step], [step, 2.0 * step], [-2.0 * step, -step]];
        let inside = |pair: &[f64; 2]| pair.iter().all(|offset| of.admits(value + offset));
        let offsets = pairs.into_iter().find(inside).unwrap_or(pairs[0]);
        // What rounding leaves of each step.
        let offsets = offsets.map(|offset| (value + offset) - value);
        Self { parameter, offsets }
    }

    pub(super) fn points(&self, point: &[f64]) -> [Vec<f64>; 2] {
        self.offsets.map(|offset| {
            let mut neighbour = point.to_vec();
            neighbour[self.parameter] += offset;
            neighbour
        })
    }

    /// Weights of the left, middle and right value in the derivative of the
    /// parabola through them, or of the line through two if one is missing.
    fn weights(&self, known: [bool; 2]) -> Option<[f64; 3]> {
        let [a, b] = self.offsets;
        match known {
            [true, true] => Some([-b / (a * (a - b)), -(a + b) / (a * b), -a / (b * (b - a))]),
            [true, false] => Some([a.recip(), -a.recip(), 0.0]),
            [false, true] => Some([0.0, -b.recip(), b.recip()]),
            [false, false] => None,
        }
    }

    /// ∂r/∂θ and ∂(Σ ln σ)/∂θ from the neighbours' residuals.
    fn slope(
        &self,
        at: &Valued,
        neighbours: &[Result<Valued, ModelError>; 2],
    ) -> Result<(Vec<f64>, f64), ModelError> {
        let [left, right] = neighbours;
        let Some([a, o, b]) = self.weights([left.is_ok(), right.is_ok()]) else {
            return Err(left.as_ref().err().cloned().unwrap_or_default());
        };
        let middle = |valued: &Result<Valued, ModelError>| valued.as_ref().ok().cloned();
        let left = middle(left).unwrap_or_else(|| at.clone());
        let right = middle(right).unwrap_or_else(|| at.clone());
        let rows = (0..at.rows.len())
            .map(|i| a * left.rows[i] + o * at.rows[i] + b * right.rows[i])
            .collect();
        let sum = |valued: &Valued| valued.ln_sigmas.iter().sum::<f64>();
        Ok((rows, a * sum(&left) + o * sum(at) + b * sum(&right)))
    }
}

/// Slopes from the residuals at all neighbours, in the order of the stencils' points.
pub(crate) fn slopes(
    merit: &Merit<'_>,
    (point, at): (&[f64], &Valued),
    stencils: &[Stencil],
    found: &[Result<Residuals, ModelError>],
) -> Result<Slopes, ModelError> {
    let mut slopes = Slopes {
        columns: Vec::new(),
        ln_sigma: Vec::new(),
    };
    let data = merit.problem.residual_count();
    for (stencil, found) in stencils.iter().zip(found.chunks(2)) {
        let points = stencil.points(point);
        let neighbours = [0, 1].map(|side| merit.value(&points[side], &found[side]));
        let (mut column, width) = stencil.slope(at, &neighbours)?;
        column.truncate(data);
        column.extend(prior_slopes(merit.problem.parameters(), point, stencil));
        slopes.columns.push(column);
        slopes.ln_sigma.push(width);
    }
    Ok(slopes)
}

/// Derivatives of all priors' residuals by one parameter.
fn prior_slopes<'a>(
    parameters: &'a [Parameter],
    point: &'a [f64],
    stencil: &'a Stencil,
) -> impl Iterator<Item = f64> + 'a {
    let slope = move |(k, parameter): (usize, &Parameter)| {
        let own = f64::from(u8::from(k == stencil.parameter));
        match parameter.prior {
            Prior::Flat => None,
            Prior::Normal { sd, .. } => Some(own / sd),
            Prior::LogNormal { ln_sd, .. } => Some(own / (point[k] * ln_sd)),
        }
    };
    parameters.iter().enumerate().filter_map(slope)
}
