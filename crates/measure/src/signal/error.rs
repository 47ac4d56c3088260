//! Why samples cannot be measured.

use crate::signal::find::Place;

/// Why a slice of samples, or what was asked of it, cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SignalError {
    /// Fewer samples than the computation needs.
    #[error("{found} samples are too few: at least {needed} are needed")]
    TooShort {
        /// Number of samples.
        found: usize,
        /// Least number.
        needed: usize,
    },
    /// A sample is not a number, infinite, or so large that its square overflows.
    #[error(
        "sample {index} is {value}: not a finite number of sensible size; cut the record before it, or repair it"
    )]
    NotFinite {
        /// Which sample, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// All samples are equal.
    #[error("all samples equal {value}: nothing was recorded; is the channel connected?")]
    Constant {
        /// The value.
        value: f64,
    },
    /// Nothing rises out of the noise.
    #[error("no pulse: the largest swing is {swing_to_noise:.1} times the noise, 6 are needed")]
    NoPulse {
        /// Largest swing over noise, both after averaging over four samples.
        swing_to_noise: f64,
    },
    /// Two channels of different lengths.
    #[error(
        "the sensor's channel has {sensor} samples and the wall's {wall}: they must be recorded together"
    )]
    Lengths {
        /// Samples of the sensor's channel.
        sensor: usize,
        /// Samples of the wall's channel.
        wall: usize,
    },
    /// A number that was asked for is out of its range.
    #[error("{name} is {value}: expected {expected}")]
    Option {
        /// What it is.
        name: &'static str,
        /// What it was.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// A pulse that the computation needs was not found.
    #[error("the {place} pulse was not found")]
    Missing {
        /// Which.
        place: Place,
    },
    /// The method found no maximum, or no crossing, where the pulse is.
    #[error("the {place} pulse has no {what} where it was looked for")]
    NoPick {
        /// Which pulse.
        place: Place,
        /// What was looked for.
        what: &'static str,
    },
}

impl SignalError {
    pub(crate) fn positive(name: &'static str, value: f64) -> Result<(), Self> {
        let expected = "a positive, finite number";
        let good = value > 0.0 && value.is_finite();
        good.then_some(()).ok_or(Self::Option {
            name,
            value,
            expected,
        })
    }

    pub(crate) fn enough(found: usize, needed: usize) -> Result<(), Self> {
        (found >= needed)
            .then_some(())
            .ok_or(Self::TooShort { found, needed })
    }
}

/// Squares of larger numbers, summed, overflow.
const LARGEST: f64 = 1e140;

/// Refuses samples that are not finite numbers of sensible size.
pub(crate) fn all_finite(samples: &[f64]) -> Result<(), SignalError> {
    let bad = samples.iter().position(|x| !sensible(*x));
    match bad {
        Some(index) => Err(SignalError::NotFinite {
            index,
            value: samples[index],
        }),
        None => Ok(()),
    }
}

fn sensible(x: f64) -> bool {
    x.abs() < LARGEST
}
