//! What a robust loss makes of the covariance.
//!
//! With ψ the slope of a residual's cost, m = mean ψ′ over n data and A = JᵀJ of the data
//! alone, P of the priors, the optimum moves by H⁻¹ Jᵀψ with H = m A + P, so that its
//! covariance is H⁻¹ (f m² A + P) H⁻¹ with
//!
//! f = K² · Σ ψ²/(n − p) / m²,  K = 1 + (p/n) · (mean ψ′² − m²)/m²
//!
//! [Huber1981]. Without priors it is f A⁻¹. A prior is a measurement with an
//! error of its own, which outliers among the data do not change.

use crate::linear::dot;
use crate::{Fit, Loss};

/// Fewer degrees of freedom say nothing of how residuals scatter. They are counted by a sum
/// that rounds, so that none may come out as 1e-15.
const LEAST_FREEDOM: f64 = 0.5;

/// Least mean ψ′ as a share of the mean weight ψ/r: where most residuals are far out, a loss
/// that bends downwards has none.
const LEAST_CURVATURE: f64 = 0.1;

/// Mean slope of the influence of the data's residuals; 1 for least squares.
pub(crate) fn curvature(fit: &Fit) -> f64 {
    let count = fit.residuals.len();
    if fit.loss == Loss::Squares || count == 0 {
        return 1.0;
    }
    let each = fit.residuals.iter().map(|r| {
        let (influence, slope) = fit.loss.influence(*r);
        (slope, if *r == 0.0 { 1.0 } else { influence / r })
    });
    let (slopes, weights) = each.fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
    slopes.max(LEAST_CURVATURE * weights) / count as f64
}

/// The factor f, from the left singular vectors of the resolved directions.
///
/// It is 1 where no residual is beyond the loss's scale, as there is nothing then to be robust
/// against, and where no freedom is left; never less, as the data's σ are stated and a lucky
/// draw does not make them smaller.
pub(crate) fn factor(fit: &Fit, left: &[Vec<f64>]) -> f64 {
    if fit.beyond_loss() == 0 {
        return 1.0;
    }
    let count = fit.residuals.len() as f64;
    // What the data determine: directions that priors determine cost no freedom.
    let data = fit.jacobian.data_rows;
    let known: f64 = left.iter().map(|u| dot(&u[..data], &u[..data])).sum();
    if count - known < LEAST_FREEDOM {
        return 1.0;
    }
    let influences: Vec<(f64, f64)> = (fit.residuals.iter())
        .map(|r| fit.loss.influence(*r))
        .collect();
    let squares: f64 = influences.iter().map(|(psi, _)| psi * psi).sum();
    let slopes: f64 = influences.iter().map(|(_, slope)| slope * slope).sum();
    let mean = curvature(fit);
    let spread = (slopes / count / (mean * mean) - 1.0).max(0.0);
    let correction = 1.0 + known / count * spread;
    let factor = correction * correction * squares / (count - known) / (mean * mean);
    factor.max(1.0)
}
