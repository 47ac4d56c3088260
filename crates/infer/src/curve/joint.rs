//! Several curves, one set of parameters.

use super::problem::CurveProblem;
use crate::Parameter;
use crate::problem::{ModelError, Problem, Residuals, Response};

/// Where a parameter of one curve's model comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Supply {
    /// A parameter of the whole, by its place.
    Free(usize),
    /// A fixed value in its unit.
    Fixed(f64),
}

/// A curve whose model takes its parameters from those of the whole.
#[derive(Clone, Debug)]
pub struct Part {
    /// The curve against its model.
    pub problem: CurveProblem,
    /// One supply for each of the model's parameters.
    pub supplies: Vec<Supply>,
}

/// Several curves with parameters in common, such as a dry and a wet one of the
/// same beads; or one, some of whose parameters are fixed.
#[derive(Clone, Debug)]
pub struct Joint {
    parameters: Vec<Parameter>,
    parts: Vec<Part>,
}

impl Part {
    fn own(&self, point: &[f64]) -> Vec<f64> {
        let value = |supply: &Supply| match supply {
            Supply::Fixed(value) => *value,
            Supply::Free(at) => point.get(*at).copied().unwrap_or(f64::NAN),
        };
        self.supplies.iter().map(value).collect()
    }
}

impl Joint {
    /// Parts that share these parameters.
    pub fn new(parameters: Vec<Parameter>, parts: Vec<Part>) -> Self {
        Self { parameters, parts }
    }
}

impl Problem for Joint {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn residual_count(&self) -> usize {
        let counts = self.parts.iter().map(|part| part.problem.residual_count());
        counts.sum()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>> {
        let mut all: Vec<Result<Residuals, ModelError>> =
            vec![Ok(Residuals::default()); points.len()];
        for part in &self.parts {
            let own: Vec<Vec<f64>> = points.iter().map(|point| part.own(point)).collect();
            for (sum, found) in all.iter_mut().zip(part.problem.residuals(&own)) {
                match (&mut *sum, found) {
                    (Ok(sum), Ok(found)) => {
                        sum.standardised.extend(found.standardised);
                        sum.ln_sigmas.extend(found.ln_sigmas);
                    }
                    (Ok(_), Err(error)) => *sum = Err(error),
                    (Err(_), _) => {}
                }
            }
        }
        all
    }

    fn responses(&self, point: &[f64]) -> Result<Option<Vec<Response>>, ModelError> {
        let mut all: Vec<Response> = Vec::new();
        for part in &self.parts {
            let (first, count) = (all.len(), part.problem.residual_count());
            let own = part.problem.responses(&part.own(point))?;
            let own = own.unwrap_or_else(|| (0..count).map(|at| vec![(at, 1.0)]).collect());
            let moved = |one: Response| one.into_iter().map(|(at, by)| (first + at, by)).collect();
            all.extend(own.into_iter().map(moved));
        }
        Ok(Some(all))
    }

    fn residual_label(&self, index: usize) -> String {
        let mut rest = index;
        for part in &self.parts {
            let count = part.problem.residual_count();
            if rest < count {
                let label = part.problem.residual_label(rest);
                return format!("{}, {label}", part.problem.data().file);
            }
            rest -= count;
        }
        String::new()
    }
}
