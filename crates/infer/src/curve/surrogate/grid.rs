//! Polynomials through curves at Chebyshev's nodes of a box.

use super::{model_fails, side, too_many};
use crate::curve::{CurveProblem, Predicted};
use crate::linear::unit;
use crate::problem::Problem;
use crate::{Covariance, Fit, InferError};
use std::f64::consts::PI;

/// Nodes a parameter, for one to four parameters: some hundreds of curves in all.
const NODES: [usize; 4] = [11, 9, 7, 5];

/// Parameters that a grid bears: five values of five would be thousands of curves.
pub(super) const MOST_PARAMETERS: usize = NODES.len();

/// Points at which a grid is held against the model.
const TRIALS: usize = 40;

/// Curves at all nodes of a box.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// Middle and half width of each parameter's side.
    sides: Vec<(f64, f64)>,
    nodes: usize,
    /// ln of predictions at all nodes, the last parameter's running fastest; NaN where none.
    table: Vec<Vec<[f64; 4]>>,
}

impl Grid {
    /// Around a fit, so many standard errors to either side.
    pub(super) fn within(
        reach: f64,
        problem: &CurveProblem,
        fit: &Fit,
        covariance: &Covariance,
    ) -> Result<Self, InferError> {
        let count = fit.point.len();
        let nodes = *count.checked_sub(1).and_then(|at| NODES.get(at)).ok_or(too_many(count))?;
        let parameters = problem.parameters().iter().enumerate();
        let sides = parameters
            .map(|(at, parameter)| side(parameter, fit.point[at], reach, covariance.sd[at]))
            .collect::<Result<_, _>>()?;
        let mut grid = Self { sides, nodes, table: Vec::new() };
        let points: Vec<Vec<f64>> =
            (0..nodes.pow(count as u32)).map(|number| grid.node(number)).collect();
        for curve in problem.all_curves(&points) {
            let curve = curve.map_err(model_fails)?;
            let ln = |row: &Predicted| row.map(|value| value.map_or(f64::NAN, f64::ln));
            grid.table.push(curve.iter().map(ln).collect());
        }
        Ok(grid)
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

    pub(super) fn curve(&self, point: &[f64]) -> Option<Vec<Predicted>> {
        let weights = self.weights(point)?;
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
        Some(sums.iter().map(|row| row.map(exp)).collect())
    }

    /// Places that fill the box evenly.
    pub(super) fn trials(&self) -> Vec<Vec<f64>> {
        (1..=TRIALS).map(|number| self.between(number)).collect()
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

/// Chebyshev's node of the first kind in (−1, 1).
fn chebyshev(number: usize, nodes: usize) -> f64 {
    (PI * (2.0 * number as f64 + 1.0) / (2.0 * nodes as f64)).cos()
}

/// Lagrange's polynomials of Chebyshev's nodes at x, by the barycentric formula
/// [BerrutTrefethen2004].
fn barycentric(x: f64, nodes: usize) -> Vec<f64> {
    let angle = |number: usize| PI * (2.0 * number as f64 + 1.0) / (2.0 * nodes as f64);
    if let Some(hit) = (0..nodes).find(|&number| x == chebyshev(number, nodes)) {
        return unit(nodes, hit);
    }
    let term = |number: usize| {
        let sign = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * angle(number).sin() / (x - chebyshev(number, nodes))
    };
    let terms: Vec<f64> = (0..nodes).map(term).collect();
    let sum: f64 = terms.iter().sum();
    terms.iter().map(|term| term / sum).collect()
}

#[cfg(test)]
#[path = "tests/grid.rs"]
mod tests;
