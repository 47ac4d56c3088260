//! Walkers, step by step.

use crate::least_squares::{Merit, check};
use crate::random::{Purpose, RandomStream};
use crate::{Covariance, Fit, InferError, Loss, Parameter, Prior, Problem};
use serde::{Deserialize, Serialize};

/// Options of [`Chain::start`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Walkers of one ensemble: even, at least twice the parameters and four.
    pub walkers: usize,
    /// Independent ensembles that run side by side.
    pub ensembles: usize,
    /// Share of moves by differences of walkers; the others stretch.
    pub differential_share: f64,
    /// Every so many steps are stored.
    pub keep_every: u64,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl Default for Sampling {
    fn default() -> Self {
        Self { walkers: 32, ensembles: 2, differential_share: 0.5, keep_every: 1, seed: 0 }
    }
}

impl Sampling {
    fn check(&self, parameters: usize) -> Result<(), InferError> {
        let least = (2 * parameters).max(4);
        let share = self.differential_share;
        match () {
            () if self.walkers < least || !self.walkers.is_multiple_of(2) => {
                InferError::input(format!(
                    "number of walkers is {}: expected an even number from {least}",
                    self.walkers
                ))
            }
            () if self.ensembles == 0 => {
                InferError::input("number of ensembles is 0: expected at least 1")
            }
            () if self.keep_every == 0 => {
                InferError::input("number of steps between stored ones is 0: expected at least 1")
            }
            () if !(0.0..=1.0).contains(&share) => {
                InferError::input(format!("share of difference moves is {share}: expected 0 to 1"))
            }
            () => Ok(()),
        }
    }
}

/// Chains of an affine-invariant ensemble sampler, so far.
///
/// An ensemble's halves move in turn, each by proposals from the other half, so that one call of the
/// model serves all walkers of a half [ForemanMackey2013], of all ensembles. Every half step has a
/// stream of random numbers of its own: a chain that is saved with `serde`, read back exactly (with
/// `serde_json`: its feature `float_roundtrip`) and continued has the bits of one that was never
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
    /// Stored places: step by step, walker by walker, parameter by parameter.
    samples: Vec<f64>,
    accepted: u64,
    failed: u64,
}

/// A chain is not that of a problem whose ln densities differ by more: other instruction sets move
/// them by 10⁻⁶, other data by units.
const SAME: f64 = 0.05;

