//! A chain led on until it may be believed.

use super::density::ln_densities;
use super::{Chain, Posterior, Requirements, SamplingError, Unconverged};
use crate::Problem;

/// Steps after which convergence is looked at for the first time.
const FIRST_LOOK: u64 = 500;

/// Steps between calls of whoever saves the chain.
const PIECE: u64 = 10;

/// A chain is not that of a problem whose ln densities differ by more: other
/// instruction sets move them by 10⁻⁶, other data by units.
const SAME: f64 = 0.05;

impl Chain {
    /// Leads all walkers on until the chain meets the requirements or has so many
    /// steps. Convergence is looked at after fixed numbers of steps, each half as
    /// many again as the one before, so that a chain that was interrupted and
    /// continued ends where one ends that ran through. `seen` is shown the chain
    /// every few steps, to save it.
    ///
    /// # Errors
    /// See [`advance`](Self::advance); and whatever `seen` returns.
    pub fn lead<E: From<SamplingError>>(
        &mut self,
        problem: &dyn Problem,
        asked: &Requirements,
        most_steps: u64,
        seen: &mut dyn FnMut(&Self) -> Result<(), E>,
    ) -> Result<Result<Posterior, Unconverged>, E> {
        loop {
            let (due, next) = looks(self.steps());
            let over = self.steps() >= most_steps;
            if due || over {
                match self.posterior(asked) {
                    Err(_) if !over => {}
                    found => return Ok(found),
                }
            }
            let end = next.min(most_steps);
            while self.steps() < end {
                self.advance(problem, PIECE.min(end - self.steps()))?;
                seen(self)?;
            }
        }
    }

    /// Whether the walkers' densities are those of this problem: for a chain that
    /// comes from disk.
    ///
    /// # Errors
    /// A chain of other parameters, data or another model, or a damaged one.
    pub fn belongs_to(&self, problem: &dyn Problem) -> Result<(), SamplingError> {
        self.matches(problem)?;
        let found = ln_densities(problem, self.loss(), self.places());
        let own = self.ln_densities().iter();
        match own
            .zip(found)
            .all(|(own, found)| (own - found).abs() <= SAME)
        {
            true => Ok(()),
            false => Err(SamplingError::OtherProblem),
        }
    }
}

/// Whether convergence is looked at after so many steps, and when next.
fn looks(steps: u64) -> (bool, u64) {
    let mut look = FIRST_LOOK;
    while look < steps {
        look += look / 2;
    }
    match look == steps {
        true => (true, look + look / 2),
        false => (false, look),
    }
}

#[cfg(test)]
#[path = "tests/lead.rs"]
mod tests;
