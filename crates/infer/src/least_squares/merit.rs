//! What a fit minimises.

use super::{Loss, Slopes};
use crate::linear::dot;
use crate::{ModelError, Problem, Residuals};

/// ½ Σ ρ(r²) + Σ ln σ + ½ Σ (prior residual)², over all rows or some.
#[derive(Clone)]
pub(crate) struct Merit<'a> {
    pub problem: &'a dyn Problem,
    pub loss: Loss,
    /// Which rows count; empty if all do.
    pub kept: Vec<bool>,
}

/// Residuals of data, then of priors, and what they cost together.
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
        Self {
            problem,
            loss,
            kept: Vec::new(),
        }
    }

    /// The same cost over the rows that a predicate keeps.
    pub(crate) fn only(&self, keep: impl Fn(usize) -> bool) -> Self {
        let kept = (0..self.problem.residual_count()).map(keep).collect();
        Self {
            kept,
            ..self.clone()
        }
    }

    fn keeps(&self, row: usize) -> bool {
        self.kept.get(row).copied().unwrap_or(true)
    }

    /// Residuals and their cost, or why a point has none.
    pub(crate) fn value(
        &self,
        point: &[f64],
        found: &Result<Residuals, ModelError>,
    ) -> Result<Valued, ModelError> {
        let (mut rows, ln_sigmas) = self.sound(found.as_ref().map_err(Clone::clone)?)?;
        let data: f64 = rows.iter().map(|r| self.loss.cost(*r).value).sum();
        let width: f64 = ln_sigmas.iter().sum();
        let priors = self.prior_rows(point);
        let cost = data + width + 0.5 * dot(&priors, &priors);
        rows.extend(priors);
        if !cost.is_finite() {
            return Err(ModelError(format!("the cost is {cost} at {point:?}")));
        }
        Ok(Valued {
            rows,
            ln_sigmas,
            cost,
        })
    }

    /// Rows that count, zeros for others; the first that is no number is named.
    fn sound(&self, found: &Residuals) -> Result<(Vec<f64>, Vec<f64>), ModelError> {
        let count = self.problem.residual_count();
        let (rows, widths) = (found.standardised.len(), found.ln_sigmas.len());
        if rows != count || (widths != 0 && widths != count) {
            return Err(ModelError(format!(
                "the model returned {rows} residuals and {widths} logarithms of σ, {count} were announced"
            )));
        }
        let bad = |values: &[f64]| (0..values.len()).find(|i| !values[*i].is_finite());
        if let Some(i) = bad(&found.standardised).or_else(|| bad(&found.ln_sigmas)) {
            let (label, value) = (self.problem.residual_label(i), found.standardised[i]);
            return Err(ModelError(format!(
                "{label}: the residual is {value}, or its σ is no positive number; check this row's value and uncertainty"
            )));
        }
        let keep = |values: &[f64]| -> Vec<f64> {
            let kept = |(i, x): (usize, &f64)| if self.keeps(i) { *x } else { 0.0 };
            values.iter().enumerate().map(kept).collect()
        };
        Ok((keep(&found.standardised), keep(&found.ln_sigmas)))
    }

    fn prior_rows(&self, point: &[f64]) -> Vec<f64> {
        let parameters = self.problem.parameters().iter().zip(point);
        parameters
            .filter_map(|(parameter, value)| parameter.prior.residual(*value))
            .collect()
    }

    /// Weighted Jacobian and gradient from slopes at a point.
    pub(crate) fn linear(&self, at: &Valued, slopes: &Slopes) -> Linear {
        let data = self.problem.residual_count();
        let costs: Vec<_> = at.rows[..data].iter().map(|r| self.loss.cost(*r)).collect();
        let weigh = |values: &[f64], factor: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let weighed = |(i, x): (usize, &f64)| if i < data { x * factor(i) } else { *x };
            values.iter().enumerate().map(weighed).collect()
        };
        let rows = weigh(&at.rows, &|i| costs[i].residual_factor);
        let columns: Vec<Vec<f64>> = (slopes.columns.iter())
            .map(|column| weigh(column, &|i| costs[i].slope_factor))
            .collect();
        let gradient = (columns.iter().zip(&slopes.ln_sigma))
            .map(|(column, width)| dot(column, &rows) + width)
            .collect();
        Linear { columns, gradient }
    }
}
