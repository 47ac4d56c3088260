//! One shot as a rig recorded it.

use std::ops::Range;
use std::path::{Path, PathBuf};

/// What one or two sensors gave during one shot.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Which file and which shot in it, as it is told to people.
    pub source: String,
    /// Which file.
    pub file: PathBuf,
    /// Number of the shot, if the file holds several or says.
    pub shot: Option<u64>,
    /// Time between samples in s.
    pub interval_s: f64,
    /// Standard error of that, if its file tells it by times of few digits.
    pub interval_error_s: f64,
    /// The channels, all of the same length: one that sums both sensors, or two.
    pub channels: Vec<Channel>,
    /// Speed that the striker was told, in m/s, if the file says.
    pub programmed_speed_m_s: Option<f64>,
    /// Speed of the striker in m/s, if the file says.
    pub speed_m_s: Option<f64>,
    /// Speeds in m/s that the file tells of all its shots, in order, if these are more than its
    /// recordings: which shot has which, only who cuts them out can tell.
    pub speeds_m_s: Vec<f64>,
    /// Standard error of that speed in m/s, if the file says.
    pub speed_error_m_s: Option<f64>,
    /// Which section of the chain was wet and with what, if the file says.
    pub case: Option<String>,
    /// Corner of the amplifier's high-pass in Hz, 0 for none, if the file says.
    pub high_pass_hz: Option<f64>,
    /// The amplifier's low-pass, if the file states one.
    pub low_pass: Option<LowPass>,
    /// Samples before the trigger, if the file says.
    pub pretrigger: Option<usize>,
    /// Whether the trigger fired, if the file says; if not, the recorder gave up waiting.
    pub triggered: Option<bool>,
    /// Number of its first sample in a recording of which it is a piece, from 0.
    pub first_sample: u64,
    /// Samples that were no numbers, in runs, and have others in their places: between their
    /// neighbours, or the largest or least of the record where they were beyond a range.
    pub gaps: Vec<Range<usize>>,
    /// What was taken for granted while it was read, as it is told to people.
    pub notes: Vec<String>,
}

/// An amplifier's low-pass: of one pole, or a Butterworth filter of two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowPass {
    /// Its corner in Hz.
    pub corner_hz: f64,
    /// 1 or 2.
    pub order: usize,
}

impl Record {
    /// A record of which nothing but its samples is known.
    pub(crate) fn new(
        source: String,
        file: &Path,
        interval_s: f64,
        channels: Vec<Channel>,
    ) -> Self {
        Self {
            source,
            file: file.to_owned(),
            shot: None,
            interval_s,
            interval_error_s: 0.0,
            channels,
            programmed_speed_m_s: None,
            speed_m_s: None,
            speeds_m_s: Vec::new(),
            speed_error_m_s: None,
            case: None,
            high_pass_hz: None,
            low_pass: None,
            pretrigger: None,
            triggered: None,
            first_sample: 0,
            gaps: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// The part from sample `start`, at most `count` long.
    #[must_use]
    pub fn part(&self, start: usize, count: usize) -> Self {
        let channels = self.channels.iter().map(|channel| Channel {
            name: channel.name.clone(),
            samples: channel.samples.part(start, count),
        });
        let end = start.saturating_add(count);
        let within = |at: usize| at.clamp(start, end) - start;
        let gaps = self.gaps.iter();
        let gaps = gaps.map(|gap| within(gap.start)..within(gap.end));
        Self {
            channels: channels.collect(),
            gaps: gaps.filter(|gap| !gap.is_empty()).collect(),
            ..self.without_samples()
        }
    }

    /// What is known of it besides its samples.
    #[must_use]
    pub fn without_samples(&self) -> Self {
        Self {
            source: self.source.clone(),
            file: self.file.clone(),
            case: self.case.clone(),
            notes: self.notes.clone(),
            speeds_m_s: self.speeds_m_s.clone(),
            channels: Vec::new(),
            gaps: Vec::new(),
            ..*self
        }
    }

    /// Adds what a later piece of the same recording has from sample `start` on, at most
    /// `count` samples, and takes its channels where there are none yet.
    pub fn append(&mut self, later: &Self, start: usize, count: usize) {
        let (before, part) = (self.len(), later.part(start, count));
        let gaps = part.gaps.iter();
        self.gaps
            .extend(gaps.map(|gap| gap.start + before..gap.end + before));
        if self.channels.is_empty() {
            self.channels = part.channels;
            return;
        }
        for (channel, later) in self.channels.iter_mut().zip(&later.channels) {
            channel.samples.append(&later.samples, start, count);
        }
    }

    /// Number of samples of a channel.
    #[must_use]
    pub fn len(&self) -> usize {
        self.channels
            .first()
            .map_or(0, |channel| channel.samples.len())
    }

    /// Whether there are no samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// What one input of the digitiser gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name in the file, or its number from 1.
    pub name: String,
    /// Its samples.
    pub samples: Samples,
}

/// Samples, kept as small as they came.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// Numbers in the file's unit, mostly V.
    Volts(Vec<f64>),
    /// Readings of a 16-bit converter: V = count · `volts_per_count` + `offset_v`.
    Counts {
        /// The readings.
        counts: Vec<i16>,
        /// Size of a step in V.
        volts_per_count: f64,
        /// Voltage of reading 0 in V.
        offset_v: f64,
    },
}

impl Samples {
    /// How many.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Volts(volts) => volts.len(),
            Self::Counts { counts, .. } => counts.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All of them in V.
    #[must_use]
    pub fn volts(&self) -> Vec<f64> {
        match self {
            Self::Volts(volts) => volts.clone(),
            Self::Counts {
                counts,
                volts_per_count,
                offset_v,
            } => counts
                .iter()
                .map(|count| f64::from(*count) * volts_per_count + offset_v)
                .collect(),
        }
    }

