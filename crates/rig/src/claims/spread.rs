//! How sure spreads are.
//!
//! Shots of one series hang together: what one leaves, the next finds. Series
//! do not, as each begins with a chain that is laid anew. So whole series are
//! drawn with replacement [Efron1979], and the standard deviation over draws
//! is the standard error.

use super::evidence::mean;
use crate::chance::{Chance, Purpose};

/// Sets of series that are drawn.
const DRAWS: usize = 1000;

/// Seed of the draws.
const SEED: u64 = 1;

/// 95 % of a normal distribution are within so many standard errors.
pub const SURE: f64 = 1.96;

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
pub fn deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    let square: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    (square / (values.len() as f64 - 1.0)).sqrt()
}

/// Mean of what shots have, with its error.
#[must_use]
pub fn mean_of(values: &[f64]) -> Estimate {
    Estimate {
        value: mean(values),
        error: SURE * deviation(values) / (values.len() as f64).sqrt(),
    }
}

/// ln of the geometric mean of a number that every series has, with its error.
///
/// One series alone tells no error: not a number then.
#[must_use]
pub fn typical(of_series: &[f64]) -> Estimate {
    let logs: Vec<f64> = of_series.iter().map(|v| v.ln()).collect();
    let mut chance = Chance::new(SEED, 0, Purpose::Resampling);
    let mut drawn = || {
        let any = |_| logs[(chance.uniform() * logs.len() as f64) as usize];
        mean(&logs.iter().map(any).collect::<Vec<f64>>())
    };
    let draws: Vec<f64> = (0..DRAWS).map(|_| drawn()).collect();
    let alone = logs.len() < 2;
    Estimate {
        value: mean(&logs),
        error: if alone {
            f64::NAN
        } else {
            SURE * deviation(&draws)
        },
    }
}
