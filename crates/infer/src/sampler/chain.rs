//! Walkers, step by step.

use super::SamplingError;
use super::ball::ball;
use super::density::{admitted, ln_densities};
use super::moves::{Proposal, propose};
use crate::chance::{Chance, Purpose};
use crate::covariance::Covariance;
use crate::least_squares::check;
use crate::{Fit, Loss, Problem};
use serde::{Deserialize, Serialize};

/// How to sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Walkers of one ensemble: even, at least twice the parameters and four.
    pub walkers: usize,
    /// Ensembles that know nothing of each other but run side by side.
    pub ensembles: usize,
    /// Share of moves by differences of walkers; the others stretch.
    pub differential_share: f64,
    /// Every so many steps are kept.
    pub keep_every: u64,
    /// Seed of all chance.
    pub seed: u64,
}

impl Default for Sampling {
    fn default() -> Self {
        Self {
            walkers: 32,
            ensembles: 2,
            differential_share: 0.5,
            keep_every: 1,
            seed: 0,
        }
    }
}

impl Sampling {
    fn check(&self, parameters: usize) -> Result<(), SamplingError> {
        let least = (2 * parameters).max(4);
        let wrong = |name, value, expected: &str| {
            let expected = expected.to_owned();
            Err(SamplingError::Option {
                name,
                value,
                expected,
            })
        };
        if self.walkers < least || !self.walkers.is_multiple_of(2) {
            let expected = format!("an even number from {least}");
            return wrong("number of walkers", self.walkers as f64, &expected);
        }
        if self.ensembles == 0 {
            return wrong("number of ensembles", 0.0, "at least 1");
        }
        if self.keep_every == 0 {
            return wrong("number of steps between kept ones", 0.0, "at least 1");
        }
        if !(0.0..=1.0).contains(&self.differential_share) {
            let share = self.differential_share;
            return wrong("share of difference moves", share, "0 to 1");
        }
        Ok(())
    }
}

/// Chains of an affine-invariant ensemble sampler, so far.
///
/// An ensemble's halves move in turn, each by proposals from the other half, so
/// that one call of the model serves all walkers of a half [ForemanMackey2013],
/// of all ensembles. Every half step has a stream of random numbers of its own:
/// a chain that is saved with `serde`, read back exactly (with `serde_json`: its
/// feature `float_roundtrip`) and continued has the bits of one that was never
/// interrupted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chain {
    names: Vec<String>,
    seed: u64,
    ensembles: usize,
    differential_share: f64,
    keep_every: u64,
    loss: Loss,
    steps: u64,
    /// Where walkers stand, ensemble by ensemble.
    places: Vec<Vec<f64>>,
    ln_densities: Vec<f64>,
    /// Kept places: step by step, walker by walker, parameter by parameter.
    samples: Vec<f64>,
    accepted: u64,
    failed: u64,
}

impl Chain {
    /// Walkers around a fit's optimum.
    ///
    /// # Errors
    /// Options out of range, or no place around the optimum where the model works.
    pub fn start(
        problem: &dyn Problem,
        fit: &Fit,
        covariance: &Covariance,
        how: &Sampling,
    ) -> Result<Self, SamplingError> {
        check(problem)?;
        how.check(problem.parameters().len())?;
        let (mut places, mut densities) = (Vec::new(), Vec::new());
        for ensemble in 0..how.ensembles {
            let stream = u32::try_from(ensemble).unwrap_or(u32::MAX);
            let around = (fit, covariance);
            let (walkers, found) = ball(problem, around, how.walkers, (how.seed, stream))?;
            places.extend(walkers);
            densities.extend(found);
        }
        Ok(Self {
            names: names(problem),
            seed: how.seed,
            ensembles: how.ensembles,
            differential_share: how.differential_share,
            keep_every: how.keep_every,
            loss: fit.loss,
            steps: 0,
            places,
            ln_densities: densities,
            samples: Vec::new(),
            accepted: 0,
            failed: 0,
        })
    }

    /// Leads all walkers on by some steps.
    ///
    /// # Errors
    /// A chain of other parameters, or one that was damaged on disk.
    pub fn advance(&mut self, problem: &dyn Problem, steps: u64) -> Result<(), SamplingError> {
        self.matches(problem)?;
        for _ in 0..steps {
            self.half_step(problem, 0);
            self.half_step(problem, 1);
            self.steps += 1;
            if self.steps.is_multiple_of(self.keep_every) {
                self.samples.extend(self.places.iter().flatten());
            }
        }
        Ok(())
    }

