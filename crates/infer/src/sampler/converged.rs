//! Whether a chain may be believed.

use super::{Autocorrelation, Chain, SamplingError, autocorrelation_time};
use std::fmt;

/// What a chain must reach before quantiles are taken from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Requirements {
    /// Kept length of a walker's chain in autocorrelation times.
    pub times: f64,
    /// Largest split R̂.
    pub r_hat: f64,
    /// Least effective number of samples.
    pub effective: f64,
}

impl Default for Requirements {
    /// 50 autocorrelation times, so that these themselves are known to some
    /// ten percent; R̂ of 1.02, which walkers of that length just reach; 1000
    /// effective samples, which place a 95 % limit to a tenth of σ.
    fn default() -> Self {
        Self {
            times: 50.0,
            r_hat: 1.02,
            effective: 1000.0,
        }
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
    /// Steps looked at.
    pub steps: u64,
}

/// Which requirement a parameter misses, and the steps that would do.
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
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct Unconverged {
    /// Steps so far.
    pub steps: u64,
    /// Everything that is missing.
    pub shortfalls: Vec<Shortfall>,
}

impl Unconverged {
    /// Steps after which all requirements should be met.
    #[must_use]
    pub fn more_steps(&self) -> u64 {
        let steps = self.shortfalls.iter().map(|s| s.more_steps);
        steps.max().unwrap_or(0)
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

/// Chains of fewer steps do not tell how many are needed.
const TOO_SHORT: f64 = 100.0;

impl Chain {
    /// State of each parameter's chains.
    ///
    /// # Errors
    /// A chain that was damaged on disk.
    pub fn diagnose(&self) -> Result<Vec<Diagnosis>, SamplingError> {
        self.sound()?;
        Ok((0..self.names().len()).map(|k| self.diagnosed(k)).collect())
    }

    fn diagnosed(&self, parameter: usize) -> Diagnosis {
        let chains = self.settled(parameter);
        let kept = autocorrelation_time(&chains);
        let every = self.keep_every() as f64;
        let length = chains.first().map_or(0, Vec::len);
        Diagnosis {
            time: Autocorrelation {
                time: kept.time * every,
                ..kept
            },
            r_hat: split_r_hat(&chains),
            effective: (length * chains.len()) as f64 / kept.time.max(1.0),
            steps: length as u64 * self.keep_every(),
        }
    }

    /// Each walker's kept places of a parameter without the first fifth.
    pub(super) fn settled(&self, parameter: usize) -> Vec<Vec<f64>> {
        let skipped = (self.steps() / self.keep_every()).div_ceil(5) as usize;
        let walker = |walker| self.trace(walker, parameter).skip(skipped).collect();
        (0..self.walkers()).map(walker).collect()
    }

    /// What is missing for a posterior.
    ///
    /// # Errors
    /// All shortfalls, with the steps that should mend them.
    pub fn converged(&self, asked: &Requirements) -> Result<Vec<Diagnosis>, Unconverged> {
        let damaged = |error: SamplingError| Unconverged {
            steps: self.steps(),
            shortfalls: vec![Shortfall {
                name: "all".into(),
                reason: error.to_string(),
                more_steps: 0,
            }],
        };
        let all = self.diagnose().map_err(damaged)?;
        let named = self.names().iter().zip(&all);
        let shortfalls: Vec<Shortfall> = named
            .flat_map(|(name, found)| self.shortfalls(name, found, asked))
            .collect();
        if shortfalls.is_empty() {
            return Ok(all);
        }
        Err(Unconverged {
            steps: self.steps(),
            shortfalls,
        })
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
            missing.push(Shortfall {
                name: name.to_owned(),
                reason,
                more_steps: (needed as u64).saturating_sub(self.steps()).max(1),
            });
        };
        if !found.time.resolved {
            let reason = format!(
                "steps are still correlated over half of the chain (autocorrelation time above {:.0})",
                found.time.time
            );
            miss(reason, 4.0);
        } else if times < asked.times {
            let reason = format!(
                "{times:.0} autocorrelation times long, {:.0} are needed",
                asked.times
            );
            miss(reason, asked.times / times);
        }
        if found.r_hat.is_nan() || found.r_hat > asked.r_hat {
            let reason = format!(
                "split R-hat {:.3}, at most {:.3} is allowed",
                found.r_hat, asked.r_hat
            );
            miss(reason, excess(found.r_hat) / excess(asked.r_hat));
        }
        if found.effective < asked.effective {
            let reason = format!(
                "{:.0} effective samples, {:.0} are needed",
                found.effective, asked.effective
            );
            miss(reason, asked.effective / found.effective.max(1.0));
        }
        missing
    }
}

/// R̂ of chains cut in halves: √(1 − 1/n + B/W), with W the mean variance within
/// a half and B the variance of their means [GelmanRubin1992]. Walkers n
/// steps long and correlated over τ have about √(1 + τ/n) of chance alone. NaN
/// if halves have less than two samples; 1 for constant chains.
#[must_use]
pub fn split_r_hat(chains: &[Vec<f64>]) -> f64 {
    let halves: Vec<&[f64]> = (chains.iter())
        .flat_map(|chain| {
            let half = chain.len() / 2;
            [&chain[..half], &chain[chain.len() - half..]]
        })
        .collect();
    let length = halves.first().map_or(0, |half| half.len());
    if length < 2 {
        return f64::NAN;
    }
    let means: Vec<f64> = halves.iter().map(|half| mean(half)).collect();
    let within = mean(&halves.iter().map(|half| variance(half)).collect::<Vec<_>>());
    let between = variance(&means);
    if within + between == 0.0 {
        return 1.0;
    }
    (1.0 - 1.0 / length as f64 + between / within).sqrt()
}

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn variance(values: &[f64]) -> f64 {
    let mean = mean(values);
    let sum: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
    sum / (values.len() as f64 - 1.0)
}
