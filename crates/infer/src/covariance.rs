//! Uncertainty from the curvature at the optimum.

use crate::least_squares::{EXTRAPOLATED, ROUNDING};
use crate::linear::{combine, dot, norm, svd};
use crate::{Fit, Loss, Parameter};

/// Covariance of the parameters at the optimum, (JᵀJ)⁻¹ with the priors' rows in
/// J: right where residuals are linear in the parameters over a few standard
/// errors.
///
/// Parameters held by a bound are left out, as if they were known.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance {
    /// Row by row, in the parameters' units; from the resolved directions alone.
    pub matrix: Vec<Vec<f64>>,
    /// Standard errors: 0 for a parameter held by a bound, infinite for one that
    /// enters a direction which the data do not resolve.
    pub sd: Vec<f64>,
    /// Parameters held by a bound.
    pub held: Vec<usize>,
    /// Directions in which the Jacobian is zero as far as its own error tells.
    pub unresolved: Vec<Vec<f64>>,
    /// What a robust loss multiplies the covariance by: mean ψ²/(mean ψ′)²
    /// [Huber1964]; 1 for least squares.
    pub loss_factor: f64,
    /// Resolved directions, each as long as its standard error: the matrix is
    /// the sum of their dyads.
    axes: Vec<Vec<f64>>,
}

/// Component of an unresolved direction, of unit columns, that leaves a parameter undetermined.
const TAKES_PART: f64 = 1e-4;

impl Covariance {
    /// From a fit.
    #[must_use]
    pub fn new(parameters: &[Parameter], fit: &Fit) -> Self {
        let count = parameters.len();
        let (held, loose): (Vec<usize>, Vec<usize>) = (0..count).partition(|k| fit.is_bound(*k));
        let columns = &fit.jacobian.columns;
        let lengths: Vec<f64> = loose.iter().map(|k| norm(&columns[*k])).collect();
        let unit: Vec<Vec<f64>> = (loose.iter().zip(&lengths))
            .map(|(k, length)| columns[*k].iter().map(|x| x / length).collect())
            .collect();
        let found = svd(&unit);
        let least = ROUNDING.max(EXTRAPOLATED * fit.jacobian.worst_disagreement());
        let factor = loss_factor(fit.loss, &fit.residuals);
        // Directions of unit columns in the parameters' own units.
        let own = |direction: &[f64], size: f64| {
            let mut all = vec![0.0; count];
            for ((k, length), x) in loose.iter().zip(&lengths).zip(direction) {
                all[*k] = size * x / length;
            }
            all
        };
        let directions = || found.values.iter().zip(&found.right);
        let axes = directions().filter(|(value, _)| **value > least);
        let axes = axes
            .map(|(value, v)| own(v, factor.sqrt() / value))
            .collect();
        let flat = directions().filter(|(value, _)| **value <= least);
        let unresolved: Vec<Vec<f64>> = flat.map(|(_, v)| own(v, 1.0)).collect();
        let share = |direction: &[f64], k: usize| (direction[k] * norm(&columns[k])).abs();
        let open = |k: usize| unresolved.iter().any(|d| share(d, k) > TAKES_PART);
        let mut covariance = Self::of_axes(axes, count);
        (0..count)
            .filter(|k| open(*k))
            .for_each(|k| covariance.sd[k] = f64::INFINITY);
        Self {
            held,
            unresolved,
            loss_factor: factor,
            ..covariance
        }
    }

    fn of_axes(axes: Vec<Vec<f64>>, count: usize) -> Self {
        let entry = |i: usize, j: usize| axes.iter().map(|a| a[i] * a[j]).sum::<f64>();
        let matrix: Vec<Vec<f64>> = (0..count)
            .map(|i| (0..count).map(|j| entry(i, j)).collect())
            .collect();
        Self {
            sd: (0..count).map(|k| matrix[k][k].sqrt()).collect(),
            matrix,
            held: Vec::new(),
            unresolved: Vec::new(),
            loss_factor: 1.0,
            axes,
        }
    }

    /// Correlation of two parameters; `None` where either has no finite, positive standard error.
    #[must_use]
    pub fn correlation(&self, i: usize, j: usize) -> Option<f64> {
        let product = self.sd.get(i)? * self.sd.get(j)?;
        let sound = product > 0.0 && product.is_finite();
        sound.then(|| self.matrix[i][j] / product)
    }

    /// Standard error of a quantity whose derivatives by the parameters are given.
    #[must_use]
    pub fn sd_of(&self, derivatives: &[f64]) -> f64 {
        let parts = self.axes.iter().map(|axis| dot(axis, derivatives).powi(2));
        parts.sum::<f64>().sqrt()
    }

    /// A displacement from the optimum for one standard normal number for each
    /// resolved direction.
    pub(crate) fn displacement(&self, mut normal: impl FnMut() -> f64) -> Vec<f64> {
        let weights: Vec<f64> = self.axes.iter().map(|_| normal()).collect();
        let mut displacement = combine(&self.axes, &weights);
        // Without any axis there is none.
        displacement.resize(self.matrix.len(), 0.0);
        displacement
    }
}

fn loss_factor(loss: Loss, residuals: &[f64]) -> f64 {
    if loss == Loss::Squares || residuals.is_empty() {
        return 1.0;
    }
    let n = residuals.len() as f64;
    let influences = || residuals.iter().map(|r| loss.influence(*r));
    let square = influences().map(|(psi, _)| psi * psi).sum::<f64>() / n;
    let slope = influences().map(|(_, slope)| slope).sum::<f64>() / n;
    square / (slope * slope)
}
