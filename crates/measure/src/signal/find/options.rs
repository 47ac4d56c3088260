//! What is known of a record before its pulses are searched for.

use crate::error::{MeasureError, Result};

/// Samples of a shot: how sensor bead and wall were recorded.
#[derive(Clone, Copy, Debug)]
pub enum Channels<'a> {
    /// Both in one channel, of the same polarity: incident, wall, reflected.
    Summed(&'a [f64]),
    /// One channel each, sampled together.
    Separate {
        /// The sensor bead's.
        sensor: &'a [f64],
        /// The wall's.
        wall: &'a [f64],
    },
}

impl<'a> Channels<'a> {
    /// Samples that hold the sensor's pulses, and those that hold the wall's.
    pub(crate) fn both(&self) -> [&'a [f64]; 2] {
        match self {
            Self::Summed(samples) => [samples; 2],
            Self::Separate { sensor, wall } => [sensor, wall],
        }
    }

    pub(crate) fn of(&self, kind: super::PulseKind) -> &'a [f64] {
        self.both()[usize::from(kind == super::PulseKind::Wall)]
    }

    pub(crate) fn is_summed(&self) -> bool {
        matches!(self, Self::Summed(_))
    }
}

/// Direction of pulses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Polarity {
    /// That of the larger swing from the baseline.
    #[default]
    Auto,
    /// Up.
    Positive,
    /// Down.
    Negative,
}

/// The two ends of a digitiser's range, in the samples' unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DigitiserRange {
    /// Least number that can be recorded.
    pub low: f64,
    /// Largest number that can be recorded.
    pub high: f64,
}

impl DigitiserRange {
    /// Whether a sample is at an end of the range or beyond, to 10⁻⁹ of the range: converting
    /// digits to volts rounds.
    pub(crate) fn clips(&self, sample: f64) -> bool {
        let range = self.high - self.low;
        let rounding = if range.is_finite() { 1e-9 * range } else { 0.0 };
        sample <= self.low + rounding || sample >= self.high - rounding
    }

    /// Whether at least `shortest` samples in a row are at an end of the range.
    ///
    /// Of an unknown digitiser give the record's own extremes and a `shortest` that no round top
    /// reaches: a bell of width w (full width at half maximum, in samples) and H steps high has
    /// some 0.9 w/√H equal samples.
    pub(crate) fn clips_run(&self, samples: &[f64], shortest: usize) -> bool {
        let mut runs = samples.chunk_by(|a, b| self.clips(*a) == self.clips(*b));
        runs.any(|run| run.len() >= shortest && self.clips(run[0]))
    }
}

/// Widths and heights of pulses that distinguish them. Defaults hold for compact rows of
/// equal Hertz beads, dry and wet, between 0.06 and 2.4 m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulseLimits {
    /// Beads a wave passes while a sensor bead sees half its maximum or more: 2.07, as computed
    /// waves pass 33 beads in 16 such times.
    pub width_beads: f64,
    /// Least height of the wall's pulse over the incident one's: 0.42, where computed rows have 0.48
    /// (weak shots in gear oil) to 1.9 (dry).
    pub wall_over_incident_min: f64,
    /// Largest height of the reflected pulse over the incident one's: 0.7, where computed rows have
    /// up to 0.67.
    pub reflected_over_incident_max: f64,
    /// Least height of the reflected pulse over the wall's: 0.15, where computed rows have 0.20 to
    /// 0.35.
    pub reflected_over_wall_min: f64,
}

impl Default for PulseLimits {
    fn default() -> Self {
        Self {
            width_beads: 2.07,
            wall_over_incident_min: 0.42,
            reflected_over_incident_max: 0.7,
            reflected_over_wall_min: 0.15,
        }
    }
}

impl PulseLimits {
    /// Limits for contacts whose force grows as overlap^`exponent`, 3/2 for Hertz: the default
    /// width, scaled as that of the solitary wave in the long-wave limit, whose force is
    /// cos^(2n/(n−1))((n−1) √(6/(n(n+1))) x) at x beads from its maximum \[Nesterenko1983\].
    pub fn for_exponent(exponent: f64) -> Self {
        let half_width = |n: f64| {
            let angle = 0.5_f64.powf((n - 1.0) / (2.0 * n)).acos();
            angle / ((n - 1.0) * (6.0 / (n * (n + 1.0))).sqrt())
        };
        let default = Self::default();
        Self {
            width_beads: default.width_beads * (half_width(exponent) / half_width(1.5)),
            ..default
        }
    }
}

/// What is known of a record before its pulses are searched for; nothing need be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FindOptions {
    /// Polarity of the sensor's, or of the summed channel.
    pub polarity: Polarity,
    /// Polarity of the wall's channel, if it has one.
    pub wall_polarity: Polarity,
    /// Number N of beads and the sensor bead's number n, 1 ≤ n < N: they bound
    /// when the wall's and the reflected pulse can come.
    pub beads: Option<(usize, usize)>,
    /// Widths and heights of the row's pulses.
    pub limits: PulseLimits,
    /// The digitiser's range in the sensor's, or in the summed channel; without it, long runs at
    /// a record's extremes count as saturated.
    pub range: Option<DigitiserRange>,
    /// The same in the wall's channel, if it has one.
    pub wall_range: Option<DigitiserRange>,
}

impl FindOptions {
    /// Ranges of the channels that hold the sensor's and the wall's pulses.
    pub(crate) fn ranges(&self, channels: Channels<'_>) -> [Option<DigitiserRange>; 2] {
        match channels {
            Channels::Summed(_) => [self.range; 2],
            Channels::Separate { .. } => [self.range, self.wall_range],
        }
    }

    pub(super) fn check(&self) -> Result<()> {
        MeasureError::positive("width of a pulse in beads", self.limits.width_beads)?;
        let Some((beads, sensor)) = self.beads else {
            return Ok(());
        };
        MeasureError::require(
            (1..beads).contains(&sensor),
            "number of the sensor bead",
            sensor as f64,
            "1 or more, and less than the number of beads",
        )
    }
}

#[cfg(test)]
#[path = "../tests/saturation.rs"]
mod tests;
