//! Uncertainty from the curvature at the optimum.

use crate::least_squares::{EXTRAPOLATED, ROUNDING};
use crate::linear::{combine, dot, norm, square, svd};
use crate::{Fit, Loss, Parameter};

/// Covariance of the parameters at the optimum, (JᵀJ)⁻¹ with the priors' rows in J: right where
/// residuals are linear in the parameters over a few standard errors.
///
/// Parameters held by a bound are left out, as if they were known. With a robust loss, ψ the slope
/// of a residual's cost, m = mean ψ′ over n data, A = JᵀJ of the data alone and P of the priors, it
/// is H⁻¹ (f m² A + P) H⁻¹ with H = m A + P and
///
/// f = K² · Σ ψ²/(n − p) / m²,  K = 1 + (p/n) · (mean ψ′² − m²)/m²
///
/// [Huber1981]. Without priors it is f A⁻¹. A prior is a measurement with an error of its own, which
/// outliers among the data do not change.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance {
    /// Row by row, in the parameters' units; from the resolved directions alone.
    pub matrix: Vec<Vec<f64>>,
    /// Standard errors: 0 for a parameter held by a bound, infinite for one that enters an
    /// unresolved direction.
    pub sd: Vec<f64>,
    /// Parameters held by a bound.
    pub held: Vec<usize>,
    /// Directions in which the Jacobian is zero within its own error.
    pub unresolved: Vec<Vec<f64>>,
    /// The factor f of a robust loss; 1 for least squares.
    pub loss_factor: f64,
    /// Resolved directions, each as long as its standard error: the matrix sums their dyads.
    pub(crate) axes: Vec<Vec<f64>>,
}

/// Component of an unresolved direction, of unit columns, that leaves a parameter undetermined.
const TAKES_PART: f64 = 1e-4;

impl Covariance {
    /// From a fit.
    pub fn new(parameters: &[Parameter], fit: &Fit) -> Self {
        let count = parameters.len();
        let (held, loose): (Vec<usize>, Vec<usize>) = (0..count).partition(|k| fit.is_bound(*k));
        let curvature = curvature(fit);
        let data = fit.jacobian.data_rows;
        let columns = data_times(curvature.sqrt(), &fit.jacobian.columns, data);
        let lengths: Vec<f64> = loose.iter().map(|k| norm(&columns[*k])).collect();
        let pairs = loose.iter().zip(&lengths);
        let unit = pairs.map(|(k, length)| columns[*k].iter().map(|x| x / length).collect());
        let found = svd(&unit.collect::<Vec<_>>());
        let least = ROUNDING.max(EXTRAPOLATED * fit.jacobian.worst_disagreement());
        let resolved = found.values.iter().take_while(|v| **v > least).count();
        let left = &found.left[..resolved];
        let loss_factor = loss_factor(fit, left);
        // Directions of unit columns in the parameters' own units.
        let own = |direction: &[f64], size: f64| {
            let mut all = vec![0.0; count];
            for ((k, length), x) in loose.iter().zip(&lengths).zip(direction) {
                all[*k] = size * x / length;
            }
            all
        };
        let directions = || found.values.iter().zip(&found.right);
        let axis = |shares: &Vec<f64>| {
            let pairs = shares.iter().zip(&found.values);
            let sizes: Vec<f64> = pairs.map(|(share, value)| share / value).collect();
            own(&combine(&found.right[..resolved], &sizes), 1.0)
        };
        let axes: Vec<Vec<f64>> = match fit.loss {
            Loss::Squares => {
                directions().take(resolved).map(|(value, v)| own(v, value.recip())).collect()
            }
            _ => scatter(left, data, loss_factor * curvature).iter().map(axis).collect(),
        };
        let flat = directions().filter(|(value, _)| **value <= least);
        let unresolved: Vec<Vec<f64>> = flat.map(|(_, v)| own(v, 1.0)).collect();
        let matrix = square(count, |i, j| axes.iter().map(|a| a[i] * a[j]).sum());
        let open =
            |k: usize| unresolved.iter().any(|d| (d[k] * norm(&columns[k])).abs() > TAKES_PART);
        let sd = |k: usize| {
            if open(k) { f64::INFINITY } else { matrix[k][k].sqrt() }
        };
        Self { sd: (0..count).map(sd).collect(), matrix, held, unresolved, loss_factor, axes }
    }

