//! A fitted curve and how sure it is.

use super::model::Predicted;
use super::problem::CurveProblem;
use crate::problem::ModelError;
use crate::{Covariance, Fit};

/// The model's curve at the best fit.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedCurve {
    /// Predictions, one row a speed of the data.
    pub predicted: Vec<Predicted>,
    /// Their standard errors as they follow from the parameters' covariance.
    pub sd: Vec<[f64; 4]>,
}

impl CurveProblem {
    /// The curve at a fit's optimum with its standard errors, from central
    /// differences by the fit's own steps, all in one ensemble.
    ///
    /// # Errors
    /// What is in the way of a shot at the optimum; where the model fails beside
    /// it, standard errors are not numbers.
    pub fn fitted_curve(
        &self,
        fit: &Fit,
        covariance: &Covariance,
    ) -> Result<FittedCurve, ModelError> {
        let moved = |(at, sign): (usize, f64)| {
            let mut point = fit.point.clone();
            point[at] += sign * fit.jacobian.steps[at];
            point
        };
        let sides = (0..fit.point.len()).flat_map(|at| [(at, 1.0), (at, -1.0)]);
        let points: Vec<Vec<f64>> = std::iter::once(fit.point.clone())
            .chain(sides.map(moved))
            .collect();
        let mut curves = self.curves(&points).into_iter();
        let predicted = curves
            .next()
            .unwrap_or_else(|| Err(ModelError("no curve was computed".into())))?;
        let beside: Vec<_> = curves.map(Result::ok).collect();
        let slope = |parameter: usize, row: usize, of: usize| {
            let side = |at: usize| beside.get(at)?.as_ref()?.get(row)?[of];
            let difference = side(2 * parameter)? - side(2 * parameter + 1)?;
            Some(difference / (2.0 * fit.jacobian.steps[parameter]))
        };
        let sd = |row: usize, of: usize| {
            let slopes = (0..fit.point.len()).map(|k| slope(k, row, of).unwrap_or(f64::NAN));
            covariance.sd_of(&slopes.collect::<Vec<f64>>())
        };
        let sd = (0..predicted.len()).map(|row| [0, 1, 2, 3].map(|of| sd(row, of)));
        Ok(FittedCurve {
            sd: sd.collect(),
            predicted,
        })
    }
}
