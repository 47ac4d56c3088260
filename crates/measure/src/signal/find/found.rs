//! What a finder found, and what it doubts.

use std::fmt;

use crate::signal::{Estimate, Level};

/// Steps of the digitiser below which a pulse without noise is coarse.
const COARSE: f64 = 32.0;

/// One of the three pulses of a shot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Place {
    /// At the sensor bead, on the way in.
    Passing,
    /// At the wall.
    Wall,
    /// At the sensor bead, on the way back.
    Returning,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Passing => "passing",
            Self::Wall => "wall",
            Self::Returning => "returning",
        })
    }
}

/// What is doubtful about a record or its pulses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Doubt {
    /// A pulse stands on an end of the digitiser's range.
    Saturation(Place),
    /// A pulse was not found.
    Missing(Place),
    /// Another maximum of at least a quarter of its height stands near a pulse.
    Split(Place),
    /// Noise leaves open which of a pulse's maxima is the largest.
    Alike(Place),
    /// A pulse in a summed channel falls much more slowly than it rises.
    Trailing(Place),
    /// Between two pulses the signal does not fall to a tenth of the lower one.
    Overlap(Place, Place),
    /// A pulse is less than ten times as high as the noise.
    LowSignal(Place),
    /// The record begins or ends within a pulse, or before the returning pulse was due.
    RecordTooShort,
    /// Pulses may have been taken for one another.
    Order,
    /// One of the three pulses is lost, and it is not plain which: of those found the first may
    /// be the passing or the wall's.
    Lost,
    /// A pulse was found, but the method could not tell its time.
    NotPicked(Place),
    /// A pulse is few steps of the digitiser high, and no noise shakes them.
    CoarseSteps(Place),
    /// Fewer than five samples lie across a pulse's half maximum.
    FewSamples(Place),
    /// So many samples of spikes were replaced by what their neighbours say.
    Spikes(usize),
    /// Fewer than 32 samples before the first pulse: baseline and noise are rough.
    FewQuietSamples,
}

impl Doubt {
    /// Whether times may be of something else than the wave: of a clipped or hardly
    /// sampled pulse, or of pulses taken for one another. Which of maxima alike is the largest the
    /// shots of a speed tell together.
    #[must_use]
    pub fn is_grave(&self) -> bool {
        matches!(
            self,
            Self::Saturation(_) | Self::Order | Self::Lost | Self::FewSamples(_)
        )
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Saturation(place) => write!(f, "{place} pulse saturated"),
            Self::Missing(place) => write!(f, "{place} pulse missing"),
            Self::Split(place) => write!(f, "{place} pulse split"),
            Self::Alike(place) => write!(f, "{place} pulse of maxima alike but for noise"),
            Self::Trailing(place) => write!(f, "{place} pulse trails"),
            Self::Overlap(one, other) => write!(f, "{one} and {other} pulse overlap"),
            Self::LowSignal(place) => write!(f, "{place} pulse low"),
            Self::RecordTooShort => f.write_str("record too short"),
            Self::Order => f.write_str("order of pulses doubtful"),
            Self::Lost => f.write_str("one pulse missing, perhaps the passing one"),
            Self::NotPicked(place) => write!(f, "{place} pulse not picked"),
            Self::CoarseSteps(place) => write!(f, "{place} pulse in coarse steps"),
            Self::FewSamples(place) => write!(f, "{place} pulse of few samples"),
            Self::Spikes(1) => f.write_str("1 sample of a spike replaced"),
            Self::Spikes(samples) => write!(f, "{samples} samples of spikes replaced"),
            Self::FewQuietSamples => f.write_str("few quiet samples"),
        }
    }
}

/// A channel's offset, noise and direction: what turns its samples upright.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Upright {
    /// 1 when pulses point up, −1 when down.
    pub sign: f64,
    /// Offset and noise.
    pub level: Level,
    /// The digitiser's step: the least difference of neighbouring samples of pulses as recorded.
    pub step: f64,
}

impl Upright {
    /// A sample as height above the baseline, pulses up.
    #[must_use]
    pub fn height(&self, sample: f64) -> f64 {
        self.sign * (sample - self.level.offset)
    }

    /// Whether a height is few steps of the digitiser. Noise of half a step shakes
    /// samples over steps, and then rounding is noise too.
    pub(crate) fn is_coarse(&self, height: f64) -> bool {
        height < COARSE * self.step && self.level.noise < 0.5 * self.step
    }

    /// Standard deviation of rounding to the digitiser's steps in a pulse so high;
    /// all of half a step in coarse ones, where neighbours are rounded alike.
    pub(crate) fn rounding(&self, height: f64) -> f64 {
        match self.is_coarse(height) {
            true => 0.5 * self.step,
            false => self.step / 12.0_f64.sqrt(),
        }
    }
}

