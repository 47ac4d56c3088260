//! Why samples cannot be measured and points cannot be fitted.

use crate::signal::find::PulseKind;

/// Why samples, points or options cannot be used.
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
        /// Its number, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// All samples are equal.
    #[error("all samples equal {0}: nothing was recorded; is the channel connected?")]
    Constant(f64),
    /// The largest swing over the noise is too small, both after averaging over four samples.
    #[error("no pulse: the largest swing is {0:.1} times the noise, 6 are needed")]
    NoPulse(f64),
    /// Columns or channels of different lengths.
    #[error("{0}")]
    Lengths(String),
    /// An option is out of its range.
    #[error("{name} is {value}: expected {expected}")]
    Option {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is accepted.
        expected: &'static str,
    },
    /// A pulse that the computation needs was not found.
    #[error("the {0} pulse was not found")]
    Missing(PulseKind),
    /// The method found no maximum, or no crossing, where the pulse is.
    #[error("the {0} pulse has no {1} where it was looked for")]
    NoPick(PulseKind, &'static str),
    /// Fewer than two different abscissas.
    #[error("a power law needs at least two different abscissas")]
    TooFew,
    /// A point, counted from 0, that has no logarithm.
    #[error("point {index} is not positive and finite")]
    NotPositive {
        /// Its number, from 0.
        index: usize,
    },
}

impl SignalError {
    /// An error unless an option is `accepted`.
    pub(crate) fn require(
        accepted: bool,
        name: &'static str,
        value: f64,
        expected: &'static str,
    ) -> Result<(), Self> {
        let error = Self::Option {
            name,
            value,
            expected,
        };
        accepted.then_some(()).ok_or(error)
    }

    pub(crate) fn positive(name: &'static str, value: f64) -> Result<(), Self> {
        let accepted = value > 0.0 && value.is_finite();
        Self::require(accepted, name, value, "a positive, finite number")
    }

    pub(crate) fn enough(found: usize, needed: usize) -> Result<(), Self> {
        let error = Self::TooShort { found, needed };
        (found >= needed).then_some(()).ok_or(error)
    }
}

/// Rejects samples that are not finite numbers or whose squares, summed, would overflow.
pub(crate) fn all_finite(samples: &[f64]) -> Result<(), SignalError> {
    let bad = samples.iter().position(|x| x.is_nan() || x.abs() >= 1e140);
    bad.map_or(Ok(()), |index| {
        let value = samples[index];
        Err(SignalError::NotFinite { index, value })
    })
}
