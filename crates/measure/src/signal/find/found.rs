//! The pulses of a record, and quality flags about them.

use std::fmt;

use crate::signal::{Baseline, Estimate};

/// One of the three pulses of a shot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PulseKind {
    /// At the sensor bead, on the way to the wall.
    Incident,
    /// At the wall.
    Wall,
    /// At the sensor bead, on the way back.
    Reflected,
}

impl PulseKind {
    pub(crate) const ALL: [Self; 3] = [Self::Incident, Self::Wall, Self::Reflected];
}

impl fmt::Display for PulseKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(["incident", "wall", "reflected"][*self as usize])
    }
}

/// A quality flag of a record or a pulse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum QualityFlag {
    /// A pulse is clipped by the digitiser's range or an amplifier.
    Saturation(PulseKind),
    /// A pulse was not found.
    Missing(PulseKind),
    /// Another maximum of at least a quarter of its height is near a pulse.
    Split(PulseKind),
    /// Noise leaves open which of a pulse's maxima is the largest.
    AmbiguousMaximum(PulseKind),
    /// A pulse in a summed channel falls much more slowly than it rises.
    Asymmetric(PulseKind),
    /// Between two pulses the signal does not fall to a tenth of the lower one.
    Overlap(PulseKind, PulseKind),
    /// A pulse is less than ten times as high as the noise.
    LowSignal(PulseKind),
    /// The record begins or ends within a pulse, or before the reflected pulse was due.
    RecordTooShort,
    /// Pulses may have been taken for one another.
    Order,
    /// One of the three pulses is missing, and the first found may be the incident or the wall's.
    Unidentified,
    /// A pulse was found, but the method found no time for it.
    NotPicked(PulseKind),
    /// A pulse is few steps of the digitiser high, without noise to dither them.
    CoarseSteps(PulseKind),
    /// Fewer than five samples lie across a pulse's half maximum.
    FewSamples(PulseKind),
    /// Number of samples of spikes that were replaced by interpolation.
    Spikes(usize),
    /// The baseline drifts, as by hum, and was fitted around the pulses.
    Drift,
    /// Fewer than 32 samples before the first pulse: baseline and noise are rough.
    FewQuietSamples,
    /// The user picked the pulse's time.
    ByHand(PulseKind),
}

impl QualityFlag {
    /// Whether times may be of something else than the wave: of a clipped or hardly sampled pulse,
    /// or of pulses taken for one another.
    pub fn is_grave(&self) -> bool {
        matches!(self, Self::Saturation(_) | Self::Order | Self::Unidentified | Self::FewSamples(_))
    }

    /// The pulse whose shape or time it doubts.
    pub(crate) fn pulse(&self) -> Option<PulseKind> {
        match self {
            Self::Saturation(kind)
            | Self::Missing(kind)
            | Self::AmbiguousMaximum(kind)
            | Self::NotPicked(kind)
            | Self::FewSamples(kind)
            | Self::ByHand(kind) => Some(*kind),
            _ => None,
        }
    }

    /// A short code, without the pulse.
    pub(crate) fn code(&self) -> &'static str {
        match self {
            Self::Saturation(_) => "saturated",
            Self::Missing(_) => "missing",
            Self::Split(_) => "split",
            Self::AmbiguousMaximum(_) => "ambiguous",
            Self::Asymmetric(_) => "asymmetric",
            Self::Overlap(..) => "overlap",
            Self::LowSignal(_) => "low",
            Self::RecordTooShort => "short-record",
            Self::Order => "order",
            Self::Unidentified => "unidentified",
            Self::NotPicked(_) => "not-picked",
            Self::CoarseSteps(_) => "coarse-steps",
            Self::FewSamples(_) => "few-samples",
            Self::Spikes(_) => "spikes",
            Self::Drift => "drift",
            Self::FewQuietSamples => "few-quiet-samples",
            Self::ByHand(_) => "by-hand",
        }
    }
}

impl fmt::Display for QualityFlag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Saturation(kind) => write!(f, "{kind} pulse saturated"),
            Self::Missing(kind) => write!(f, "{kind} pulse missing"),
            Self::Split(kind) => write!(f, "{kind} pulse split"),
            Self::AmbiguousMaximum(kind) => write!(f, "{kind} pulse with ambiguous maximum"),
            Self::Asymmetric(kind) => write!(f, "{kind} pulse asymmetric"),
            Self::Overlap(one, other) => write!(f, "{one} and {other} pulse overlap"),
            Self::LowSignal(kind) => write!(f, "{kind} pulse low"),
            Self::RecordTooShort => f.write_str("record too short"),
            Self::Order => f.write_str("order of pulses doubtful"),
            Self::Unidentified => f.write_str("one pulse missing, perhaps the incident one"),
            Self::NotPicked(kind) => write!(f, "{kind} pulse not picked"),
            Self::CoarseSteps(kind) => write!(f, "{kind} pulse in coarse steps"),
            Self::FewSamples(kind) => write!(f, "{kind} pulse of few samples"),
            Self::Spikes(1) => f.write_str("1 sample of a spike replaced"),
            Self::Spikes(samples) => write!(f, "{samples} samples of spikes replaced"),
            Self::Drift => f.write_str("drifting baseline subtracted"),
            Self::FewQuietSamples => f.write_str("few quiet samples"),
            Self::ByHand(kind) => write!(f, "{kind} pulse picked by hand"),
        }
    }
}

