//! Many descents, one call of the model for each round.

use super::descent::{Descent, Reached};
use crate::{ModelError, Problem};

/// Points and where they came to, and how often the model was computed.
pub(crate) struct Driven {
    pub reached: Vec<Reached>,
    pub evaluations: usize,
}

/// Runs descents side by side to their ends.
pub(crate) fn drive(problem: &dyn Problem, mut descents: Vec<Descent<'_>>) -> Driven {
    let mut evaluations = 0;
    loop {
        let asked: Vec<Vec<Vec<f64>>> = descents.iter().map(Descent::ask).collect();
        let counts: Vec<usize> = asked.iter().map(Vec::len).collect();
        let points: Vec<Vec<f64>> = asked.into_iter().flatten().collect();
        if points.is_empty() {
            break;
        }
        evaluations += points.len();
        let mut found = problem.residuals(&points);
        let missing = || Err(ModelError("the model returned no result here".into()));
        found.resize_with(points.len(), missing);
        let mut rest = found.as_slice();
        for (descent, count) in descents.iter_mut().zip(counts) {
            let (own, others) = rest.split_at(count.min(rest.len()));
            rest = others;
            if count > 0 {
                descent.tell(own);
            }
        }
    }
    Driven {
        reached: descents.into_iter().map(Descent::finish).collect(),
        evaluations,
    }
}
