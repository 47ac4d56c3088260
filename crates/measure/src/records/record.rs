//! One shot as a rig recorded it.

use crate::signal::{Bandwidth, extremes};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Samples of one or two sensors during one shot, and what the file states of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// File and shot, for messages.
    pub source: String,
    /// Path of the file.
    pub file: PathBuf,
    /// Number of the shot, if the file holds several or states it.
    pub shot: Option<u64>,
    /// Time between samples in s.
    pub interval_s: f64,
    /// Standard error of the interval in s, where it follows from times of few digits.
    pub interval_error_s: f64,
    /// Channels of one length: one that sums both sensors, or two.
    pub channels: Vec<Channel>,
    /// Programmed speed of the striker in m/s.
    pub programmed_speed_m_s: Option<f64>,
    /// Measured speed of the striker in m/s.
    pub speed_m_s: Option<f64>,
    /// Speeds in m/s of all shots of the file, where these are still to be cut out.
    pub speeds_m_s: Vec<f64>,
    /// Standard error of the measured speed in m/s.
    pub speed_error_m_s: Option<f64>,
    /// Which section of the chain was wet and with what.
    pub case: Option<String>,
    /// Corner of the amplifier's high-pass in Hz, 0 for none.
    pub high_pass_hz: Option<f64>,
    /// The amplifier's low-pass.
    pub low_pass: Option<Bandwidth>,
    /// Samples before the trigger.
    pub pretrigger: Option<usize>,
    /// Whether the trigger fired.
    pub triggered: Option<bool>,
    /// Number, from 0, of its first sample in the recording of which it is a piece.
    pub first_sample: u64,
    /// Runs of samples that were not finite and were filled: between their neighbours, or with
    /// the record's extreme where they were beyond a range.
    pub gaps: Vec<Range<usize>>,
    /// Assumptions made while the record was read.
    pub notes: Vec<String>,
}

impl Record {
    pub(crate) fn new(
        source: String,
        file: &Path,
        interval_s: f64,
        channels: Vec<Channel>,
    ) -> Self {
        Self { source, file: file.to_owned(), interval_s, channels, ..Self::default() }
    }

    /// The part from sample `start`, at most `count` long.
    pub fn part(&self, start: usize, count: usize) -> Self {
        let end = start.saturating_add(count);
        let channels = self.channels.iter().map(|channel| {
            let end = end.min(channel.volts.len());
            Channel {
                name: channel.name.clone(),
                volts: channel.volts[start.min(end)..end].to_vec(),
                range_v: channel.range_v,
            }
        });
        let within = |at: usize| at.clamp(start, end) - start;
        let gaps = self.gaps.iter();
        let gaps = gaps.map(|gap| within(gap.start)..within(gap.end));
        Self {
            channels: channels.collect(),
            gaps: gaps.filter(|gap| !gap.is_empty()).collect(),
            ..self.without_samples()
        }
    }

    pub(crate) fn without_samples(&self) -> Self {
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

    /// Appends at most `count` samples of a later piece of the recording from sample `start` on.
    pub(crate) fn append(&mut self, later: &Self, start: usize, count: usize) {
        let (before, part) = (self.len(), later.part(start, count));
        let gaps = part.gaps.iter();
        self.gaps.extend(gaps.map(|gap| gap.start + before..gap.end + before));
        if self.channels.is_empty() {
            self.channels = part.channels;
            return;
        }
        for (channel, later) in self.channels.iter_mut().zip(part.channels) {
            channel.volts.extend(later.volts);
            let both = channel.range_v.zip(later.range_v);
            channel.range_v = both.map(|(one, two)| (one.0.min(two.0), one.1.max(two.1)));
        }
    }

    /// Number of samples of a channel.
    pub fn len(&self) -> usize {
        self.channels.first().map_or(0, |one| one.volts.len())
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Samples of one input of the digitiser.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Channel {
    /// Its name in the file, or its number from 1.
    pub name: String,
    /// Voltages in V, or numbers in the file's unit where it states none.
    pub volts: Vec<f64>,
    /// Lowest and highest voltage of a converter's range: samples there are clipped.
    pub range_v: Option<(f64, f64)>,
}

/// Channels of a series whose sensors have one each.
pub(crate) const SEPARATE: &[&str] = &["sensor", "wall"];

pub(crate) type Samples = (Vec<f64>, Option<(f64, f64)>);

/// Range of a converter of at most 16 bits, V = count · `volts_per_count` + `offset_v`: one of fewer
/// leaves the lowest bits of all counts at 0, so that its highest count is less.
pub(crate) fn converter_range_v(volts: &[f64], volts_per_count: f64, offset_v: f64) -> (f64, f64) {
    let count = |volts: f64| ((volts - offset_v) / volts_per_count).round() as i32;
    let used = volts.iter().fold(0, |used, volts| used | count(*volts));
    let least = if used == 0 { 1 } else { 1 << used.trailing_zeros().min(15) };
    let ends = [i32::from(i16::MIN), i32::from(i16::MAX) + 1 - least];
    extremes(&ends.map(|count| f64::from(count) * volts_per_count + offset_v))
}
