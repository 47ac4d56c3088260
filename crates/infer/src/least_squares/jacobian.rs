//! Derivatives at the optimum, checked.

use super::fit::Fit;
use super::loss::Loss;
use super::merit::{Merit, Valued};
use super::slopes::{Slopes, Stencil, slopes};
use crate::linear::norm;
use crate::{ModelError, Problem, Residuals};

/// Relative error of derivatives by rounding: the least singular value, of unit
/// columns, that double precision resolves.
pub(crate) const ROUNDING: f64 = 1e-9;

/// Share of the disagreement between two step sizes that the extrapolated
/// derivatives are taken to be wrong by.
pub(crate) const EXTRAPOLATED: f64 = 0.03;

/// The same where a column may have a jump of the model, as where its solver takes another
/// number of steps. One of j within the shorter steps h makes the derivatives j/2h and j/4h, so
/// that they disagree by j/4h and the extrapolated one is wrong by 7j/12h.
pub(crate) const JUMPING: f64 = 7.0 / 3.0;

/// Derivatives of the residuals at a point, by central differences with two
/// step sizes and Richardson's extrapolation from both.
///
/// Rows are the data's residuals and then those of the priors; robust losses do
/// not enter.
#[derive(Clone, Debug, PartialEq)]
pub struct Jacobian {
    /// One column a parameter: ∂r/∂θ, in 1/(unit of θ).
    pub columns: Vec<Vec<f64>>,
    /// How many of the rows, from the first, are data.
    pub data_rows: usize,
    /// Shorter of both steps of each parameter, in its unit.
    pub steps: Vec<f64>,
    /// Difference between both step sizes' columns as a share of the column's
    /// length. A smooth model makes it small; the extrapolated column is
    /// usually some ten times better.
    pub disagreement: Vec<f64>,
}

impl Jacobian {
    /// The parameter on whose derivatives both step sizes agree least, and by which share
    /// they differ.
    #[must_use]
    pub fn least_agreeing(&self) -> Option<(usize, f64)> {
        let numbered = self.disagreement.iter().copied().enumerate();
        numbered.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Largest disagreement of any parameter.
    #[must_use]
    pub fn worst_disagreement(&self) -> f64 {
        self.disagreement.iter().copied().fold(0.0, f64::max)
    }
}

/// Derivatives of another problem with the same parameters where a fit ended, with its steps.
pub(crate) fn jacobian_at(problem: &dyn Problem, fit: &Fit) -> Result<Jacobian, ModelError> {
    let merit = Merit::new(problem, Loss::Squares);
    let found = problem
        .residuals(std::slice::from_ref(&fit.point))
        .remove(0);
    let at = merit.value(&fit.point, &found)?;
    let here = (fit.point.as_slice(), &at);
    let (jacobian, _) = jacobian(&merit, here, &fit.jacobian.steps, &[])?;
    Ok(jacobian)
}

/// Derivatives by steps and by doubled steps, in one call of the model; `known` are the
/// residuals at the nearer neighbours, where these have been computed.
pub(crate) fn jacobian(
    merit: &Merit<'_>,
    (point, at): (&[f64], &Valued),
    steps: &[f64],
    known: &[Result<Residuals, ModelError>],
) -> Result<(Jacobian, Slopes), ModelError> {
    let problem: &dyn Problem = merit.problem;
    let stencils = |factor: f64| -> Vec<Stencil> {
        let all = problem.parameters().iter().enumerate();
        all.map(|(k, p)| Stencil::new(k, p, point[k], factor * steps[k]))
            .collect()
    };
    let [near, far] = [stencils(1.0), stencils(2.0)];
    let points: Vec<Vec<f64>> = (near.iter().chain(&far))
        .flat_map(|stencil| stencil.points(point))
        .collect();
    let mut found = known.to_vec();
    found.extend(problem.residuals(&points[known.len()..]));
    if found.len() != points.len() {
        return Err(ModelError(
            "the model returned fewer results than points".into(),
        ));
    }
    let (first, second) = found.split_at(2 * near.len());
    let close = slopes(merit, (point, at), &near, first)?;
    let wide = slopes(merit, (point, at), &far, second)?;
    let pairs = || close.columns.iter().zip(&wide.columns);
    let jacobian = Jacobian {
        columns: pairs().map(|(near, far)| extrapolated(near, far)).collect(),
        data_rows: problem.residual_count(),
        steps: steps.to_vec(),
        disagreement: pairs().map(|(near, far)| disagreement(near, far)).collect(),
    };
    let slopes = Slopes {
        columns: jacobian.columns.clone(),
        ln_sigma: extrapolated(&close.ln_sigma, &wide.ln_sigma),
    };
    Ok((jacobian, slopes))
}

/// (4 D(h) − D(2h))/3: the error of order h² cancels.
fn extrapolated(near: &[f64], far: &[f64]) -> Vec<f64> {
    let pairs = near.iter().zip(far);
    pairs.map(|(near, far)| near + (near - far) / 3.0).collect()
}

fn disagreement(near: &[f64], far: &[f64]) -> f64 {
    let difference: Vec<f64> = near.iter().zip(far).map(|(a, b)| a - b).collect();
    match norm(near) {
        0.0 => 0.0,
        length => norm(&difference) / length,
    }
}
