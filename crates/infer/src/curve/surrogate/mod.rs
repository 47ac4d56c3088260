//! Curves by polynomials through curves computed before.
//!
//! A posterior needs a million curves that differ little. Near the best fit the logarithm of every
//! time of flight is a smooth function of the parameters, which a polynomial gives to a small part
//! of a standard error: of few parameters through curves at the nodes of a grid, of many by least
//! squares on curves at random. How small is measured, at points between.

mod ball;
mod grid;
mod polynomial;

use super::joint::CurveProblem;
use super::model::Predicted;
use crate::data::Data;
use crate::problem::{ModelError, Problem, Residuals};
use crate::{Covariance, Fit, InferError, Parameter};
use grid::Grid;
use hertzchain_sim::count_done;
use polynomial::Polynomial;
use rayon::prelude::*;

/// Half the usual width of what a surrogate covers in standard errors.
const REACH: f64 = 6.0;

/// Accuracy of its curves over the problem's: polynomials multiply their errors.
const FINER: f64 = 0.1;

/// Error in standard errors at which no better polynomial is looked for.
const AIM: f64 = 0.5 * Surrogate::ALLOWED;

/// Of so many speeds one may be computed.
const ROUGH_ONE_IN: usize = 4;

fn too_many(count: usize) -> InferError {
    let most = Surrogate::MOST_PARAMETERS;
    InferError::Input(format!(
        "{count} parameters are too many to interpolate curves, which is done for up to {most}"
    ))
}

fn no_room() -> InferError {
    let text = "errors of the parameters and their bounds leave no room to interpolate in";
    InferError::Input(text.to_owned())
}

fn model_fails(error: ModelError) -> InferError {
    InferError::Model(format!("the model fails near the best fit: {error}"))
}

/// A problem whose curves are interpolated near a fit and computed elsewhere.
#[derive(Clone, Debug)]
pub struct Surrogate {
    problem: CurveProblem,
    form: Form,
    /// Numbers of the speeds whose predictions are computed.
    rough: Vec<usize>,
    /// Largest difference of any residual from the model's own, in standard
    /// errors, at points spread over what is covered.
    pub error: f64,
}

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
    /// Parameters that it bears: polynomials of the third degree in more have thousands of terms.
    pub const MOST_PARAMETERS: usize = polynomial::MOST_PARAMETERS;

    /// Largest error of a surrogate that may stand for the model, in standard errors.
    const ALLOWED: f64 = 0.1;

    /// Around a fit, six standard errors to either side. Up to four parameters have a grid; more,
    /// or those for which a grid is too coarse, a polynomial of least squares.
    pub fn new(
        problem: &CurveProblem,
        fit: &Fit,
        covariance: &Covariance,
    ) -> Result<Self, InferError> {
        let few = fit.point.len() <= grid::MOST_PARAMETERS;
        let gridded = few.then(|| Self::within(REACH, problem, fit, covariance));
        match gridded {
            Some(Ok(surrogate)) if surrogate.is_right() => Ok(surrogate),
            _ => Self::by_least_squares(problem, fit, covariance),
        }
    }

    /// Around a fit, so many standard errors to either side, on a grid: for repetitions
    /// whose best fits scatter about this one.
    pub fn within(
        reach: f64,
        problem: &CurveProblem,
        fit: &Fit,
        covariance: &Covariance,
    ) -> Result<Self, InferError> {
        let finer = finer(problem);
        let grid = Grid::within(reach, &finer, fit, covariance)?;
        let trials = grid.trials();
        let mut surrogate = Self {
            problem: finer,
            form: Form::Grid(grid),
            rough: Vec::new(),
            error: f64::INFINITY,
        };
        let exact = surrogate.problem.all_curves(&trials).into_iter();
        let exact: Result<Vec<_>, _> = exact.collect();
        let exact = exact.map_err(model_fails)?;
        surrogate.error = surrogate.worst(trials.iter().zip(&exact))?;
        Ok(surrogate)
    }

    /// Around a fit, as many standard errors in every direction of the covariance, by
    /// polynomials of rising degree until one is right. Speeds at which none is, where the model
    /// jumps, are computed, if they are few.
    fn by_least_squares(
        problem: &CurveProblem,
        fit: &Fit,
        covariance: &Covariance,
    ) -> Result<Self, InferError> {
        let finer = finer(problem);
        let few = finer.all_speeds_m_s().len() / ROUGH_ONE_IN;
        let mut study = polynomial::Study::new(REACH, &finer, fit, covariance)?;
        let mut best: Option<Self> = None;
        while let Some(polynomial) = study.next(&finer)? {
            let rough = study.rough(&finer, &polynomial, Self::ALLOWED);
            let mut found = Self {
                problem: finer.clone(),
                form: Form::Polynomial(polynomial),
                rough: if rough.len() > few { Vec::new() } else { rough },
                error: f64::INFINITY,
            };
            found.error = found.worst(study.trials())?;
            let idle = best.as_ref().is_some_and(|best| !found.beats(best));
            let right = found.error <= AIM && found.rough.is_empty();
            if !idle {
                best = Some(found);
            }
            let good = best.as_ref().is_some_and(Self::is_right);
            if right || idle && good {
                break;
            }
        }
        best.ok_or(too_many(fit.point.len()))
    }

    /// Whether it is right where another is not, or with fewer speeds computed.
    fn beats(&self, other: &Self) -> bool {
        match self.is_right() && other.is_right() {
            true => self.rough.len() < other.rough.len(),
            false => self.error < other.error,
        }
    }

    /// Whether it may stand for the model.
    pub fn is_right(&self) -> bool {
        self.error <= Self::ALLOWED
    }

    /// Speeds in m/s whose times are computed at every point, as the model jumps there.
    pub fn computed_speeds_m_s(&self) -> Vec<f64> {
        let speeds = self.problem.all_speeds_m_s();
        self.rough.iter().map(|at| speeds[*at]).collect()
    }

    /// The same curves against other measured values at the same speeds.
    pub fn with_data(&self, data: impl IntoIterator<Item = Data>) -> Result<Self, InferError> {
        Ok(Self { problem: self.problem.with_data(data)?, ..self.clone() })
    }
}

