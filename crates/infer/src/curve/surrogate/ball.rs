//! The room around a fit in units of its own errors.

use super::{no_room, side};
use crate::linear::{cholesky, dot, forward, norm};
use crate::problem::Problem;
use crate::random::{Purpose, RandomStream};
use crate::{Covariance, Fit, InferError, Parameter};

/// All points within bounds and so many standard errors of a fit in every direction.
#[derive(Clone, Debug)]
pub(super) struct Ball {
    centre: Vec<f64>,
    sd: Vec<f64>,
    /// L of the correlations L Lᵀ, row by row.
    lower: Vec<Vec<f64>>,
    reach: f64,
    parameters: Vec<Parameter>,
}

/// Draws for one point before bounds leave no room: a corner of eight has one in 2⁸.
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
        let correlation = |i: usize, j: usize| covariance.matrix[i][j] / (sd[i] * sd[j]);
        let lower = cholesky(sd.len(), correlation).ok_or(no_room())?;
        Ok(Self { lower, centre, sd, reach, parameters })
    }

    /// A point in independent standard errors, and whether the ball reaches so far.
    pub(super) fn whitened(&self, point: &[f64]) -> (Vec<f64>, bool) {
        let aside = point.iter().zip(&self.centre).zip(&self.sd);
        let aside: Vec<f64> = aside.map(|((x, centre), sd)| (x - centre) / sd).collect();
        let white = forward(&self.lower, &aside);
        let is_covered = norm(&white) <= self.reach;
        (white, is_covered)
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
        let rows = self.lower.iter().enumerate();
        rows.map(|(at, row)| self.centre[at] + self.sd[at] * dot(row, white)).collect()
    }

    /// Its own stream, whatever the seed of a fit: one problem has one surrogate.
    pub(super) fn random() -> RandomStream {
        RandomStream::new(0, Purpose::Surrogate)
    }
}
