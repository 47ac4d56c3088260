//! Uncertainty from the curvature at the optimum.

use crate::least_squares::{EXTRAPOLATED, ROUNDING};
use crate::linear::{combine, dot, norm, svd};
use crate::{Fit, Loss, Parameter, robust};

/// Covariance of the parameters at the optimum, (JᵀJ)⁻¹ with the priors' rows in
/// J: right where residuals are linear in the parameters over a few standard
/// errors. Of a robust loss see [`Covariance::loss_factor`].
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
    /// What a robust loss multiplies the data's share of the covariance by, the
    /// priors' staying as it is; 1 for least squares. See `robust.rs` for the equation.
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
        let curvature = robust::curvature(fit);
        let data = fit.jacobian.data_rows;
        let columns = data_times(curvature.sqrt(), &fit.jacobian.columns, data);
        let lengths: Vec<f64> = loose.iter().map(|k| norm(&columns[*k])).collect();
        let unit: Vec<Vec<f64>> = (loose.iter().zip(&lengths))
            .map(|(k, length)| columns[*k].iter().map(|x| x / length).collect())
            .collect();
        let found = svd(&unit);
        let least = ROUNDING.max(EXTRAPOLATED * fit.jacobian.worst_disagreement());
        let resolved = found.values.iter().take_while(|v| **v > least).count();
        let left = &found.left[..resolved];
        let factor = robust::factor(fit, left);
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
            let sizes: Vec<f64> = (shares.iter().zip(&found.values))
                .map(|(share, value)| share / value)
                .collect();
            own(&combine(&found.right[..resolved], &sizes), 1.0)
        };
        let axes = match fit.loss {
            Loss::Squares => (directions().take(resolved))
                .map(|(value, v)| own(v, value.recip()))
                .collect(),
            _ => (scatter(left, data, factor * curvature).iter())
                .map(axis)
                .collect(),
        };
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

/// Columns with the data's rows, but not the priors', times a factor.
fn data_times(factor: f64, columns: &[Vec<f64>], data: usize) -> Vec<Vec<f64>> {
    let one = |column: &Vec<f64>| {
        let rows = column.iter().enumerate();
        rows.map(|(i, x)| if i < data { factor * x } else { *x })
            .collect()
    };
    columns.iter().map(one).collect()
}

/// How the coordinates along the left singular vectors U scatter where data's rows have a
/// variance and priors' rows have 1: vectors whose dyads sum to Uᵀ D U.
fn scatter(left: &[Vec<f64>], data: usize, variance: f64) -> Vec<Vec<f64>> {
    let found = svd(&data_times(variance.sqrt(), left, data));
    let pairs = found.values.iter().zip(&found.right);
    let axis = |(value, v): (&f64, &Vec<f64>)| v.iter().map(|x| value * x).collect();
    pairs.map(axis).collect()
}
