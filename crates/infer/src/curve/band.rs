//! A fitted curve and how sure it is.

use super::model::{Predicted, Speeds};
use super::problem::MeasuredCurve;
use crate::problem::ModelError;
use crate::{Covariance, Fit};

/// The model's curve at the best fit.
#[derive(Clone, Debug, PartialEq)]
pub struct FitCurve {
    /// Predictions, one row a speed of the data.
    pub predicted: Vec<Predicted>,
    /// Their standard errors as they follow from the parameters' covariance.
    pub sd: Vec<[f64; 4]>,
}

impl MeasuredCurve {
    /// The curve at a fit's optimum with its standard errors, from central
    /// differences by the fit's own steps, all in one ensemble and ten times as
    /// accurate as the fit, so that no jump of the solver's stands out of the band.
    ///
    /// # Errors
    /// What is in the way of a shot at the optimum; where the model fails on both
    /// sides of it, standard errors are not numbers.
    pub fn fit_curve(&self, fit: &Fit, covariance: &Covariance) -> Result<FitCurve, ModelError> {
        let moved = |(at, sign): (usize, f64)| {
            let mut point = fit.point.clone();
            point[at] += sign * fit.jacobian.steps[at];
            point
        };
        let sides = (0..fit.point.len()).flat_map(|at| [(at, 1.0), (at, -1.0)]);
        let points: Vec<Vec<f64>> =
            std::iter::once(fit.point.clone()).chain(sides.map(moved)).collect();
        let speeds = Speeds::of_rows(&self.data.speeds_m_s());
        let predicted = self.model.curve(&self.own(&fit.point), &speeds)?;
        let mut finer = self.clone();
        finer.model = finer.model.for_slopes();
        let found = finer.predicted_at(&points, &speeds).into_iter();
        let found: Vec<_> = found.map(Result::ok).collect();
        let slope = |parameter: usize, row: usize, of: usize| {
            let at = |point: usize| found.get(point)?.as_ref()?.get(row)?[of];
            let (here, step) = (at(0), fit.jacobian.steps[parameter]);
            match (at(2 * parameter + 1), at(2 * parameter + 2)) {
                (Some(above), Some(below)) => Some((above - below) / (2.0 * step)),
                // At a bound of the model there is one side.
                (Some(above), None) => Some((above - here?) / step),
                (None, Some(below)) => Some((here? - below) / step),
                (None, None) => None,
            }
        };
        let sd = |row: usize, of: usize| {
            let slope = |k: usize| match covariance.held.contains(&k) {
                true => 0.0,
                false => slope(k, row, of).unwrap_or(f64::NAN),
            };
            let slopes = (0..fit.point.len()).map(slope);
            covariance.sd_of(&slopes.collect::<Vec<f64>>())
        };
        let sd = (0..predicted.len()).map(|row| [0, 1, 2, 3].map(|of| sd(row, of)));
        Ok(FitCurve { sd: sd.collect(), predicted })
    }
}