/// More than any machine steps or moves; half steps are counted too.
const MOST_STEPS: u64 = 1 << 62;

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
    ) -> Result<Self, InferError> {
        check(problem)?;
        how.check(problem.parameters().len())?;
        let (mut places, mut ln_densities) = (Vec::new(), Vec::new());
        for ensemble in 0..how.ensembles {
            let ensemble = u32::try_from(ensemble).unwrap_or(u32::MAX);
            let mut random = RandomStream::new(how.seed, Purpose::Walkers(ensemble));
            let (own, found) = walkers(problem, (fit, covariance), how.walkers, &mut random)?;
            places.extend(own);
            ln_densities.extend(found);
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
            ln_densities,
            samples: Vec::new(),
            accepted: 0,
            failed: 0,
        })
    }

    /// Moves all walkers by some steps.
    ///
    /// # Errors
    /// A chain of other parameters, or one that was damaged on disk.
    pub fn advance(&mut self, problem: &dyn Problem, steps: u64) -> Result<(), InferError> {
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
        let mut random = RandomStream::new(self.seed, Purpose::HalfStep(number));
        let size = self.places.len() / self.ensembles;
        let mut proposals = Vec::new();
        for ensemble in 0..self.ensembles {
            let first = |half: usize| ensemble * size + half * (size / 2);
            let others = &self.places[first(1 - half)..first(1 - half) + size / 2];
            for walker in first(half)..first(half) + size / 2 {
                let here = &self.places[walker];
                let proposal = propose(here, others, self.differential_share, &mut random);
                let is_admitted = admitted(problem, &proposal.point);
                proposals.push((walker, proposal, is_admitted));
            }
        }
        // Places beyond a bound need no model.
        let inside = proposals.iter().filter(|(_, _, is_admitted)| *is_admitted);
        let points: Vec<Vec<f64>> = inside.map(|(_, proposal, _)| proposal.point.clone()).collect();
        let mut densities = ln_densities(problem, self.loss, &points).into_iter();
        for (walker, proposal, is_admitted) in proposals {
            let density = if is_admitted { densities.next() } else { None };
            let Some(density) = density else { continue };
            if density == f64::NEG_INFINITY {
                self.failed += 1;
            } else if proposal.ln_uniform < density - self.ln_densities[walker] + proposal.ln_factor
            {
                self.places[walker] = proposal.point;
                self.ln_densities[walker] = density;
                self.accepted += 1;
            }
        }
    }

    /// Checks that the chain is undamaged and of the problem's parameters.
    fn matches(&self, problem: &dyn Problem) -> Result<(), InferError> {
        self.check()?;
        let (own, names) = (&self.names, names(problem));
        match names == *own {
            true => Ok(()),
            false => InferError::input(format!(
                "the chain is of {own:?}, the problem has {names:?}: continue it with the same free parameters, in the same order"
            )),
        }
    }

    /// Checks the numbers of walkers, parameters and samples of a chain that comes from disk.
    pub(super) fn check(&self) -> Result<(), InferError> {
        let (walkers, parameters) = (self.places.len(), self.names.len());
        let stored = self.steps.checked_div(self.keep_every).unwrap_or(0) as usize;
        let samples = stored.checked_mul(walkers).and_then(|all| all.checked_mul(parameters));
        let is_whole = self.ensembles > 0
            && parameters > 0
            && self.keep_every > 0
            && self.steps.max(self.accepted).max(self.failed) < MOST_STEPS
            && walkers / 4 >= self.ensembles
            && walkers.is_multiple_of(2 * self.ensembles)
            && self.places.iter().all(|place| place.len() == parameters)
            && self.ln_densities.len() == walkers
            && samples == Some(self.samples.len());
        match is_whole {
            true => Ok(()),
            false => InferError::input(
                "the saved chain is damaged: its walkers, parameters and samples do not fit together; start anew",
            ),
        }
    }

    /// Checks that the walkers' densities are those of this problem: for a chain from disk.
    ///
    /// # Errors
    /// A chain of other parameters, data or another model, or a damaged one.
    pub fn belongs_to(&self, problem: &dyn Problem) -> Result<(), InferError> {
        self.matches(problem)?;
        let found = ln_densities(problem, self.loss, &self.places);
        let mut pairs = self.ln_densities.iter().zip(found);
        match pairs.all(|(own, found)| (own - found).abs() <= SAME) {
            true => Ok(()),
            false => InferError::input(
                "the chain was sampled from other data, another model or other priors: continue it with what it was begun with, or start anew",
            ),
        }
    }

    /// Names of the parameters.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Steps so far.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Walkers of all ensembles.
    pub fn walkers(&self) -> usize {
        self.places.len()
    }

    pub(crate) fn keep_every(&self) -> u64 {
        self.keep_every
    }

    /// Share of proposals that were accepted.
    pub fn acceptance(&self) -> f64 {
        let proposed = self.steps as f64 * self.places.len() as f64;
        self.accepted as f64 / proposed.max(1.0)
    }

    /// Stored places of one walker's one parameter, in order.
    pub fn trace(&self, walker: usize, parameter: usize) -> impl Iterator<Item = f64> + '_ {
        let (walkers, parameters) = (self.places.len(), self.names.len());
        let place = walker * parameters + parameter;
        let steps = self.samples.chunks(walkers * parameters);
        steps.filter_map(move |step| step.get(place).copied())
    }
}

fn names(problem: &dyn Problem) -> Vec<String> {
    problem.parameters().iter().map(|p| p.name.clone()).collect()
}

/// ln of likelihood times priors up to a constant; −∞ where the model fails.
fn ln_densities(problem: &dyn Problem, loss: Loss, points: &[Vec<f64>]) -> Vec<f64> {
    let merit = Merit::new(problem, loss);
    let mut found = problem.residuals(points).into_iter();
    // Log-normal priors are densities over θ itself here.
    let measure = |point: &[f64]| -> f64 {
        let pairs = problem.parameters().iter().zip(point);
        let log_normal = pairs.filter(|(p, _)| matches!(p.prior, Prior::LogNormal { .. }));
        log_normal.map(|(_, value)| value.ln()).sum()
    };
    let density = |point: &Vec<f64>| match found.next().map(|found| merit.value(point, &found)) {
        Some(Ok(valued)) => -valued.cost - measure(point),
        _ => f64::NEG_INFINITY,
    };
    points.iter().map(density).collect()
}

fn admitted(problem: &dyn Problem, point: &[f64]) -> bool {
    let mut parameters = problem.parameters().iter().zip(point);
    parameters.all(|(parameter, value)| parameter.admits(*value))
}

/// A proposed place, accepted if `ln_uniform` is below the difference of ln densities plus
/// `ln_factor`.
struct Proposal {
    point: Vec<f64>,
    ln_factor: f64,
    ln_uniform: f64,
}

/// Spread of the length of difference moves, so that they reach everywhere.
const LENGTHS: f64 = 0.1;

