//! Convergence of a chain, and the posterior of one that has converged.

use super::Chain;
use crate::linear::square;
use crate::{InferError, Problem};
use hertzchain_sim::stopped;
use std::fmt;

/// Integrated autocorrelation time of chains together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Autocorrelation {
    /// τ = 1 + 2 Σ ρ(t), in stored steps: so many count as one independent.
    pub time: f64,
    /// Whether the window of the sum fitted into the chains; a τ that does not is too small.
    pub resolved: bool,
}

/// Width of the window in units of τ, after [Sokal1997].
const WINDOW: f64 = 5.0;

/// τ by Sokal's automatic window, from autocovariances about the mean of all chains and averaged
/// over these: walkers at different places lengthen it, as they should. Chains must have equal
/// lengths. 1 for constant chains; unresolved after a request to stop.
fn autocorrelation_time(chains: &[Vec<f64>]) -> Autocorrelation {
    let length = chains.iter().map(Vec::len).min().unwrap_or(0);
    let count = (length * chains.len()) as f64;
    let mean = chains.iter().flatten().sum::<f64>() / count;
    let covariance = |lag: usize| {
        let products = chains.iter().map(|chain| {
            let pairs = chain.iter().zip(chain.iter().skip(lag));
            pairs.map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>()
        });
        products.sum::<f64>() / ((length - lag) as f64 * chains.len() as f64)
    };
    if length < 2 {
        return Autocorrelation { time: 1.0, resolved: false };
    }
    let variance = covariance(0);
    if variance <= 0.0 {
        return Autocorrelation { time: 1.0, resolved: true };
    }
    let mut time = 1.0;
    // Of long chains every lag takes a millisecond, and there may be thousands.
    for lag in (1..length / 2).take_while(|_| !stopped()) {
        time += 2.0 * covariance(lag) / variance;
        if lag as f64 >= WINDOW * time {
            return Autocorrelation { time: f64::max(time, 0.1), resolved: true };
        }
    }
    Autocorrelation { time, resolved: false }
}

/// Requirements that a chain must meet before quantiles are taken from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Requirements {
    /// Stored length of a walker's chain in autocorrelation times.
    pub times: f64,
    /// Largest split R̂.
    pub r_hat: f64,
    /// Least effective number of samples.
    pub effective: f64,
}

impl Default for Requirements {
    /// 50 autocorrelation times, so that these themselves are known to some ten percent; R̂ of 1.02,
    /// which walkers of that length just reach; 1000 effective samples, which place a 95 % limit to
    /// a tenth of σ.
    fn default() -> Self {
        Self { times: 50.0, r_hat: 1.02, effective: 1000.0 }
    }
}

/// State of one parameter's chains, the first fifth left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diagnosis {
    /// Autocorrelation time in steps.
    pub time: Autocorrelation,
    /// Split R̂ over walkers.
    pub r_hat: f64,
    /// Samples divided by the autocorrelation time.
    pub effective: f64,
    /// Steps diagnosed.
    pub steps: u64,
}

/// A requirement that a parameter misses.
#[derive(Clone, Debug, PartialEq)]
pub struct Shortfall {
    /// The parameter.
    pub name: String,
    /// What is missing.
    pub reason: String,
    /// How many more steps are expected to be enough.
    pub more_steps: u64,
}

/// Why no quantile is reported.
#[derive(Clone, Debug, PartialEq)]
pub struct Unconverged {
    /// Steps so far.
    pub steps: u64,
    /// Everything that is missing.
    pub shortfalls: Vec<Shortfall>,
}

impl Unconverged {
    /// Steps after which all requirements should be met.
    pub fn more_steps(&self) -> u64 {
        self.shortfalls.iter().map(|s| s.more_steps).max().unwrap_or(0)
    }
}

impl fmt::Display for Unconverged {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the chain has not converged after {} steps", self.steps)?;
        for shortfall in &self.shortfalls {
            write!(f, "; {}: {}", shortfall.name, shortfall.reason)?;
        }
        write!(f, ". About {} more steps should do", self.more_steps())
    }
}

/// Chains of fewer steps do not predict how many are needed.
const TOO_SHORT: f64 = 100.0;

