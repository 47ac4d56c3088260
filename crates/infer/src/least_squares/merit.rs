//! What a fit minimises, and its derivatives by differences.

use crate::linear::{dot, norm};
use crate::{Fit, ModelError, Parameter, Prior, Problem, Residuals};
use serde::{Deserialize, Serialize};

/// How fast the cost of a residual r grows; `scale` is where it stops being a square, in standard
/// deviations. With z = (r/scale)² the cost is ½ scale² ρ(z).
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub enum Loss {
    /// ρ = z: least squares, the likelihood of normal errors.
    #[default]
    Squares,
    /// ρ = 2(√(1 + z) − 1): smooth, |r| for large residuals.
    SoftL1 {
        /// Where it turns.
        scale: f64,
    },
    /// ρ = z up to 1, 2√z − 1 beyond [Huber1964].
    Huber {
        /// Where it turns.
        scale: f64,
    },
    /// ρ = ln(1 + z): outliers count less the larger they are.
    Cauchy {
        /// Where it turns.
        scale: f64,
    },
}

/// ½ scale² ρ and what a step needs of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cost {
    pub value: f64,
    /// Factor on a row of the Jacobian, √(ρ′ + 2 z ρ″), kept positive.
    pub slope_factor: f64,
    /// Factor on a residual, ρ′ over that factor: the product of both rows is the gradient.
    pub residual_factor: f64,
}

/// Least curvature of a residual far out, as a share of the weight ρ′: without any, a step from
/// where all residuals are far out would have no length.
const LEAST_CURVATURE: f64 = 0.1;

impl Loss {
    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Squares => "squares",
            Self::SoftL1 { .. } => "soft L1",
            Self::Huber { .. } => "Huber",
            Self::Cauchy { .. } => "Cauchy",
        }
    }

    /// Where it turns, in standard deviations; 1 for squares, which turn nowhere.
    pub const fn scale(self) -> f64 {
        match self {
            Self::Squares => 1.0,
            Self::SoftL1 { scale } | Self::Huber { scale } | Self::Cauchy { scale } => scale,
        }
    }

    /// ρ, ρ′ and ρ″ at z.
    fn rho(self, z: f64) -> [f64; 3] {
        match self {
            Self::SoftL1 { .. } => {
                let root = (1.0 + z).sqrt();
                [2.0 * (root - 1.0), root.recip(), -0.5 * root.powi(-3)]
            }
            Self::Huber { .. } if z > 1.0 => {
                let root = z.sqrt();
                [2.0 * root - 1.0, root.recip(), -0.5 * root.powi(-3)]
            }
            Self::Cauchy { .. } => {
                let slope = (1.0 + z).recip();
                [z.ln_1p(), slope, -slope * slope]
            }
            _ => [z, 1.0, 0.0],
        }
    }

    pub(crate) fn cost(self, residual: f64) -> Cost {
        let scale = self.scale();
        let z = (residual / scale).powi(2);
        let [rho, slope, curvature] = self.rho(z);
        let bounded = (slope + 2.0 * z * curvature).max(LEAST_CURVATURE * slope);
        let slope_factor = bounded.sqrt();
        Cost {
            value: 0.5 * scale * scale * rho,
            slope_factor,
            residual_factor: slope / slope_factor,
        }
    }

    /// ψ = d cost/dr and its slope, for the uncertainty of a robust fit.
    pub(crate) fn influence(self, residual: f64) -> (f64, f64) {
        let z = (residual / self.scale()).powi(2);
        let [_, slope, curvature] = self.rho(z);
        (slope * residual, slope + 2.0 * z * curvature)
    }
}

/// ½ Σ ρ(r²) + Σ ln σ + ½ Σ (prior residual)², over all rows or some.
#[derive(Clone)]
pub(crate) struct Merit<'a> {
    pub problem: &'a dyn Problem,
    pub loss: Loss,
    /// Which rows count; empty if all do.
    included: Vec<bool>,
}

