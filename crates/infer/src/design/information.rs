//! Information as rows whose squares sum.

use super::space::Space;
use super::{Candidate, Expected};
use crate::linear::{dot, svd};

/// Knowledge assumed of every direction, in units of the parameters' sizes, so that the sum
/// of information can always be inverted: next to none.
const KNOWN_TO: f64 = 1e4;
/// Standard errors above this, in units of sizes, are called infinite.
const UNDETERMINED: f64 = 1e2;

/// What is known along the directions that something determines.
#[derive(Clone)]
pub(super) struct Information<'a> {
    /// Orthogonal to each other, each as long as its singular value.
    rows: Vec<Vec<f64>>,
    space: &'a Space,
    /// Along the known directions, each with its size.
    aims: Vec<(Vec<f64>, f64)>,
}

impl<'a> Information<'a> {
    /// Of the columns of a Jacobian, for aims in units of the parameters' sizes.
    pub(super) fn new(columns: &[Vec<f64>], space: &'a Space, aims: Vec<(Vec<f64>, f64)>) -> Self {
        let count = columns.first().map_or(0, Vec::len);
        let row = |i: usize| columns.iter().map(|column| column[i]).collect();
        let rows: Vec<Vec<f64>> = (0..count).map(row).collect();
        let known = space.known.len();
        let assumed = (0..known).map(|k| {
            let mut row = vec![0.0; known];
            row[k] = KNOWN_TO.recip();
            row
        });
        let along = |direction: &[f64]| -> Vec<f64> {
            space
                .known
                .iter()
                .map(|known| dot(known, direction))
                .collect()
        };
        let aims = aims
            .iter()
            .map(|(direction, size)| (along(direction), *size));
        Self {
            rows: assumed.collect(),
            aims: aims.collect(),
            space,
        }
        .with(&rows)
    }

    /// Together with further rows, in 1/(unit of θ); as many rows as directions.
    pub(super) fn with(&self, further: &[Vec<f64>]) -> Self {
        let mut rows = self.rows.clone();
        rows.extend(further.iter().map(|row| self.along(row)));
        let columns: Vec<Vec<f64>> = (0..self.space.known.len())
            .map(|k| rows.iter().map(|row| row[k]).collect())
            .collect();
        let found = svd(&columns);
        let compact = found.values.iter().zip(&found.right);
        Self {
            rows: compact
                .map(|(value, v)| v.iter().map(|x| x * value).collect())
                .collect(),
            ..self.clone()
        }
    }

    /// A row along the known directions; what it says of the others is noise.
    fn along(&self, row: &[f64]) -> Vec<f64> {
        let pairs = row.iter().zip(&self.space.sizes);
        let scaled: Vec<f64> = pairs.map(|(x, size)| x * size).collect();
        self.space
            .known
            .iter()
            .map(|known| dot(known, &scaled))
            .collect()
    }

    /// Standard errors of the aims, in units of sizes.
    fn sds(&self) -> Vec<f64> {
        let sd = |(aim, _): &(Vec<f64>, f64)| {
            let parts = self.rows.iter().map(|row| {
                let square = dot(row, row);
                (dot(row, aim) / square).powi(2)
            });
            parts.sum::<f64>().sqrt()
        };
        self.aims.iter().map(sd).collect()
    }

    /// Standard errors of the aims in their units; infinite if undetermined.
    pub(super) fn shown(&self) -> Vec<f64> {
        let pairs = self.sds().into_iter().zip(&self.aims);
        let known = |(sd, (_, size)): (f64, &(Vec<f64>, f64))| match sd > UNDETERMINED {
            true => f64::INFINITY,
            false => sd * size,
        };
        pairs.map(known).collect()
    }

    /// What a candidate, by its place, is expected to tell.
    pub(super) fn expected(&self, candidate: &Candidate, place: usize) -> Expected {
        let after = self.with(&candidate.rows);
        let pairs = self.sds().into_iter().zip(after.sds());
        let gain: f64 = pairs.map(|(old, new)| (old / new).ln()).sum();
        Expected {
            candidate: place,
            after: after.shown(),
            gain,
            gain_per_cost: gain / candidate.cost,
        }
    }
}