/// A proposal for one walker from those of the other half.
fn propose(
    walker: &[f64],
    others: &[Vec<f64>],
    differential_share: f64,
    random: &mut RandomStream,
) -> Proposal {
    let (point, ln_factor) = if random.uniform() < differential_share {
        // Differential evolution [TerBraak2006]: by the difference of two other walkers times about
        // 2.38/√(2d); as likely there as back.
        let first = random.below(others.len());
        let second = (first + 1 + random.below(others.len() - 1)) % others.len();
        let optimal = 2.38 / (2.0 * walker.len() as f64).sqrt();
        let length = optimal * (1.0 + LENGTHS * random.normal());
        let pairs = others[first].iter().zip(&others[second]);
        let step = pairs.map(|(a, b)| length * (a - b));
        (walker.iter().zip(step).map(|(x, s)| x + s).collect(), 0.0)
    } else {
        // Stretch move [GoodmanWeare2010]: along the line to another walker, by z with density
        // ∝ 1/√z between ½ and 2; accepted with z^(d−1) times the ratio of densities.
        let other = &others[random.below(others.len())];
        let z = 0.5 * (1.0 + random.uniform()).powi(2);
        let point = walker.iter().zip(other).map(|(x, o)| o + z * (x - o)).collect();
        (point, (walker.len() as f64 - 1.0) * z.ln())
    };
    // 1 − u is never 0.
    let ln_uniform = (1.0 - random.uniform()).ln();
    Proposal { point, ln_factor, ln_uniform }
}

/// Times that a walker without a density is drawn again, nearer to the optimum.
const TRIALS: usize = 30;
/// Start of a walker along an unresolved direction, in units of scales.
const UNRESOLVED: f64 = 0.1;

/// Walkers around the optimum, spread like the covariance within bounds, and ln densities.
fn walkers(
    problem: &dyn Problem,
    (fit, covariance): (&Fit, &Covariance),
    count: usize,
    random: &mut RandomStream,
) -> Result<(Vec<Vec<f64>>, Vec<f64>), InferError> {
    let parameters = problem.parameters();
    let draw = |size: f64, random: &mut RandomStream| -> Vec<f64> {
        let displacement = displacement(parameters, fit, covariance, random);
        let places = fit.point.iter().zip(displacement).zip(parameters);
        places.map(|((middle, d), parameter)| inside(middle + size * d, parameter)).collect()
    };
    let mut walkers: Vec<Vec<f64>> = (0..count).map(|_| draw(1.0, random)).collect();
    let mut densities = ln_densities(problem, fit.loss, &walkers);
    for trial in 1..=TRIALS {
        let is_outside = |i: &usize| !densities[*i].is_finite() || !admitted(problem, &walkers[*i]);
        let outside: Vec<usize> = (0..count).filter(is_outside).collect();
        if outside.is_empty() {
            return Ok((walkers, densities));
        }
        let size = 0.7_f64.powf(trial as f64);
        let again: Vec<Vec<f64>> = outside.iter().map(|_| draw(size, random)).collect();
        let found = ln_densities(problem, fit.loss, &again);
        for ((place, walker), density) in outside.into_iter().zip(again).zip(found) {
            (walkers[place], densities[place]) = (walker, density);
        }
    }
    InferError::input(
        "walkers find no place around the optimum where the model can be computed: the fit may be at the edge of what the model bears; set bounds that keep away from it",
    )
}

fn displacement(
    parameters: &[Parameter],
    fit: &Fit,
    covariance: &Covariance,
    random: &mut RandomStream,
) -> Vec<f64> {
    let mut displacement = covariance.displacement(|| random.normal());
    for direction in &covariance.unresolved {
        let parts = direction.iter().zip(parameters).map(|(d, p)| (d / p.scale).abs());
        let size = UNRESOLVED * random.normal() / parts.fold(f64::MIN_POSITIVE, f64::max);
        for (sum, part) in displacement.iter_mut().zip(direction) {
            *sum += size * part;
        }
    }
    for binding in &fit.binding {
        // The density falls by e over 1/push from the bound; `inside` mirrors.
        let width = binding.push.recip().min(parameters[binding.parameter].scale);
        displacement[binding.parameter] += width * random.normal();
    }
    displacement
}

/// Mirrored at a bound that it passes; halfway between both if that passes the other.
fn inside(value: f64, parameter: &Parameter) -> f64 {
    let (lower, upper) = (parameter.lower, parameter.upper);
    let mirrored = match value {
        value if value < lower => 2.0 * lower - value,
        value if value > upper => 2.0 * upper - value,
        value => value,
    };
    match parameter.admits(mirrored) {
        true => mirrored,
        false => 0.5 * (lower + upper),
    }
}