/// Residuals of data, then of priors, and their cost.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Valued {
    pub rows: Vec<f64>,
    pub ln_sigmas: Vec<f64>,
    pub cost: f64,
}

/// The problem made linear at a point: columns of the weighted Jacobian and the cost's gradient.
pub(crate) struct Linear {
    pub columns: Vec<Vec<f64>>,
    pub gradient: Vec<f64>,
}

impl<'a> Merit<'a> {
    pub(crate) fn new(problem: &'a dyn Problem, loss: Loss) -> Self {
        let included = Vec::new();
        Self { problem, loss, included }
    }

    /// The same cost over the rows that a predicate includes.
    pub(crate) fn only(&self, include: impl Fn(usize) -> bool) -> Self {
        let included = (0..self.problem.residual_count()).map(include).collect();
        Self { included, ..self.clone() }
    }

    /// Residuals and their cost, or why a point has none.
    pub(crate) fn value(
        &self,
        point: &[f64],
        found: &Result<Residuals, ModelError>,
    ) -> Result<Valued, ModelError> {
        let (mut rows, ln_sigmas) = self.checked(found.as_ref().map_err(Clone::clone)?)?;
        let data: f64 = rows.iter().map(|r| self.loss.cost(*r).value).sum();
        let width: f64 = ln_sigmas.iter().sum();
        let parameters = self.problem.parameters().iter().zip(point);
        let priors: Vec<f64> = parameters.filter_map(|(p, v)| p.prior.residual(*v)).collect();
        let cost = data + width + 0.5 * dot(&priors, &priors);
        rows.extend(priors);
        match cost.is_finite() {
            true => Ok(Valued { rows, ln_sigmas, cost }),
            false => Err(ModelError(format!("the cost is {cost} at {point:?}"))),
        }
    }

    /// Rows that count, zeros for others; the first that is no number is an error.
    fn checked(&self, found: &Residuals) -> Result<(Vec<f64>, Vec<f64>), ModelError> {
        let count = self.problem.residual_count();
        let (rows, widths) = (found.standardised.len(), found.ln_sigmas.len());
        if rows != count || (widths != 0 && widths != count) {
            return Err(ModelError(format!(
                "the model returned {rows} residuals and {widths} logarithms of σ, {count} were announced"
            )));
        }
        let bad = |values: &[f64]| values.iter().position(|value| !value.is_finite());
        if let Some(i) = bad(&found.standardised).or_else(|| bad(&found.ln_sigmas)) {
            let (label, value) = (self.problem.residual_label(i), found.standardised[i]);
            return Err(ModelError(format!(
                "{label}: the residual is {value}, or its σ is no positive number; check this row's value and uncertainty"
            )));
        }
        let included = |i: usize| self.included.get(i).copied().unwrap_or(true);
        let select = |values: &[f64]| -> Vec<f64> {
            let of = |(i, x): (usize, &f64)| if included(i) { *x } else { 0.0 };
            values.iter().enumerate().map(of).collect()
        };
        Ok((select(&found.standardised), select(&found.ln_sigmas)))
    }

    /// Weighted Jacobian and gradient from slopes at a point.
    pub(crate) fn linear(&self, at: &Valued, slopes: &Slopes) -> Linear {
        let data = self.problem.residual_count();
        let costs: Vec<_> = at.rows[..data].iter().map(|r| self.loss.cost(*r)).collect();
        let weigh = |values: &[f64], factor: fn(&Cost) -> f64| -> Vec<f64> {
            let values = values.iter().enumerate();
            values.map(|(i, x)| if i < data { x * factor(&costs[i]) } else { *x }).collect()
        };
        let rows = weigh(&at.rows, |cost| cost.residual_factor);
        let columns: Vec<Vec<f64>> =
            slopes.columns.iter().map(|column| weigh(column, |cost| cost.slope_factor)).collect();
        let pairs = columns.iter().zip(&slopes.ln_sigma);
        let gradient = pairs.map(|(column, width)| dot(column, &rows) + width).collect();
        Linear { columns, gradient }
    }
}

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
pub(crate) struct Neighbours {
    parameter: usize,
    offsets: [f64; 2],
}

