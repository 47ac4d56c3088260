//! Curves by interpolation between curves computed before.
//!
//! A posterior needs a million curves that differ little. Within a box around
//! the best fit the logarithm of every time of flight is a smooth function of the
//! parameters, which a polynomial through curves at Chebyshev's nodes gives to a
//! small part of a standard error. How small is measured, at points between.

use super::model::Predicted;
use super::problem::{CurveError, CurveProblem};
use crate::data::Data;
use crate::problem::{ModelError, Problem, Residuals};
use crate::{Covariance, Fit, Parameter};
use hertzchain_study::count_done;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Half the box's width in standard errors, unless another is asked for.
const REACH: f64 = 6.0;

/// Nodes a parameter, for one to four parameters: some hundreds of curves in all.
const NODES: [usize; 4] = [11, 9, 7, 5];

/// Accuracy of its curves over the problem's own: a polynomial through many nodes
/// multiplies their errors.
const FINER: f64 = 0.1;

/// Points at which a surrogate is held against the model.
const TRIALS: usize = 40;

/// Why there is no surrogate; the model itself still does.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurrogateError {
    /// Too many nodes.
    #[error("{0} parameters are too many to interpolate curves, which is done for up to {most}", most = Surrogate::MOST_PARAMETERS)]
    TooMany(usize),
    /// A parameter without a width.
    #[error("{name} has no finite standard error: there is no box to interpolate in")]
    NoWidth {
        /// The parameter.
        name: String,
    },
    /// A curve in the box that does not exist.
    #[error("the model fails near the best fit: {0}")]
    ModelFails(ModelError),
}

/// A problem whose curves are interpolated within a box and computed outside.
#[derive(Clone, Debug)]
pub struct Surrogate {
    problem: CurveProblem,
    /// Middle and half width of each parameter's side.
    sides: Vec<(f64, f64)>,
    nodes: usize,
    /// ln of predictions at all nodes, the last parameter's running fastest; not
    /// a number where there is none.
    table: Vec<Vec<[f64; 4]>>,
    /// Largest difference of any residual from the model's own, in standard
    /// errors, at points drawn evenly in the box.
    pub error: f64,
}

impl Surrogate {
    /// Parameters that it bears: five values of each of five would be thousands of
    /// curves.
    pub const MOST_PARAMETERS: usize = NODES.len();

    /// Around a fit, six standard errors to either side.
    ///
    /// # Errors
    /// See [`SurrogateError`].
    pub fn new(
        problem: &CurveProblem,
        fit: &Fit,
        covariance: &Covariance,
    ) -> Result<Self, SurrogateError> {
        Self::within(REACH, problem, fit, covariance)
    }

    /// Around a fit, so many standard errors to either side: for repetitions
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
        let count = fit.point.len();
        let nodes = *count
            .checked_sub(1)
            .and_then(|at| NODES.get(at))
            .ok_or(SurrogateError::TooMany(count))?;
        let sides: Vec<(f64, f64)> = (problem.parameters().iter().enumerate())
            .map(|(at, parameter)| side(parameter, fit.point[at], reach, covariance.sd[at]))
            .collect::<Result<_, _>>()?;
        let mut surrogate = Self {
            problem: problem
                .clone()
                .with_accuracy(FINER * problem.model().accuracy),
            sides,
            nodes,
            table: Vec::new(),
            error: f64::INFINITY,
        };
        let points: Vec<Vec<f64>> = (0..nodes.pow(count as u32))
            .map(|number| surrogate.node(number))
            .collect();
        for curve in surrogate.problem.all_curves(&points) {
            let curve = curve.map_err(SurrogateError::ModelFails)?;
            let ln = |row: &Predicted| row.map(|value| value.map_or(f64::NAN, f64::ln));
            surrogate.table.push(curve.iter().map(ln).collect());
        }
        surrogate.error = surrogate.measured_error()?;
        Ok(surrogate)
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

    /// The place of a node in the box.
    fn node(&self, number: usize) -> Vec<f64> {
        let count = self.sides.len();
        let place = |(at, (middle, half)): (usize, &(f64, f64))| {
            let digit = number / self.nodes.pow((count - 1 - at) as u32) % self.nodes;
            middle + half * chebyshev(digit, self.nodes)
        };
        self.sides.iter().enumerate().map(place).collect()
    }