    /// Correlation of two parameters; `None` where either has no finite, positive standard error.
    pub fn correlation(&self, i: usize, j: usize) -> Option<f64> {
        let product = self.sd.get(i)? * self.sd.get(j)?;
        (product > 0.0 && product.is_finite()).then(|| self.matrix[i][j] / product)
    }

    /// Standard error of a quantity whose derivatives by the parameters are given.
    pub fn sd_of(&self, derivatives: &[f64]) -> f64 {
        let parts = self.axes.iter().map(|axis| dot(axis, derivatives).powi(2));
        parts.sum::<f64>().sqrt()
    }

    /// A displacement from the optimum for one standard normal number a resolved direction.
    pub(crate) fn displacement(&self, mut normal: impl FnMut() -> f64) -> Vec<f64> {
        let weights: Vec<f64> = self.axes.iter().map(|_| normal()).collect();
        let mut displacement = combine(&self.axes, &weights);
        // Without any axis there is none.
        displacement.resize(self.matrix.len(), 0.0);
        displacement
    }
}

/// Columns with the data's rows, but not the priors', times a factor.
fn data_times(factor: f64, columns: &[Vec<f64>], data: usize) -> Vec<Vec<f64>> {
    let one = |column: &Vec<f64>| {
        let rows = column.iter().enumerate();
        rows.map(|(i, x)| if i < data { factor * x } else { *x }).collect()
    };
    columns.iter().map(one).collect()
}

/// Scatter of the coordinates along the left singular vectors U where data's rows have a variance
/// and priors' rows have 1: vectors whose dyads sum to Uᵀ D U.
fn scatter(left: &[Vec<f64>], data: usize, variance: f64) -> Vec<Vec<f64>> {
    let found = svd(&data_times(variance.sqrt(), left, data));
    let pairs = found.values.iter().zip(&found.right);
    pairs.map(|(value, v)| v.iter().map(|x| value * x).collect()).collect()
}

/// Fewer degrees of freedom say nothing of how residuals scatter. They are counted by a sum that
/// rounds, so that none may come out as 1e-15.
const LEAST_FREEDOM: f64 = 0.5;

/// Least mean ψ′ as a share of the mean weight ψ/r: where most residuals are far out, a loss that
/// bends downwards has none.
const LEAST_CURVATURE: f64 = 0.1;

/// m: mean slope of the influence of the data's residuals; 1 for least squares.
fn curvature(fit: &Fit) -> f64 {
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

/// f, from the left singular vectors of the resolved directions. 1 where no residual is beyond the
/// loss's scale, and where no freedom is left; never less, as the data's σ are stated and a lucky
/// draw does not make them smaller.
fn loss_factor(fit: &Fit, left: &[Vec<f64>]) -> f64 {
    let count = fit.residuals.len() as f64;
    // What the data determine: directions that priors determine cost no freedom.
    let data = fit.jacobian.data_rows;
    let known: f64 = left.iter().map(|u| dot(&u[..data], &u[..data])).sum();
    if fit.beyond_loss() == 0 || count - known < LEAST_FREEDOM {
        return 1.0;
    }
    let influences: Vec<(f64, f64)> =
        fit.residuals.iter().map(|r| fit.loss.influence(*r)).collect();
    let squares: f64 = influences.iter().map(|(psi, _)| psi * psi).sum();
    let slopes: f64 = influences.iter().map(|(_, slope)| slope * slope).sum();
    let mean = curvature(fit);
    let spread = (slopes / count / (mean * mean) - 1.0).max(0.0);
    let correction = 1.0 + known / count * spread;
    let factor = correction * correction * squares / (count - known) / (mean * mean);
    factor.max(1.0)
}