impl Neighbours {
    /// At ±`step`; both on one side, at one and two steps, where a bound is in the way; nearer if
    /// the bounds leave less room.
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

    /// ∂r/∂θ and ∂(Σ ln σ)/∂θ: of the parabola through left, middle and right value, or of the line
    /// through two if one is missing.
    fn slope(
        &self,
        at: &Valued,
        [left, right]: [Result<Valued, ModelError>; 2],
    ) -> Result<(Vec<f64>, f64), ModelError> {
        let [a, b] = self.offsets;
        let [wa, wo, wb] = match (&left, &right) {
            (Ok(_), Ok(_)) => [-b / (a * (a - b)), -(a + b) / (a * b), -a / (b * (b - a))],
            (Ok(_), Err(_)) => [a.recip(), -a.recip(), 0.0],
            (Err(_), Ok(_)) => [0.0, -b.recip(), b.recip()],
            (Err(error), Err(_)) => return Err(error.clone()),
        };
        let [left, right] = [left, right].map(|valued| valued.unwrap_or_else(|_| at.clone()));
        let row = |i: usize| wa * left.rows[i] + wo * at.rows[i] + wb * right.rows[i];
        let rows = (0..at.rows.len()).map(row).collect();
        let sum = |valued: &Valued| valued.ln_sigmas.iter().sum::<f64>();
        Ok((rows, wa * sum(&left) + wo * sum(at) + wb * sum(&right)))
    }
}

/// Slopes from the residuals at all neighbours, in the order of their points.
pub(crate) fn slopes(
    merit: &Merit<'_>,
    (point, at): (&[f64], &Valued),
    neighbours: &[Neighbours],
    found: &[Result<Residuals, ModelError>],
) -> Result<Slopes, ModelError> {
    let (mut columns, mut ln_sigma) = (Vec::new(), Vec::new());
    for (pair, found) in neighbours.iter().zip(found.chunks(2)) {
        let points = pair.points(point);
        let valued = [0, 1].map(|side| merit.value(&points[side], &found[side]));
        let (mut column, width) = pair.slope(at, valued)?;
        column.truncate(merit.problem.residual_count());
        // Derivatives of the priors' residuals are known.
        for (k, parameter) in merit.problem.parameters().iter().enumerate() {
            let own = f64::from(u8::from(k == pair.parameter));
            match parameter.prior {
                Prior::Flat => {}
                Prior::Normal { sd, .. } => column.push(own / sd),
                Prior::LogNormal { ln_sd, .. } => column.push(own / (point[k] * ln_sd)),
            }
        }
        columns.push(column);
        ln_sigma.push(width);
    }
    Ok(Slopes { columns, ln_sigma })
}

/// Relative error of derivatives by rounding.
pub(crate) const ROUNDING: f64 = 1e-9;

/// Error of extrapolated derivatives as a share of the disagreement of both step sizes.
pub(crate) const EXTRAPOLATED: f64 = 0.03;

/// The same where a column may have a jump of the model, as where its solver takes another number
/// of steps. One of j within the shorter steps h makes the derivatives j/2h and j/4h, so that they
/// disagree by j/4h and the extrapolated one is wrong by 7j/12h.
pub(crate) const JUMPING: f64 = 7.0 / 3.0;

/// Derivatives of the residuals at a point, by central differences with two step sizes and
/// Richardson's extrapolation from both: of the data's residuals, then of the priors'; robust
/// losses do not enter.
#[derive(Clone, Debug, PartialEq)]
pub struct Jacobian {
    /// One column a parameter: ∂r/∂θ, in 1/(unit of θ).
    pub columns: Vec<Vec<f64>>,
    /// How many of the rows, from the first, are data.
    pub data_rows: usize,
    /// Shorter of both steps of each parameter, in its unit.
    pub steps: Vec<f64>,
    /// Difference between both step sizes' columns as a share of the column's length; the
    /// extrapolated column is usually some ten times better.
    pub disagreement: Vec<f64>,
    /// Parameters by which derivatives are one-sided because the model fails on the other side, and
    /// why it does.
    pub failing: Vec<(usize, ModelError)>,
}