impl Chain {
    pub(crate) fn diagnose(&self) -> Result<Vec<Diagnosis>, InferError> {
        self.check()?;
        let diagnosis = |parameter: usize| {
            let chains = self.after_burn_in(parameter);
            let found = autocorrelation_time(&chains);
            let length = chains.first().map_or(0, Vec::len);
            Diagnosis {
                time: Autocorrelation { time: found.time * self.keep_every() as f64, ..found },
                r_hat: split_r_hat(&chains),
                effective: (length * chains.len()) as f64 / found.time.max(1.0),
                steps: length as u64 * self.keep_every(),
            }
        };
        Ok((0..self.names().len()).map(diagnosis).collect())
    }

    /// Each walker's stored places of a parameter without the first fifth.
    fn after_burn_in(&self, parameter: usize) -> Vec<Vec<f64>> {
        let skipped = (self.steps() / self.keep_every()).div_ceil(5) as usize;
        let walker = |walker| self.trace(walker, parameter).skip(skipped).collect();
        (0..self.walkers()).map(walker).collect()
    }

    /// State of each parameter's chains, if all meet the requirements.
    ///
    /// # Errors
    /// All shortfalls, with the steps that should be enough.
    pub fn converged(&self, asked: &Requirements) -> Result<Vec<Diagnosis>, Unconverged> {
        let steps = self.steps();
        let all = self.diagnose().map_err(|error| Unconverged {
            steps,
            shortfalls: vec![Shortfall {
                name: "all".into(),
                reason: error.to_string(),
                more_steps: 0,
            }],
        })?;
        let named = self.names().iter().zip(&all);
        let shortfalls: Vec<Shortfall> =
            named.flat_map(|(name, found)| self.shortfalls(name, found, asked)).collect();
        match shortfalls.is_empty() {
            true => Ok(all),
            false => Err(Unconverged { steps, shortfalls }),
        }
    }

    fn shortfalls(&self, name: &str, found: &Diagnosis, asked: &Requirements) -> Vec<Shortfall> {
        let steps = found.steps as f64;
        let times = steps / found.time.time;
        let excess = |r_hat: f64| r_hat * r_hat - 1.0;
        let mut missing = Vec::new();
        let mut miss = |reason: String, factor: f64| {
            // The first fifth is left out of the longer chain too.
            let needed = match steps < TOO_SHORT {
                true => 5.0 * TOO_SHORT,
                false => 1.25 * factor.clamp(1.1, 1e3) * steps,
            };
            let more_steps = (needed as u64).saturating_sub(self.steps()).max(1);
            missing.push(Shortfall { name: name.to_owned(), reason, more_steps });
        };
        if !found.time.resolved {
            let reason = format!(
                "steps are still correlated over half of the chain (autocorrelation time above {:.0})",
                found.time.time
            );
            miss(reason, 4.0);
        } else if times < asked.times {
            let needed = asked.times;
            let reason = format!("{times:.0} autocorrelation times long, {needed:.0} are needed");
            miss(reason, needed / times);
        }
        let (r_hat, most) = (found.r_hat, asked.r_hat);
        if r_hat.is_nan() || r_hat > most {
            let reason = format!("split R-hat {r_hat:.3}, at most {most:.3} is allowed");
            miss(reason, excess(r_hat) / excess(most));
        }
        let (effective, needed) = (found.effective, asked.effective);
        if effective < needed {
            let reason = format!("{effective:.0} effective samples, {needed:.0} are needed");
            miss(reason, needed / effective.max(1.0));
        }
        missing
    }

