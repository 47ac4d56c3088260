//! How sure spreads are.
//!
//! Shots of one series hang together: what one leaves, the next finds. Series
//! do not, as each begins with a chain that is laid anew. So whole series are
//! drawn with replacement [Efron1979], and the standard deviation over draws
//! is the standard error.

use super::evidence::mean;
use hertzchain_sim::rig::{Purpose, RandomStream};

/// Sets of series that are drawn.
const DRAWS: usize = 1000;

/// Seed of the draws.
const SEED: u64 = 1;

/// 95 % of a normal distribution are within so many standard errors.
pub(super) const SURE: f64 = 1.96;

/// A number with the error that 95 % stay within.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Half of its 95 % interval.
    pub error: f64,
}

/// Standard deviation, with n − 1; not a number of fewer than two values.
#[must_use]
pub(super) fn deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    let square: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    // 0/0 of one value and of none.
    (square / values.len().saturating_sub(1) as f64).sqrt()
}

/// Mean of what shots have, with its error.
#[must_use]
pub(super) fn mean_of(values: &[f64]) -> Estimate {
    Estimate {
        value: mean(values),
        error: SURE * deviation(values) / (values.len() as f64).sqrt(),
    }
}

/// ln of the geometric mean of a number that series have, with its error. Series
/// whose number is none, having no pulses, count for nothing.
#[must_use]
pub fn typical(of_series: &[f64]) -> Estimate {
    let logs = of_series.iter().map(|v| v.ln());
    let logs: Vec<f64> = logs.filter(|log| log.is_finite()).collect();
    bootstrap(&logs, mean)
}

/// ln of the root mean square of a number that series have, with its error, and
/// not below that of `least`: for numbers that may all be 0.
#[must_use]
pub fn root_mean_square(of_series: &[f64], least: f64) -> Estimate {
    bootstrap(of_series, |drawn| {
        let squares: Vec<f64> = drawn.iter().map(|v| v * v).collect();
        mean(&squares).sqrt().max(least).ln()
    })
}

/// One series alone has no error: it is not a number then.
fn bootstrap(of_series: &[f64], statistic: impl Fn(&[f64]) -> f64) -> Estimate {
    let mut chance = RandomStream::new(SEED, 0, Purpose::Resampling);
    let mut drawn = || {
        let any = |_| of_series[(chance.uniform() * of_series.len() as f64) as usize];
        statistic(&of_series.iter().enumerate().map(any).collect::<Vec<f64>>())
    };
    let draws: Vec<f64> = (0..DRAWS).map(|_| drawn()).collect();
    let alone = of_series.len() < 2;
    Estimate {
        value: statistic(of_series),
        error: if alone {
            f64::NAN
        } else {
            SURE * deviation(&draws)
        },
    }
}