    /// Lowest and highest voltage that the converter can tell, if its range is
    /// known: samples there are clipped.
    #[must_use]
    pub fn range_v(&self) -> Option<(f64, f64)> {
        let Self::Counts {
            volts_per_count,
            offset_v,
            ..
        } = self
        else {
            return None;
        };
        let at = |count: i16| f64::from(count) * volts_per_count + offset_v;
        let (a, b) = (at(i16::MIN), at(i16::MAX));
        Some((a.min(b), a.max(b)))
    }

    /// Lowest and highest voltage of these samples, +∞ and −∞ of none.
    #[must_use]
    pub fn extremes_v(&self) -> (f64, f64) {
        fn extremes(volts: impl Iterator<Item = f64>) -> (f64, f64) {
            volts.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), volt| {
                (low.min(volt), high.max(volt))
            })
        }
        match self {
            Self::Volts(volts) => extremes(volts.iter().copied()),
            Self::Counts {
                counts,
                volts_per_count,
                offset_v,
            } => {
                // Whole numbers first: they are compared many at a time.
                let ends = counts.iter().min().into_iter().chain(counts.iter().max());
                extremes(ends.map(|count| f64::from(*count) * volts_per_count + offset_v))
            }
        }
    }

    /// Adds what a later piece of the same recording has from sample `start` on, at most
    /// `count` samples. Readings of another scale make all of them volts.
    pub fn append(&mut self, later: &Self, start: usize, count: usize) {
        fn added<T: Copy>(to: &mut Vec<T>, of: &[T], start: usize, count: usize) {
            let of = of.get(start..).unwrap_or_default();
            to.extend_from_slice(of.get(..count).unwrap_or(of));
        }
        match (&mut *self, later) {
            (Self::Volts(volts), Self::Volts(later)) => added(volts, later, start, count),
            (
                Self::Counts {
                    counts,
                    volts_per_count,
                    offset_v,
                },
                Self::Counts {
                    counts: later,
                    volts_per_count: scale,
                    offset_v: offset,
                },
            ) if *volts_per_count == *scale && *offset_v == *offset => {
                added(counts, later, start, count);
            }
            (_, later) => {
                let mut volts = self.volts();
                volts.extend(later.part(start, count).volts());
                *self = Self::Volts(volts);
            }
        }
    }

    /// The part from `start`, at most `count` long.
    pub(crate) fn part(&self, start: usize, count: usize) -> Self {
        fn cut<T: Copy>(of: &[T], start: usize, count: usize) -> Vec<T> {
            of.iter().skip(start).take(count).copied().collect()
        }
        match self {
            Self::Volts(volts) => Self::Volts(cut(volts, start, count)),
            Self::Counts {
                counts,
                volts_per_count,
                offset_v,
            } => Self::Counts {
                counts: cut(counts, start, count),
                volts_per_count: *volts_per_count,
                offset_v: *offset_v,
            },
        }
    }
}