impl Jacobian {
    /// The parameter on whose derivatives both step sizes agree least, and by which share they
    /// differ.
    pub fn least_agreeing(&self) -> Option<(usize, f64)> {
        let numbered = self.disagreement.iter().copied().enumerate();
        numbered.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Largest disagreement of any parameter.
    pub fn worst_disagreement(&self) -> f64 {
        self.disagreement.iter().copied().fold(0.0, f64::max)
    }
}

/// Derivatives of another problem with the same parameters where a fit ended, with its steps.
pub(crate) fn jacobian_at(problem: &dyn Problem, fit: &Fit) -> Result<Jacobian, ModelError> {
    let merit = Merit::new(problem, Loss::Squares);
    let found = problem.residuals(std::slice::from_ref(&fit.point)).remove(0);
    let at = merit.value(&fit.point, &found)?;
    let (jacobian, _) = jacobian(&merit, (&fit.point, &at), &fit.jacobian.steps, &[])?;
    Ok(jacobian)
}

/// Derivatives by steps and by doubled steps, in one call of the model; `known` are the residuals
/// at the nearer neighbours, where these have been computed.
pub(crate) fn jacobian(
    merit: &Merit<'_>,
    (point, at): (&[f64], &Valued),
    steps: &[f64],
    known: &[Result<Residuals, ModelError>],
) -> Result<(Jacobian, Slopes), ModelError> {
    let problem = merit.problem;
    let [near, far] = [1.0, 2.0].map(|factor| {
        let all = problem.parameters().iter().enumerate();
        let pair = |(k, p)| Neighbours::new(k, p, point[k], factor * steps[k]);
        all.map(pair).collect::<Vec<_>>()
    });
    let points = near.iter().chain(&far).flat_map(|pair| pair.points(point));
    let points: Vec<Vec<f64>> = points.collect();
    let mut found = known.to_vec();
    found.extend(problem.residuals(&points[known.len()..]));
    if found.len() != points.len() {
        return Err(ModelError("the model returned fewer results than points".into()));
    }
    let (first, second) = found.split_at(2 * near.len());
    let close = slopes(merit, (point, at), &near, first)?;
    let wide = slopes(merit, (point, at), &far, second)?;
    // (4 D(h) − D(2h))/3: the error of order h² cancels.
    let extrapolated = |near: &[f64], far: &[f64]| -> Vec<f64> {
        near.iter().zip(far).map(|(near, far)| near + (near - far) / 3.0).collect()
    };
    let disagreement = |near: &[f64], far: &[f64]| {
        let difference: Vec<f64> = near.iter().zip(far).map(|(a, b)| a - b).collect();
        let length = norm(near);
        if length == 0.0 { 0.0 } else { norm(&difference) / length }
    };
    let failure = |(k, pair): (usize, &[Result<_, ModelError>])| {
        Some((k, pair.iter().find_map(|side| side.as_ref().err())?.clone()))
    };
    let pairs = || close.columns.iter().zip(&wide.columns);
    let columns: Vec<Vec<f64>> = pairs().map(|(near, far)| extrapolated(near, far)).collect();
    let slopes = Slopes {
        columns: columns.clone(),
        ln_sigma: extrapolated(&close.ln_sigma, &wide.ln_sigma),
    };
    let jacobian = Jacobian {
        columns,
        data_rows: problem.residual_count(),
        steps: steps.to_vec(),
        disagreement: pairs().map(|(near, far)| disagreement(near, far)).collect(),
        failing: first.chunks(2).enumerate().filter_map(failure).collect(),
    };
    Ok((jacobian, slopes))
}

#[cfg(test)]
#[path = "tests/loss.rs"]
mod tests;
