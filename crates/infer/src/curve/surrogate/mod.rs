//! Curves by polynomials through curves computed before.
//!
//! A posterior needs a million curves that differ little. Near the best fit the
//! logarithm of every time of flight is a smooth function of the parameters, which a
//! polynomial gives to a small part of a standard error: of few parameters through
//! curves at the nodes of a grid, of many by least squares on curves at random. How
//! small is measured, at points between.

mod ball;
mod grid;
mod polynomial;

use super::model::Predicted;
use super::problem::{CurveError, CurveProblem};
use crate::data::Data;
use crate::problem::{ModelError, Problem, Residuals};
use crate::{Covariance, Fit, Parameter};
use grid::Grid;
use hertzchain_study::count_done;
use polynomial::Polynomial;
use rayon::prelude::*;

/// Half the width of what a surrogate covers in standard errors, unless another
/// is asked for.
const REACH: f64 = 6.0;

/// Accuracy of its curves over the problem's own: a polynomial through many nodes
/// multiplies their errors.
const FINER: f64 = 0.1;

/// Why there is no surrogate; the model itself still does.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurrogateError {
    /// Too many terms.
    #[error("{0} parameters are too many to interpolate curves, which is done for up to {most}", most = Surrogate::MOST_PARAMETERS)]
    TooMany(usize),
    /// A parameter without a width.
    #[error("{name} has no finite standard error: there is no room to interpolate in")]
    NoWidth {
        /// The parameter.
        name: String,
    },
    /// Parameters whose errors are one and the same, or bounds that exclude almost
    /// everything.
    #[error("errors of the parameters and their bounds leave no room to interpolate in")]
    NoRoom,
    /// A curve that does not exist.
    #[error("the model fails near the best fit: {0}")]
    ModelFails(ModelError),
}

/// A problem whose curves are interpolated near a fit and computed elsewhere.
#[derive(Clone, Debug)]
pub struct Surrogate {
    problem: CurveProblem,
    form: Form,
    /// Largest difference of any residual from the model's own, in standard
    /// errors, at points spread over what is covered.
    pub error: f64,
}

/// What curves are made of.
#[derive(Clone, Debug)]
enum Form {
    Grid(Grid),
    Polynomial(Polynomial),
}

impl Form {
    /// The curve where it is covered.
    fn curve(&self, point: &[f64]) -> Option<Vec<Predicted>> {
        match self {
            Self::Grid(grid) => grid.curve(point),
            Self::Polynomial(polynomial) => polynomial.curve(point),
        }
    }
}

impl Surrogate {
    /// Parameters that it bears: polynomials of the third degree in more have
    /// thousands of terms.
    pub const MOST_PARAMETERS: usize = polynomial::MOST_PARAMETERS;

    /// Largest error of a surrogate that may stand for the model, in standard errors.
    pub const ALLOWED: f64 = 0.1;

    /// Around a fit, six standard errors to either side. Up to four parameters have a
    /// grid; more, or those for which a grid is too coarse, a polynomial of least
    /// squares.
    ///
    /// # Errors
    /// See [`SurrogateError`].
    pub fn new(
        problem: &CurveProblem,
        fit: &Fit,
        covariance: &Covariance,
    ) -> Result<Self, SurrogateError> {
        let few = fit.point.len() <= grid::MOST_PARAMETERS;
        let gridded = few.then(|| Self::within(REACH, problem, fit, covariance));
        match gridded {
            Some(Ok(surrogate)) if surrogate.error <= Self::ALLOWED => Ok(surrogate),
            _ => Self::by_least_squares(problem, fit, covariance),
        }
    }

    /// Around a fit, so many standard errors to either side, on a grid: for repetitions
    /// whose best fits scatter about this one.
    ///
    /// # Errors
    /// See [`SurrogateError`].
    pub fn within(
        reach: f64,
        problem: &CurveProblem,
        fit: &Fit,
        covariance: &Covariance,
    ) -> Result<Self, SurrogateError> {
        let finer = finer(problem);
        let grid = Grid::within(reach, &finer, fit, covariance)?;
        let trials = grid.trials();
        let form = Form::Grid(grid);
        let exact = finer.all_curves(&trials);
        let error = worst(&finer, &form, &trials, exact)?;
        Ok(Self {
            problem: finer,
            form,
            error,
        })
    }

