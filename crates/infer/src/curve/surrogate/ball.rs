//! The room around a fit in units of its own errors.

use super::{no_room, side};
use crate::linear::{cholesky, norm};
use crate::problem::Problem;
use crate::random::{Purpose, RandomStream};
use crate::{Covariance, Fit, InferError, Parameter};

/// All points within so many standard errors of a fit in every direction of its
/// covariance, and within the parameters' bounds.
#[derive(Clone, Debug)]
pub(super) struct Ball {
    centre: Vec<f64>,
    sd: Vec<f64>,
    /// L of the correlations L Lᵀ, row by row: what stands between parameters in
    /// units of their errors and numbers that know nothing of each other.
    lower: Vec<Vec<f64>>,
    reach: f64,
    parameters: Vec<Parameter>,
}

/// Draws for one point before bounds are said to leave no room: a corner of eight
/// bounds has one in 2⁸.
const MOST_DRAWS: usize = 100_000;

impl Ball {
    pub(super) fn new(
        reach: f64,
        problem: &dyn Problem,
        fit: &Fit,
        covariance: &Covariance,
    ) -> Result<Self, InferError> {
        let parameters = problem.parameters().to_vec();
        let (centre, sd) = (fit.point.clone(), covariance.sd.clone());
        for (at, parameter) in parameters.iter().enumerate() {
            side(parameter, centre[at], reach, sd[at])?;
        }
        let all = 0..sd.len();
        let row = |i: usize| {
            let entry = |j: usize| covariance.matrix[i][j] / (sd[i] * sd[j]);
            all.clone().map(entry).collect()
        };
        let correlations: Vec<Vec<f64>> = all.clone().map(row).collect();
        Ok(Self { lower: cholesky(&correlations).ok_or(no_room())?, centre, sd, reach, parameters })
    }

    /// A point in independent standard errors: by forward substitution.
    pub(super) fn whitened(&self, point: &[f64]) -> Vec<f64> {
        let mut white: Vec<f64> = Vec::with_capacity(point.len());
        for (at, row) in self.lower.iter().enumerate() {
            let aside = (point[at] - self.centre[at]) / self.sd[at];
            let known: f64 = row.iter().zip(&white).map(|(l, z)| l * z).sum();
            white.push((aside - known) / row[at]);
        }
        white
    }

    /// Whether it reaches so far.
    pub(super) fn covers(&self, white: &[f64]) -> bool {
        norm(white) <= self.reach
    }

    /// A point of it, at a distance that `share` makes of an even number from 0 to 1.
    pub(super) fn draw(
        &self,
        random: &mut RandomStream,
        share: impl Fn(f64) -> f64,
    ) -> Result<Vec<f64>, InferError> {
        for _ in 0..MOST_DRAWS {
            let direction: Vec<f64> = self.sd.iter().map(|_| random.normal()).collect();
            let distance = self.reach * share(random.uniform()) / norm(&direction);
            let white: Vec<f64> = direction.iter().map(|x| x * distance).collect();
            let point = self.place(&white);
            let mut pairs = self.parameters.iter().zip(&point);
            if pairs.all(|(parameter, value)| parameter.admits(*value)) {
                return Ok(point);
            }
        }
        Err(no_room())
    }

    fn place(&self, white: &[f64]) -> Vec<f64> {
        let place = |(at, row): (usize, &Vec<f64>)| {
            let aside: f64 = row.iter().zip(white).map(|(l, z)| l * z).sum();
            self.centre[at] + self.sd[at] * aside
        };
        self.lower.iter().enumerate().map(place).collect()
    }

    /// Its own stream of random, whatever the seed of a fit: one problem has one
    /// surrogate.
    pub(super) fn random() -> RandomStream {
        RandomStream::new(0, Purpose::Surrogate)
    }
}