    /// Weights of the nodes along each side; none outside the box.
    fn weights(&self, point: &[f64]) -> Option<Vec<Vec<f64>>> {
        let sides = self.sides.iter().zip(point);
        sides
            .map(|((middle, half), value)| {
                let x = (value - middle) / half;
                (x.abs() <= 1.0).then(|| barycentric(x, self.nodes))
            })
            .collect()
    }

    /// The curve inside the box.
    fn interpolated(&self, weights: &[Vec<f64>]) -> Vec<Predicted> {
        let rows = self.table.first().map_or(0, Vec::len);
        let mut sums = vec![[0.0; 4]; rows];
        for (number, curve) in self.table.iter().enumerate() {
            let mut rest = number;
            let mut weight = 1.0;
            for along in weights.iter().rev() {
                weight *= along[rest % self.nodes];
                rest /= self.nodes;
            }
            for (sum, row) in sums.as_flattened_mut().iter_mut().zip(curve.as_flattened()) {
                *sum += weight * row;
            }
        }
        let exp = |ln: f64| (!ln.is_nan()).then(|| ln.exp());
        sums.iter().map(|row| row.map(exp)).collect()
    }

    /// Against the model, at places that fill the box evenly.
    fn measured_error(&self) -> Result<f64, SurrogateError> {
        let points: Vec<Vec<f64>> = (1..=TRIALS).map(|number| self.between(number)).collect();
        let own = self.residuals(&points);
        let exact = self.problem.residuals(&points);
        let mut worst: f64 = 0.0;
        for (own, exact) in own.into_iter().zip(exact) {
            let own = own.map_err(SurrogateError::ModelFails)?.standardised;
            let exact = exact.map_err(SurrogateError::ModelFails)?.standardised;
            let differences = own.iter().zip(&exact).map(|(a, b)| (a - b).abs());
            worst = differences.fold(worst, f64::max);
        }
        Ok(worst)
    }

    /// Place of an even sequence: multiples of roots of the generalised golden
    /// ratio, which no grid of nodes shares.
    fn between(&self, number: usize) -> Vec<f64> {
        let count = self.sides.len();
        // The positive root of x^(d+1) = x + 1.
        let ratio = (0..60).fold(1.5_f64, |x, _| (1.0 + x).powf(1.0 / (count as f64 + 1.0)));
        let place = |(at, (middle, half)): (usize, &(f64, f64))| {
            let step = ratio.powi(-(at as i32) - 1);
            let share = (0.5 + step * number as f64).fract();
            middle + half * (2.0 * share - 1.0)
        };
        self.sides.iter().enumerate().map(place).collect()
    }
}

/// A side of the box, within the parameter's bounds.
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

/// Chebyshev's node of the first kind in (−1, 1).
fn chebyshev(number: usize, nodes: usize) -> f64 {
    (PI * (2.0 * number as f64 + 1.0) / (2.0 * nodes as f64)).cos()
}

/// Lagrange's polynomials of Chebyshev's nodes at x, by the barycentric formula
/// [BerrutTrefethen2004].
fn barycentric(x: f64, nodes: usize) -> Vec<f64> {
    let angle = |number: usize| PI * (2.0 * number as f64 + 1.0) / (2.0 * nodes as f64);
    if let Some(hit) = (0..nodes).find(|&number| x == chebyshev(number, nodes)) {
        return (0..nodes).map(|n| f64::from(u8::from(n == hit))).collect();
    }
    let term = |number: usize| {
        let sign = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * angle(number).sin() / (x - chebyshev(number, nodes))
    };
    let terms: Vec<f64> = (0..nodes).map(term).collect();
    let sum: f64 = terms.iter().sum();
    terms.iter().map(|term| term / sum).collect()
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
            let weights = self.weights(point)?;
            Some(self.problem.residuals_of(&self.interpolated(&weights)))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_lower_degree_than_nodes_are_given_back() {
        let f = |x: f64| 1.0 - 2.0 * x + 0.5 * x.powi(4);
        for x in [-1.0, -0.3, 0.0, 0.77, chebyshev(2, 5)] {
            let weights = barycentric(x, 5);
            let sum: f64 = (0..5).map(|n| weights[n] * f(chebyshev(n, 5))).sum();
            // Rounding of ten operations.
            assert!((sum - f(x)).abs() < 1e-14, "{x}: {sum}");
        }
    }
}