    /// Around a fit, as many standard errors in every direction of the covariance, by
    /// polynomials of rising degree until one is right.
    ///
    /// # Errors
    /// See [`SurrogateError`].
    pub fn by_least_squares(
        problem: &CurveProblem,
        fit: &Fit,
        covariance: &Covariance,
    ) -> Result<Self, SurrogateError> {
        let finer = finer(problem);
        let mut study = polynomial::Study::new(REACH, &finer, fit, covariance)?;
        let mut best: Option<Self> = None;
        while let Some(polynomial) = study.next(&finer)? {
            let form = Form::Polynomial(polynomial);
            let (trials, exact) = study.trials();
            let error = worst(&finer, &form, trials, exact.to_vec())?;
            if best.as_ref().is_none_or(|best| error < best.error) {
                let problem = finer.clone();
                best = Some(Self {
                    problem,
                    form,
                    error,
                });
            }
            // Half of what is allowed: trials are few in so much room.
            if error <= 0.5 * Self::ALLOWED {
                break;
            }
        }
        best.ok_or(SurrogateError::TooMany(fit.point.len()))
    }

    /// The same curves against other measured values at the same speeds.
    ///
    /// # Errors
    /// See [`CurveError`].
    pub fn with_data(&self, data: Data) -> Result<Self, CurveError> {
        Ok(Self {
            problem: self.problem.with_data(data)?,
            ..self.clone()
        })
    }
}

fn finer(problem: &CurveProblem) -> CurveProblem {
    let accuracy = FINER * problem.model().accuracy;
    problem.clone().with_accuracy(accuracy)
}

/// The middle of a parameter's range and half its width, so many standard errors
/// to either side within bounds.
fn side(
    parameter: &Parameter,
    value: f64,
    reach: f64,
    sd: f64,
) -> Result<(f64, f64), SurrogateError> {
    if !(sd > 0.0 && sd.is_finite()) {
        let name = parameter.name.clone();
        return Err(SurrogateError::NoWidth { name });
    }
    let lower = (value - reach * sd).max(parameter.lower);
    let upper = (value + reach * sd).min(parameter.upper);
    Ok((0.5 * (lower + upper), 0.5 * (upper - lower)))
}

/// Largest difference of residuals from the model's own.
fn worst(
    problem: &CurveProblem,
    form: &Form,
    points: &[Vec<f64>],
    exact: Vec<Result<Vec<Predicted>, ModelError>>,
) -> Result<f64, SurrogateError> {
    let residuals = |curve: &[Predicted]| {
        let found = problem.residuals_of(curve);
        found.map_err(SurrogateError::ModelFails)
    };
    let mut worst: f64 = 0.0;
    for (point, exact) in points.iter().zip(exact) {
        let exact = residuals(&exact.map_err(SurrogateError::ModelFails)?)?;
        let own = form.curve(point).ok_or(SurrogateError::NoRoom)?;
        let own = residuals(&own)?;
        let pairs = own.standardised.iter().zip(&exact.standardised);
        worst = pairs.map(|(a, b)| (a - b).abs()).fold(worst, f64::max);
    }
    Ok(worst)
}

impl Problem for Surrogate {
    fn parameters(&self) -> &[Parameter] {
        self.problem.parameters()
    }

    fn residual_count(&self) -> usize {
        self.problem.residual_count()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>> {
        let inside = |point: &Vec<f64>| {
            let curve = self.form.curve(point)?;
            Some(self.problem.residuals_of(&curve))
        };
        let inside: Vec<_> = points.par_iter().map(inside).collect();
        // Side by side, as they are dear.
        let beyond = points.iter().zip(&inside).filter(|(_, own)| own.is_none());
        let beyond: Vec<Vec<f64>> = beyond.map(|(point, _)| point.clone()).collect();
        // Those that are computed count themselves.
        count_done(points.len() - beyond.len());
        let mut computed = self.problem.residuals(&beyond).into_iter();
        let none = || Err(ModelError("no residuals were computed".into()));
        let all = inside.into_iter();
        all.map(|own| own.unwrap_or_else(|| computed.next().unwrap_or_else(none)))
            .collect()
    }

    fn residual_label(&self, index: usize) -> String {
        self.problem.residual_label(index)
    }
}