    /// Moves all walkers until the chain meets the requirements or has so many steps. Convergence
    /// is tested after fixed numbers of steps, each half as many again as the one before, so that a
    /// chain that was interrupted and continued ends where one ends that ran through. `seen` is
    /// called with the chain every few steps, to save it.
    ///
    /// # Errors
    /// See [`advance`](Self::advance); and whatever `seen` returns.
    pub fn lead<E: From<InferError>>(
        &mut self,
        problem: &dyn Problem,
        asked: &Requirements,
        most_steps: u64,
        seen: &mut dyn FnMut(&Self) -> Result<(), E>,
    ) -> Result<Result<Posterior, Unconverged>, E> {
        loop {
            let (is_due, next) = test_times(self.steps());
            let is_over = self.steps() >= most_steps;
            if is_due || is_over {
                match self.posterior(asked) {
                    Err(_) if !is_over => {}
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

    /// The posterior, if the chain meets the requirements.
    ///
    /// # Errors
    /// Everything that is missing, and how many more steps should be enough.
    pub fn posterior(&self, asked: &Requirements) -> Result<Posterior, Unconverged> {
        let diagnoses = self.converged(asked)?;
        let by_step = |parameter: usize| -> Vec<f64> {
            let chains = self.after_burn_in(parameter);
            let length = chains.first().map_or(0, Vec::len);
            (0..length).flat_map(|i| chains.iter().map(move |chain| chain[i])).collect()
        };
        let samples: Vec<Vec<f64>> = (0..self.names().len()).map(by_step).collect();
        let mean: Vec<f64> = samples.iter().map(|s| mean_of(s)).collect();
        let covariance = square(mean.len(), |i, j| {
            let pairs = samples[i].iter().zip(&samples[j]);
            let products = pairs.map(|(a, b)| (a - mean[i]) * (b - mean[j]));
            products.sum::<f64>() / (samples[i].len() as f64 - 1.0)
        });
        let mut ascending = samples.clone();
        // A million samples take their time: not after a request to stop.
        if !stopped() {
            ascending.iter_mut().for_each(|samples| samples.sort_unstable_by(f64::total_cmp));
        }
        Ok(Posterior { covariance, ascending, diagnoses, mean, samples })
    }
}

/// Steps after which convergence is tested for the first time.
const FIRST_TEST: u64 = 500;
/// Steps between calls that save the chain.
const PIECE: u64 = 10;

/// Whether convergence is tested after so many steps, and when next.
fn test_times(steps: u64) -> (bool, u64) {
    let mut test = FIRST_TEST;
    while test < steps {
        test += test / 2;
    }
    match test == steps {
        true => (true, test + test / 2),
        false => (false, test),
    }
}

/// R̂ of chains cut in halves: √(1 − 1/n + B/W), with W the mean variance within a half and B the
/// variance of their means [GelmanRubin1992]. Walkers n steps long and correlated over τ have about
/// √(1 + τ/n) of chance alone. NaN if halves have less than two samples; 1 for constant chains.
fn split_r_hat(chains: &[Vec<f64>]) -> f64 {
    let halves = chains.iter().flat_map(|chain| {
        let half = chain.len() / 2;
        [&chain[..half], &chain[chain.len() - half..]]
    });
    let halves: Vec<&[f64]> = halves.collect();
    let length = halves.first().map_or(0, |half| half.len());
    if length < 2 {
        return f64::NAN;
    }
    let variance = |values: &[f64]| {
        let mean = mean_of(values);
        let sum: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
        sum / (values.len() as f64 - 1.0)
    };
    let means: Vec<f64> = halves.iter().map(|half| mean_of(half)).collect();
    let within = mean_of(&halves.iter().map(|half| variance(half)).collect::<Vec<_>>());
    let between = variance(&means);
    match within + between == 0.0 {
        true => 1.0,
        false => (1.0 - 1.0 / length as f64 + between / within).sqrt(),
    }
}

fn mean_of(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// A posterior distribution, from a chain that has converged.
#[derive(Clone, Debug, PartialEq)]
pub struct Posterior {
    /// State of each parameter's chains.
    pub diagnoses: Vec<Diagnosis>,
    /// Mean of each parameter.
    pub mean: Vec<f64>,
    /// Covariance, row by row.
    pub covariance: Vec<Vec<f64>>,
    /// Samples of each parameter in the order in which they were drawn: step by step, walker by
    /// walker.
    pub samples: Vec<Vec<f64>>,
    ascending: Vec<Vec<f64>>,
}

impl Posterior {
    /// The value below which a share of a parameter's samples lies, interpolated linearly; NaN for
    /// a parameter that does not exist.
    pub fn quantile(&self, parameter: usize, share: f64) -> f64 {
        let Some(sorted) = self.ascending.get(parameter) else {
            return f64::NAN;
        };
        let last = sorted.len().saturating_sub(1);
        let place = share.clamp(0.0, 1.0) * last as f64;
        let below = place.floor() as usize;
        let (Some(low), Some(high)) = (sorted.get(below), sorted.get((below + 1).min(last))) else {
            return f64::NAN;
        };
        low + (place - below as f64) * (high - low)
    }

    /// The interval that holds a share and leaves equal shares on both sides.
    pub fn interval(&self, parameter: usize, share: f64) -> [f64; 2] {
        let outside = 0.5 * (1.0 - share);
        [outside, 1.0 - outside].map(|share| self.quantile(parameter, share))
    }

    /// Standard deviation of a parameter.
    pub fn sd(&self, parameter: usize) -> f64 {
        self.covariance[parameter][parameter].sqrt()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]
#[path = "tests/lead.rs"]
mod tests;
