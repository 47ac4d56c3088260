//! What a finder is told.

use crate::signal::Rails;
use crate::signal::error::SignalError;

/// How sensor bead and wall were recorded.
#[derive(Clone, Copy, Debug)]
pub enum Channels<'a> {
    /// Both in one channel, of the same polarity: passing, wall, returning.
    Summed(&'a [f64]),
    /// One channel each, sampled together.
    Separate {
        /// The sensor bead's.
        sensor: &'a [f64],
        /// The wall's.
        wall: &'a [f64],
    },
}

/// Which way pulses point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Polarity {
    /// Where the larger swing from the baseline is.
    #[default]
    Auto,
    /// Up.
    Positive,
    /// Down.
    Negative,
}

/// What may be known of a record before pulses are looked for; nothing need be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Finding {
    /// Of the sensor's, or of the summed channel.
    pub polarity: Polarity,
    /// Of the wall's channel, if it has one.
    pub wall_polarity: Polarity,
    /// Number N of beads and the sensor bead's number n, 1 ≤ n < N: they bound
    /// when the wall's and the returning pulse can come.
    pub beads: Option<(usize, usize)>,
    /// The digitiser's range in the sensor's, or in the summed channel; without it, long runs at
    /// a record's extremes count as saturated.
    pub rails: Option<Rails>,
    /// The same in the wall's channel, if it has one.
    pub wall_rails: Option<Rails>,
}

impl Finding {
    /// Ranges of the channels that hold the sensor's and the wall's pulses.
    #[must_use]
    pub fn rails_of(&self, channels: Channels<'_>) -> [Option<Rails>; 2] {
        match channels {
            Channels::Summed(_) => [self.rails; 2],
            Channels::Separate { .. } => [self.rails, self.wall_rails],
        }
    }

    pub(crate) fn check(&self) -> Result<(), SignalError> {
        let Some((beads, sensor)) = self.beads else {
            return Ok(());
        };
        let good = (1..beads).contains(&sensor);
        good.then_some(()).ok_or(SignalError::Option {
            name: "number of the sensor bead",
            value: sensor as f64,
            expected: "1 or more, and less than the number of beads",
        })
    }
}

impl<'a> Channels<'a> {
    /// The samples that hold a sensor's pulses.
    #[must_use]
    pub fn sensor(&self) -> &'a [f64] {
        match self {
            Self::Summed(samples)
            | Self::Separate {
                sensor: samples, ..
            } => samples,
        }
    }

    /// The samples that hold the wall's pulse.
    #[must_use]
    pub fn wall(&self) -> &'a [f64] {
        match self {
            Self::Summed(samples) | Self::Separate { wall: samples, .. } => samples,
        }
    }
}
