//! Polynomials of a total degree, by least squares on curves at random.

use super::ball::Ball;
use super::{model_fails, too_many};
use crate::curve::{CurveProblem, Predicted};
use crate::linear::least_squares;
use crate::random::RandomStream;
use crate::{Covariance, Fit, InferError};
use rayon::prelude::*;

/// Most parameters: a cubic of more has too many terms.
pub(super) const MOST_PARAMETERS: usize = 18;

/// Terms of a polynomial: with twice as many curves, some seconds of work.
const MOST_TERMS: usize = 1500;

/// Curves a term, with which least squares in Chebyshev's polynomials are as good as certain.
const CURVES_A_TERM: usize = 2;

/// Points at which a polynomial is held against the model.
const TRIALS: usize = 100;

/// The first degree tried.
const FIRST_DEGREE: usize = 3;

/// ln of what a curve predicts as polynomials in a ball.
#[derive(Clone, Debug)]
pub(super) struct Polynomial {
    ball: Ball,
    /// Middle and half width of the independent numbers at the points fitted.
    ranges: Vec<(f64, f64)>,
    degree: usize,
    terms: Vec<PolynomialTerm>,
    /// Speeds of a curve.
    speeds: usize,
    /// Speed and observable of each predicted number.
    outputs: Vec<(usize, usize)>,
    /// Term by term, output by output.
    weights: Vec<Vec<f64>>,
}

/// A product of Chebyshev's polynomials: an earlier term times one of another parameter.
#[derive(Clone, Copy, Debug)]
struct PolynomialTerm {
    /// The earlier term.
    of: usize,
    parameter: usize,
    degree: usize,
}

/// Polynomials of rising degree on the same curves and more.
pub(super) struct Study {
    ball: Ball,
    random: RandomStream,
    degree: usize,
    points: Vec<Vec<f64>>,
    curves: Vec<Vec<Predicted>>,
    trials: Vec<Vec<f64>>,
    exact: Vec<Vec<Predicted>>,
}

impl Study {
    pub(super) fn new(
        reach: f64,
        problem: &CurveProblem,
        fit: &Fit,
        covariance: &Covariance,
    ) -> Result<Self, InferError> {
        let count = fit.point.len();
        if count > MOST_PARAMETERS {
            return Err(too_many(count));
        }
        let ball = Ball::new(reach, problem, fit, covariance)?;
        let mut random = Ball::random();
        // Evenly: most of them near the rim, where a polynomial is worst.
        let even = |u: f64| u.powf(1.0 / count as f64);
        let trial = |_| ball.draw(&mut random, even);
        let trials: Vec<Vec<f64>> = (0..TRIALS).map(trial).collect::<Result<_, _>>()?;
        Ok(Self {
            exact: computed(problem, &trials)?,
            ball,
            random,
            degree: FIRST_DEGREE,
            points: Vec::new(),
            curves: Vec::new(),
            trials,
        })
    }

    /// Where polynomials are tried, with the model's curves there.
    pub(super) fn trials(&self) -> impl Iterator<Item = (&Vec<f64>, &Vec<Predicted>)> {
        self.trials.iter().zip(&self.exact)
    }

    /// Numbers of the speeds at which a polynomial differs by more than so many errors from any
    /// curve, tried or fitted: there the model jumps, from one maximum of a split pulse to
    /// another for instance.
    pub(super) fn rough(
        &self,
        problem: &CurveProblem,
        polynomial: &Polynomial,
        most: f64,
    ) -> Vec<usize> {
        let solved = self.points.iter().zip(&self.curves);
        let all: Vec<_> = self.trials().chain(solved).collect();
        let differences = |(point, exact): &(&Vec<f64>, &Vec<Predicted>)| {
            let own = polynomial.curve(point);
            own.map(|own| problem.differences(&own, exact))
        };
        let found: Vec<Vec<f64>> = all.par_iter().filter_map(differences).collect();
        let speeds = found.first().map_or(0, Vec::len);
        let rough = |at: &usize| found.iter().any(|of| of[*at] > most);
        (0..speeds).filter(rough).collect()
    }

    /// The polynomial of the next degree, if it has not too many terms.
    pub(super) fn next(
        &mut self,
        problem: &CurveProblem,
    ) -> Result<Option<Polynomial>, InferError> {
        let terms = terms(self.trials[0].len(), self.degree);
        if terms.len() > MOST_TERMS {
            return Ok(None);
        }
        self.compute(problem, CURVES_A_TERM * terms.len())?;
        let found = Polynomial::of(self, problem, terms);
        self.degree += 1;
        Ok(Some(found))
    }

    /// Curves at so many points in all.
    fn compute(&mut self, problem: &CurveProblem, count: usize) -> Result<(), InferError> {
        let more = self.points.len()..count;
        // Somewhat more inside than evenly: there the posterior is.
        let inside = |u: f64| u.sqrt();
        let draw = |_| self.ball.draw(&mut self.random, inside);
        let points: Vec<Vec<f64>> = more.map(draw).collect::<Result<_, _>>()?;
        self.curves.extend(computed(problem, &points)?);
        self.points.extend(points);
        Ok(())
    }
}

