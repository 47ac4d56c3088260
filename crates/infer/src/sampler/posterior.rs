//! What a converged chain says.

use super::converged::mean;
use super::{Chain, Diagnosis, Requirements, Unconverged};
use hertzchain_sim::stopped;

/// A posterior distribution, from a chain that has converged.
#[derive(Clone, Debug, PartialEq)]
pub struct Posterior {
    /// State of each parameter's chains.
    pub diagnoses: Vec<Diagnosis>,
    /// Mean of each parameter.
    pub mean: Vec<f64>,
    /// Covariance, row by row.
    pub covariance: Vec<Vec<f64>>,
    /// Samples of each parameter in the order in which they were drawn: step by
    /// step, walker by walker.
    pub samples: Vec<Vec<f64>>,
    /// The same, ascending.
    ascending: Vec<Vec<f64>>,
}

impl Chain {
    /// The posterior, if the chain meets the requirements.
    ///
    /// # Errors
    /// Everything that is missing, and how many more steps should do.
    pub fn posterior(&self, asked: &Requirements) -> Result<Posterior, Unconverged> {
        let diagnoses = self.converged(asked)?;
        let samples: Vec<Vec<f64>> = (0..self.names().len())
            .map(|parameter| by_step(&self.settled(parameter)))
            .collect();
        let mean: Vec<f64> = samples.iter().map(|s| mean(s)).collect();
        let entry = |i: usize, j: usize| {
            let pairs = samples[i].iter().zip(&samples[j]);
            let products = pairs.map(|(a, b)| (a - mean[i]) * (b - mean[j]));
            products.sum::<f64>() / (samples[i].len() as f64 - 1.0)
        };
        let all = 0..mean.len();
        let row = |i: usize| all.clone().map(|j| entry(i, j)).collect();
        Ok(Posterior {
            covariance: all.clone().map(row).collect(),
            ascending: samples.iter().map(|s| ascending(s)).collect(),
            diagnoses,
            mean,
            samples,
        })
    }
}

fn by_step(chains: &[Vec<f64>]) -> Vec<f64> {
    let length = chains.first().map_or(0, Vec::len);
    let step = |i: usize| chains.iter().map(move |chain| chain[i]);
    (0..length).flat_map(step).collect()
}

/// In order, unless whoever asked wants no more: a million samples take their time.
fn ascending(samples: &[f64]) -> Vec<f64> {
    let mut sorted = samples.to_vec();
    if !stopped() {
        sorted.sort_unstable_by(f64::total_cmp);
    }
    sorted
}

impl Posterior {
    /// The value below which a share of a parameter's samples lies, straight
    /// between neighbouring ones; NaN for a parameter that there is not.
    #[must_use]
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
    #[must_use]
    pub fn interval(&self, parameter: usize, share: f64) -> [f64; 2] {
        let outside = 0.5 * (1.0 - share);
        [outside, 1.0 - outside].map(|share| self.quantile(parameter, share))
    }

    /// Standard deviation of a parameter.
    #[must_use]
    pub fn sd(&self, parameter: usize) -> f64 {
        self.covariance[parameter][parameter].sqrt()
    }

    /// Standard error of a mean from a finite chain: σ/√(effective samples).
    #[must_use]
    pub fn mean_error(&self, parameter: usize) -> f64 {
        self.sd(parameter) / self.diagnoses[parameter].effective.sqrt()
    }
}