fn finer(problem: &CurveProblem) -> CurveProblem {
    let accuracy = FINER * problem.model().accuracy;
    problem.clone().with_accuracy(accuracy)
}

/// Middle and half width of a parameter's range within so many standard errors and bounds.
fn side(parameter: &Parameter, value: f64, reach: f64, sd: f64) -> Result<(f64, f64), InferError> {
    if !(sd > 0.0 && sd.is_finite()) {
        let name = &parameter.name;
        return InferError::input(format!(
            "{name} has no finite standard error: there is no room to interpolate in"
        ));
    }
    let lower = (value - reach * sd).max(parameter.lower);
    let upper = (value + reach * sd).min(parameter.upper);
    Ok((0.5 * (lower + upper), 0.5 * (upper - lower)))
}

impl Surrogate {
    /// Largest difference of residuals from the model's own at points with its curves.
    fn worst<'a>(
        &self,
        trials: impl Iterator<Item = (&'a Vec<f64>, &'a Vec<Predicted>)>,
    ) -> Result<f64, InferError> {
        let residuals = |curve: &[Predicted]| {
            let found = self.problem.residuals_of(curve);
            found.map_err(model_fails)
        };
        let mut worst: f64 = 0.0;
        for (point, exact) in trials {
            let mut own = self.form.curve(point).ok_or(no_room())?;
            self.rough.iter().for_each(|at| own[*at] = exact[*at]);
            let (own, exact) = (residuals(&own)?, residuals(exact)?);
            let pairs = own.standardised.iter().zip(&exact.standardised);
            worst = pairs.map(|(a, b)| (a - b).abs()).fold(worst, f64::max);
        }
        Ok(worst)
    }

    /// Residuals of points that are covered, from their interpolated curves.
    fn covered(
        &self,
        points: &[Vec<f64>],
        mut curves: Vec<Vec<Predicted>>,
    ) -> Vec<Result<Residuals, ModelError>> {
        if self.rough.is_empty() {
            count_done(points.len());
            let of = |curve: &Vec<Predicted>| self.problem.residuals_of(curve);
            return curves.par_iter().map(of).collect();
        }
        // Those that are computed count themselves.
        let computed = self.problem.curves_with(points, |at| self.rough.contains(&at)).into_iter();
        let of = |(curve, computed): (&mut Vec<Predicted>, Result<Vec<Predicted>, _>)| {
            for (at, predicted) in self.rough.iter().zip(computed?) {
                curve[*at] = predicted;
            }
            self.problem.residuals_of(curve)
        };
        curves.iter_mut().zip(computed).map(of).collect()
    }
}

impl Problem for Surrogate {
    fn parameters(&self) -> &[Parameter] {
        self.problem.parameters()
    }

    fn residual_count(&self) -> usize {
        self.problem.residual_count()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>> {
        let curves: Vec<Option<Vec<Predicted>>> =
            (points.par_iter()).map(|point| self.form.curve(point)).collect();
        let chosen = |inside: bool| {
            let pairs = points.iter().zip(&curves);
            let own = pairs.filter(move |(_, curve)| curve.is_some() == inside);
            own.map(|(point, _)| point.clone()).collect::<Vec<_>>()
        };
        // Each kind side by side, as they are dear.
        let (within, beyond) = (chosen(true), chosen(false));
        let inside: Vec<bool> = curves.iter().map(Option::is_some).collect();
        let curves = curves.into_iter().flatten().collect();
        let mut covered = self.covered(&within, curves).into_iter();
        let mut computed = self.problem.residuals(&beyond).into_iter();
        let none = || Err(ModelError("no residuals were computed".into()));
        let all = inside.into_iter().map(|inside| match inside {
            true => covered.next(),
            false => computed.next(),
        });
        all.map(|found| found.unwrap_or_else(none)).collect()
    }

    fn residual_label(&self, index: usize) -> String {
        self.problem.residual_label(index)
    }
}