fn computed(
    problem: &CurveProblem,
    points: &[Vec<f64>],
) -> Result<Vec<Vec<Predicted>>, InferError> {
    let curves = problem.all_curves(points).into_iter();
    let all: Result<_, _> = curves.collect();
    all.map_err(model_fails)
}

impl Polynomial {
    /// By least squares on all curves of a study.
    fn of(study: &Study, problem: &CurveProblem, terms: Vec<PolynomialTerm>) -> Self {
        let white: Vec<Vec<f64>> =
            (study.points.iter()).map(|point| study.ball.whitened(point).0).collect();
        let speeds = study.curves.first().map_or(0, Vec::len);
        let outputs = outputs(problem, speeds);
        let mut polynomial = Self {
            ball: study.ball.clone(),
            ranges: ranges(&white),
            degree: study.degree,
            terms,
            speeds,
            outputs,
            weights: Vec::new(),
        };
        let values: Vec<Vec<f64>> = white.iter().map(|z| polynomial.values(z)).collect();
        let columns = transposed(&values);
        let wanted = |(speed, of): &(usize, usize)| {
            let ln = |curve: &Vec<Predicted>| curve[*speed][*of].map_or(f64::NAN, f64::ln);
            study.curves.iter().map(ln).collect()
        };
        let wanted = polynomial.outputs.iter().map(wanted).collect();
        polynomial.weights = transposed(&least_squares(columns, wanted));
        polynomial
    }

    /// All terms at a point in independent standard errors.
    fn values(&self, white: &[f64]) -> Vec<f64> {
        let chebyshev: Vec<Vec<f64>> = (white.iter().zip(&self.ranges))
            .map(|(z, (middle, half))| chebyshev((z - middle) / half, self.degree))
            .collect();
        let mut values: Vec<f64> = vec![1.0];
        for term in &self.terms[1..] {
            values.push(values[term.of] * chebyshev[term.parameter][term.degree]);
        }
        values
    }

    pub(super) fn curve(&self, point: &[f64]) -> Option<Vec<Predicted>> {
        let (white, is_covered) = self.ball.whitened(point);
        if !is_covered {
            return None;
        }
        let mut sums = vec![0.0; self.outputs.len()];
        for (value, weights) in self.values(&white).iter().zip(&self.weights) {
            for (sum, weight) in sums.iter_mut().zip(weights) {
                *sum += value * weight;
            }
        }
        let mut curve = vec![[None; 4]; self.speeds];
        for ((speed, of), ln) in self.outputs.iter().zip(sums) {
            curve[*speed][*of] = (!ln.is_nan()).then(|| ln.exp());
        }
        Some(curve)
    }
}

/// Products of Chebyshev's polynomials up to a degree in all, factors before products.
fn terms(parameters: usize, degree: usize) -> Vec<PolynomialTerm> {
    let constant = PolynomialTerm { of: 0, parameter: 0, degree: 0 };
    let mut found = vec![(constant, 0)];
    for parameter in 0..parameters {
        for of in 0..found.len() {
            let used = found[of].1;
            for own in 1..=degree - used {
                let degree = own;
                let term = PolynomialTerm { of, parameter, degree };
                found.push((term, used + own));
            }
        }
    }
    found.into_iter().map(|(term, _)| term).collect()
}

/// Chebyshev's polynomials of the first kind at x up to a degree.
fn chebyshev(x: f64, degree: usize) -> Vec<f64> {
    let mut values = vec![1.0, x];
    for at in 2..=degree {
        values.push(2.0 * x * values[at - 1] - values[at - 2]);
    }
    values
}

/// Which numbers of a curve residuals ask for.
fn outputs(problem: &CurveProblem, speeds: usize) -> Vec<(usize, usize)> {
    let measured = problem.measured();
    let used = |of: &usize| measured.iter().any(|(_, _, own)| own.index() == *of);
    let used: Vec<usize> = (0..4).filter(used).collect();
    let at = |speed: usize| used.iter().map(move |of| (speed, *of));
    (0..speeds).flat_map(at).collect()
}

/// Middle and half width of each number of many points.
fn ranges(points: &[Vec<f64>]) -> Vec<(f64, f64)> {
    let range = |at: usize| {
        let values = || points.iter().map(|point| point[at]);
        let (least, most) =
            (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        let half = 0.5 * (most - least);
        (0.5 * (least + most), if half > 0.0 { half } else { 1.0 })
    };
    (0..points.first().map_or(0, Vec::len)).map(range).collect()
}

/// Rows for columns.
fn transposed(rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let column = |at: usize| rows.iter().map(|row| row[at]).collect();
    (0..rows.first().map_or(0, Vec::len)).map(column).collect()
}

#[cfg(test)]
#[path = "tests/polynomial.rs"]
mod tests;
