//! How many steps a chain takes to forget.

use hertzchain_sim::stopped;

/// Integrated autocorrelation time of several chains together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Autocorrelation {
    /// τ = 1 + 2 Σ ρ(t), in kept steps: so many count as one independent.
    pub time: f64,
    /// Whether the window of the sum fitted into the chains; a τ that does not
    /// is too small.
    pub resolved: bool,
}

/// Width of the window in units of τ: [Sokal1997] has about 4 to 10 for
/// correlations that fall exponentially.
const WINDOW: f64 = 5.0;

/// τ by Sokal's automatic window, from autocovariances about the mean of all
/// chains and averaged over these: walkers at different places lengthen it,
/// as they should. Chains must have equal lengths. 1 for constant chains. Whoever
/// is asked to stop leaves it unresolved.
#[must_use]
pub fn autocorrelation_time(chains: &[Vec<f64>]) -> Autocorrelation {
    let length = chains.iter().map(Vec::len).min().unwrap_or(0);
    let count = (length * chains.len()) as f64;
    let mean = chains.iter().flatten().sum::<f64>() / count;
    let covariance = |lag: usize| {
        let products = chains.iter().map(|chain| {
            let later = chain.iter().skip(lag);
            let pairs = chain.iter().zip(later);
            pairs.map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>()
        });
        products.sum::<f64>() / ((length - lag) as f64 * chains.len() as f64)
    };
    let still = Autocorrelation {
        time: 1.0,
        resolved: length > 1,
    };
    if length < 2 {
        return still;
    }
    let variance = covariance(0);
    if variance <= 0.0 {
        return still;
    }
    let mut time = 1.0;
    // Of long chains every lag takes a millisecond, and there may be thousands.
    for lag in (1..length / 2).take_while(|_| !stopped()) {
        time += 2.0 * covariance(lag) / variance;
        if lag as f64 >= WINDOW * time {
            let resolved = true;
            return Autocorrelation {
                time: f64::max(time, 0.1),
                resolved,
            };
        }
    }
    Autocorrelation {
        time,
        resolved: false,
    }
}
