//! What data and candidates together could determine at all.

use super::Candidate;
use crate::identify::{MOVED, Scaled, is_weak};
use crate::{Jacobian, Parameter};

/// Directions of the parameters, in units of their sizes: those that something
/// determines, and those that nothing does.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Space {
    pub(super) sizes: Vec<f64>,
    /// Unit directions, best determined first.
    pub(super) known: Vec<Vec<f64>>,
    pub(super) open: Vec<Vec<f64>>,
}

impl Space {
    /// Of data, priors and all candidates together.
    pub(super) fn of(sized: &[Parameter], jacobian: &Jacobian, candidates: &[Candidate]) -> Self {
        let now = Scaled::with_priors(sized, jacobian);
        let all = candidates.iter().fold(now, |sum, candidate| {
            sum.and(&Scaled::of_rows(sized, &candidate.rows, &candidate.doubts))
        });
        let (found, floor) = all.taken_apart();
        let pairs = found.values.into_iter().zip(found.right);
        let (open, known): (Vec<_>, Vec<_>) = pairs.partition(|(value, _)| is_weak(*value, floor));
        let directions = |pairs: Vec<(f64, Vec<f64>)>| pairs.into_iter().map(|(_, d)| d).collect();
        Self {
            sizes: sized.iter().map(|p| p.scale).collect(),
            known: directions(known),
            open: directions(open),
        }
    }

    /// Whether a direction that nothing determines moves a parameter.
    pub(super) fn leaves_open(&self, parameter: usize) -> bool {
        let mut open = self.open.iter();
        open.any(|direction| direction[parameter].abs() > MOVED)
    }

    /// A parameter as a direction with its size.
    pub(super) fn parameter(&self, k: usize) -> (Vec<f64>, f64) {
        let mut direction = vec![0.0; self.sizes.len()];
        direction[k] = 1.0;
        (direction, self.sizes[k])
    }
}