/// Polarity, baseline and resolution of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normalisation {
    /// 1 when pulses point up, −1 when down.
    pub sign: f64,
    /// Offset and noise.
    pub baseline: Baseline,
    /// The digitiser's step: the least difference of neighbouring samples of pulses as recorded.
    pub step: f64,
}

impl Normalisation {
    /// A sample as height above the baseline, pulses up.
    pub fn height(&self, sample: f64) -> f64 {
        self.sign * (sample - self.baseline.offset)
    }

    /// Whether a height is less than 32 steps of the digitiser. Noise of half a step spreads
    /// samples over steps, and then rounding is noise too.
    pub(crate) fn is_coarse(&self, height: f64) -> bool {
        height < 32.0 * self.step && self.baseline.noise < 0.5 * self.step
    }

    /// Standard deviation of rounding to the digitiser's steps in a pulse of this height;
    /// all of half a step in coarse ones, where neighbours are rounded the same way.
    pub(crate) fn rounding(&self, height: f64) -> f64 {
        match self.is_coarse(height) {
            true => 0.5 * self.step,
            false => self.step / 12.0_f64.sqrt(),
        }
    }
}

/// A pulse located to about a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    /// Which of the three.
    pub kind: PulseKind,
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
    /// First and last sample of a clipped top.
    pub clipped: Option<(usize, usize)>,
}

/// Fall over rise, at half the height, from which on a pulse is asymmetric, and from which on it
/// begins to be: those of dry chains have 0.9 to 1.2.
const ASYMMETRIC: f64 = 2.0;
const SYMMETRIC: f64 = 1.2;

impl Pulse {
    /// Whether it falls so much more slowly than it rises that its top is flat.
    pub(crate) fn is_asymmetric(&self) -> bool {
        self.sides_samples.1 > ASYMMETRIC * self.sides_samples.0
    }

    /// Degree of asymmetry: 0 for a fall like those of dry chains, 1 for an asymmetric pulse.
    pub(crate) fn asymmetry(&self) -> f64 {
        let (rise, fall) = self.sides_samples;
        ((fall / rise - SYMMETRIC) / (ASYMMETRIC - SYMMETRIC)).clamp(0.0, 1.0)
    }

    /// The same for whichever side is the slower: how unusual a shape it has.
    pub(crate) fn skewness(&self) -> f64 {
        let (rise, fall) = self.sides_samples;
        let slower = (rise / fall).max(fall / rise);
        ((slower - SYMMETRIC) / (ASYMMETRIC - SYMMETRIC)).clamp(0.0, 1.0)
    }

    /// The same with so many samples on either side of a clipped top counted as clipped, too.
    pub(crate) fn with_clipped_spread(&self, samples: usize) -> Self {
        let spread =
            |(first, last): (usize, usize)| (first.saturating_sub(samples), last + samples);
        Self { clipped: self.clipped.map(spread), ..*self }
    }

    /// Whether a sample is clipped, or next to one that is: recorders round the corner.
    pub(crate) fn is_clipped(&self, sample: usize) -> bool {
        let beside = |(first, last)| sample + 1 >= first && sample <= last + 1;
        self.clipped.is_some_and(beside)
    }

    /// Twice the shorter side: the width of a symmetric pulse with the steeper flank.
    pub(crate) fn steep_width_samples(&self) -> f64 {
        2.0 * self.sides_samples.0.min(self.sides_samples.1)
    }
}

/// The second highest maximum of a pulse, which noise may have made lower than the highest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompetingMaximum {
    /// The maximum, with the pulse about it.
    pub pulse: Pulse,
    /// How much lower it is than the largest, in the samples' unit, by fits about both.
    pub lower: Estimate,
    /// Standard deviation of the part of that which lies under a reflected pulse in a summed channel.
    pub superposition: f64,
}

/// The pulses of a shot.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// At the sensor bead, on the way to the wall.
    pub incident: Option<Pulse>,
    /// At the wall.
    pub wall: Option<Pulse>,
    /// At the sensor bead, on the way back.
    pub reflected: Option<Pulse>,
    /// Other maxima of these that are nearly as high, at most one a pulse.
    pub competing: Vec<CompetingMaximum>,
    /// Quality flags, in order, none twice; empty for a clean record.
    pub flags: Vec<QualityFlag>,
    /// The sensor's, or the summed, channel.
    pub sensor: Normalisation,
    /// The wall's channel; the same as the sensor's if both are summed.
    pub wall_channel: Normalisation,
}

impl Found {
    /// The pulses found, in order.
    pub(crate) fn pulses(&self) -> impl Iterator<Item = &Pulse> {
        let all = [&self.incident, &self.wall, &self.reflected];
        all.into_iter().flatten()
    }

    pub(crate) fn pulses_mut(&mut self) -> impl Iterator<Item = &mut Pulse> {
        let all = [&mut self.incident, &mut self.wall, &mut self.reflected];
        all.into_iter().flatten()
    }

    pub(crate) fn flag(&mut self, more: impl IntoIterator<Item = QualityFlag>) {
        self.flags.extend(more);
        self.flags.sort_unstable();
        self.flags.dedup();
    }

    pub(crate) fn normalisation(&self, kind: PulseKind) -> &Normalisation {
        match kind {
            PulseKind::Wall => &self.wall_channel,
            PulseKind::Incident | PulseKind::Reflected => &self.sensor,
        }
    }
}