    fn half_step(&mut self, problem: &dyn Problem, half: usize) {
        let number = 2 * self.steps + half as u64;
        let mut chance = Chance::new(self.seed, Purpose::HalfStep(number));
        let movers = self.movers(half);
        let proposals: Vec<Proposal> = (movers.iter())
            .map(|(walker, still)| {
                let others = &self.places[still.clone()];
                let here = &self.places[*walker];
                propose(here, others, self.differential_share, &mut chance)
            })
            .collect();
        // Places beyond a bound need no model.
        let allowed = |proposal: &&Proposal| admitted(problem, &proposal.point);
        let points: Vec<Vec<f64>> = (proposals.iter().filter(allowed))
            .map(|proposal| proposal.point.clone())
            .collect();
        let mut densities = ln_densities(problem, self.loss, &points).into_iter();
        for ((walker, _), proposal) in movers.into_iter().zip(proposals) {
            let density = match admitted(problem, &proposal.point) {
                true => densities.next(),
                false => None,
            };
            self.decide(walker, proposal, density);
        }
    }

    /// Walkers of a half of each ensemble, and the range of those that stand still for them.
    fn movers(&self, half: usize) -> Vec<(usize, std::ops::Range<usize>)> {
        let size = self.places.len() / self.ensembles;
        let of = |ensemble: usize| {
            let start = |half: usize| ensemble * size + half * (size / 2);
            let still = start(1 - half)..start(1 - half) + size / 2;
            (start(half)..start(half) + size / 2).map(move |walker| (walker, still.clone()))
        };
        (0..self.ensembles).flat_map(of).collect()
    }

    /// Moves a walker or leaves it; no density means a place beyond a bound.
    fn decide(&mut self, walker: usize, proposal: Proposal, density: Option<f64>) {
        let Some(density) = density else { return };
        if density == f64::NEG_INFINITY {
            self.failed += 1;
            return;
        }
        let gain = density - self.ln_densities[walker] + proposal.ln_factor;
        if proposal.ln_uniform < gain {
            self.places[walker] = proposal.point;
            self.ln_densities[walker] = density;
            self.accepted += 1;
        }
    }

    /// Whether the chain is sound and of the problem's parameters.
    pub(super) fn matches(&self, problem: &dyn Problem) -> Result<(), SamplingError> {
        self.sound()?;
        match names(problem) == self.names {
            true => Ok(()),
            false => Err(SamplingError::OtherParameters {
                chain: self.names.clone(),
                problem: names(problem),
            }),
        }
    }

    /// Whether a chain from disk is one.
    pub(super) fn sound(&self) -> Result<(), SamplingError> {
        let (walkers, parameters) = (self.places.len(), self.names.len());
        let kept = self.steps.checked_div(self.keep_every).unwrap_or(0) as usize;
        let whole = self.ensembles > 0
            && parameters > 0
            && self.keep_every > 0
            && walkers >= 4 * self.ensembles
            && walkers.is_multiple_of(2 * self.ensembles)
            && self.places.iter().all(|place| place.len() == parameters)
            && self.ln_densities.len() == walkers
            && self.samples.len() == kept * walkers * parameters;
        if whole {
            Ok(())
        } else {
            Err(SamplingError::Damaged)
        }
    }

    /// What outliers cost.
    pub(super) fn loss(&self) -> Loss {
        self.loss
    }

    /// Where walkers stand.
    pub(super) fn places(&self) -> &[Vec<f64>] {
        &self.places
    }

    /// ln of the density at each walker's place.
    pub(super) fn ln_densities(&self) -> &[f64] {
        &self.ln_densities
    }

    /// Names of the parameters.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Steps so far.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Walkers of all ensembles.
    #[must_use]
    pub fn walkers(&self) -> usize {
        self.places.len()
    }

    /// Steps between kept ones.
    #[must_use]
    pub fn keep_every(&self) -> u64 {
        self.keep_every
    }

    /// Share of proposals that were taken.
    #[must_use]
    pub fn acceptance(&self) -> f64 {
        self.accepted as f64 / self.proposed()
    }

    /// Share of proposals at which the model failed.
    #[must_use]
    pub fn failures(&self) -> f64 {
        self.failed as f64 / self.proposed()
    }

    fn proposed(&self) -> f64 {
        (self.steps as f64 * self.places.len() as f64).max(1.0)
    }

    /// Kept places of one walker's one parameter, in order. Quantiles are for
    /// [`posterior`](Self::posterior), which asks first whether they mean anything.
    pub fn trace(&self, walker: usize, parameter: usize) -> impl Iterator<Item = f64> + '_ {
        let (walkers, parameters) = (self.places.len(), self.names.len());
        let place = walker * parameters + parameter;
        let steps = self.samples.chunks(walkers * parameters);
        steps.filter_map(move |step| step.get(place).copied())
    }
}

fn names(problem: &dyn Problem) -> Vec<String> {
    problem
        .parameters()
        .iter()
        .map(|p| p.name.clone())
        .collect()
}