/// A pulse, roughly: good enough to know where to pick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    /// Which.
    pub place: Place,
    /// Sample of its largest maximum, from 0.
    pub at: usize,
    /// Height of that above the baseline, in the samples' unit.
    pub height: f64,
    /// Full width at half maximum about it, in samples.
    pub width_samples: f64,
    /// Parts of that before and after the maximum.
    pub sides_samples: (f64, f64),
    /// First and last sample above a tenth of the height.
    pub extent: (usize, usize),
    /// First and last sample of its top that stand on an end of the digitiser's range: what
    /// lies between is not known.
    pub clipped: Option<(usize, usize)>,
}

/// From so many times as slow a fall as rise on, at half the height, a pulse trails: those of
/// dry chains have 0.9 to 1.2.
const TRAILS: f64 = 2.0;
/// From so many times on it begins to.
const BEGINS: f64 = 1.2;

impl Pulse {
    /// Whether it falls so much more slowly than it rises that its top is flat.
    #[must_use]
    pub fn trails(&self) -> bool {
        self.sides_samples.1 > TRAILS * self.sides_samples.0
    }

    /// How near it comes to that: 0 for a fall like those of dry chains, 1 for one that trails.
    pub(crate) fn trailing(&self) -> f64 {
        let (rise, fall) = self.sides_samples;
        ((fall / rise - BEGINS) / (TRAILS - BEGINS)).clamp(0.0, 1.0)
    }

    /// The same with so many samples on either side of a clipped top counted as clipped, too.
    pub(crate) fn with_clipped_spread(&self, samples: usize) -> Self {
        let spread =
            |(first, last): (usize, usize)| (first.saturating_sub(samples), last + samples);
        Self {
            clipped: self.clipped.map(spread),
            ..*self
        }
    }

    /// Whether a sample is clipped, or next to one that is: recorders round the corner.
    pub(crate) fn is_clipped(&self, sample: usize) -> bool {
        self.clipped
            .is_some_and(|(first, last)| sample + 1 >= first && sample <= last + 1)
    }

    /// Twice the shorter side: the width of a bell as steep as the steeper flank.
    /// What a pulse trails behind does not widen it.
    #[must_use]
    pub fn steep_width_samples(&self) -> f64 {
        2.0 * self.sides_samples.0.min(self.sides_samples.1)
    }
}

/// Another maximum of a pulse, the highest but the largest: noise may have made it the lower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rival {
    /// The maximum, with the pulse about it; its place is that of the pulse.
    pub pulse: Pulse,
    /// How much lower it is than the largest, in the samples' unit, by fits to the samples about both.
    pub lower: Estimate,
}

/// The pulses of a shot.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// At the sensor bead, on the way in.
    pub passing: Option<Pulse>,
    /// At the wall.
    pub wall: Option<Pulse>,
    /// At the sensor bead, on the way back.
    pub returning: Option<Pulse>,
    /// Other maxima of these that are nearly as high, at most one a pulse.
    pub rivals: Vec<Rival>,
    /// What is doubtful; empty for a clean record. In order, none twice.
    pub doubts: Vec<Doubt>,
    /// The sensor's, or the summed, channel.
    pub sensor: Upright,
    /// The wall's channel; the same as the sensor's if both are summed.
    pub wall_channel: Upright,
}

impl Found {
    /// The pulses found, in order.
    pub fn pulses(&self) -> impl Iterator<Item = &Pulse> {
        [&self.passing, &self.wall, &self.returning]
            .into_iter()
            .flatten()
    }

    /// Counts so many samples on either side of clipped tops as clipped: a filter has
    /// spread them.
    pub(crate) fn spread_clipped(&mut self, samples: usize) {
        let pulses = [&mut self.passing, &mut self.wall, &mut self.returning];
        for pulse in pulses.into_iter().flatten() {
            *pulse = pulse.with_clipped_spread(samples);
        }
    }

    pub(super) fn slot(&mut self, place: Place) -> &mut Option<Pulse> {
        match place {
            Place::Passing => &mut self.passing,
            Place::Wall => &mut self.wall,
            Place::Returning => &mut self.returning,
        }
    }

    /// Adds doubts, kept in order and none twice.
    pub(crate) fn doubt(&mut self, more: Vec<Doubt>) {
        self.doubts.extend(more);
        self.doubts.sort_unstable();
        self.doubts.dedup();
    }

    /// What turns the channel of this pulse upright.
    #[must_use]
    pub fn upright(&self, place: Place) -> &Upright {
        match place {
            Place::Wall => &self.wall_channel,
            Place::Passing | Place::Returning => &self.sensor,
        }
    }
}
