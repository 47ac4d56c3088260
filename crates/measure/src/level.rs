//! Shots cut out of a recording where it passes a level.

use crate::Refused;
use hertzchain_records::{Channel, Record, RecordError};
use hertzchain_signal::{Cutter, Segment, Trigger, median};
use std::collections::VecDeque;

/// A level trigger, as an oscilloscope has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Volts at which a shot begins, approached from the baseline.
    pub volts: f64,
    /// Samples of a shot; as many as 10 ms have when absent.
    pub samples: Option<usize>,
}

/// Length of a shot in s if nobody says: three times what a wave takes along
/// forty balls of steel and back.
const SHOT_S: f64 = 10e-3;

/// Share of a shot that lies before it passes the level.
const BEFORE: f64 = 0.1;

/// Samples of a recording that tell its baseline.
const LOOKED_AT: usize = 4096;

/// One moment of all channels; the first one is the trigger's.
#[derive(Clone, Copy)]
struct Moment {
    sensor: f64,
    wall: f64,
}

impl From<Moment> for f64 {
    fn from(moment: Moment) -> Self {
        moment.sensor
    }
}

/// The shots of recordings that come in pieces, one recording after the other.
pub(crate) struct AtLevel<I> {
    pieces: I,
    level: Level,
    shots: u64,
    /// The recording that is being cut.
    under_way: Option<UnderWay>,
    ready: VecDeque<Result<Record, Refused>>,
}

/// A recording that is being cut.
struct UnderWay {
    /// Its first piece without samples.
    head: Record,
    channels: Vec<Channel>,
    cutter: Cutter<Moment>,
    extremes_v: (f64, f64),
    found: bool,
}

impl<I: Iterator<Item = Result<Record, RecordError>>> AtLevel<I> {
    pub fn new(pieces: I, level: Level) -> Self {
        Self {
            pieces,
            level,
            shots: 0,
            under_way: None,
            ready: VecDeque::new(),
        }
    }

    fn piece(&mut self, piece: &Record) {
        if piece.first_sample == 0 {
            self.finish();
            match UnderWay::new(piece, self.level) {
                Ok(begun) => self.under_way = Some(begun),
                Err(refused) => self.ready.push_back(Err(refused)),
            }
        }
        if let Some(under_way) = &mut self.under_way {
            under_way.feed(piece, &mut self.shots, &mut self.ready);
        }
    }

    /// The end of a recording.
    fn finish(&mut self) {
        if let Some(mut ended) = self.under_way.take() {
            ended.finish(self.level, &mut self.shots, &mut self.ready);
        }
    }
}

impl<I: Iterator<Item = Result<Record, RecordError>>> Iterator for AtLevel<I> {
    type Item = Result<Record, Refused>;

    fn next(&mut self) -> Option<Self::Item> {
        while self.ready.is_empty() {
            match self.pieces.next() {
                Some(Ok(piece)) => self.piece(&piece),
                Some(Err(error)) => {
                    self.finish();
                    self.ready.push_back(Err(error.into()));
                }
                None => {
                    self.finish();
                    break;
                }
            }
        }
        self.ready.pop_front()
    }
}

impl UnderWay {
    fn new(piece: &Record, level: Level) -> Result<Self, Refused> {
        let usual = (SHOT_S / piece.interval_s).round() as usize;
        let length = level.samples.unwrap_or(usual.max(1));
        let volts = piece
            .channels
            .first()
            .map(|channel| channel.samples.volts());
        let volts = volts.unwrap_or_default();
        let stride = volts.len().div_ceil(LOOKED_AT).max(1);
        let some: Vec<f64> = volts.iter().copied().step_by(stride).collect();
        let baseline_v = median(&some).unwrap_or(0.0);
        let cutter = Cutter::new(Trigger {
            level: level.volts,
            falling: level.volts < baseline_v,
            hysteresis: 0.5 * (level.volts - baseline_v).abs(),
            before: (BEFORE * length as f64) as usize,
            length,
            hold_off: length as u64,
        });
        Ok(Self {
            head: piece.without_samples(),
            channels: piece.channels.iter().map(empty).collect(),
            cutter: cutter.map_err(|cause| Refused::Uncuttable {
                source_name: piece.source.clone(),
                cause,
            })?,
            extremes_v: (f64::INFINITY, f64::NEG_INFINITY),
            found: false,
        })
    }

    fn feed(
        &mut self,
        piece: &Record,
        shots: &mut u64,
        ready: &mut VecDeque<Result<Record, Refused>>,
    ) {
        let mut volts = piece.channels.iter().map(|channel| channel.samples.volts());
        let sensor = volts.next().unwrap_or_default();
        let wall = volts.next().unwrap_or_default();
        let wall = wall.into_iter().chain(std::iter::repeat(0.0));
        let moments = sensor.iter().zip(wall);
        let moments: Vec<Moment> = moments
            .map(|(sensor, wall)| Moment {
                sensor: *sensor,
                wall,
            })
            .collect();
        let (low, high) = &mut self.extremes_v;
        *low = sensor.iter().copied().fold(*low, f64::min);
        *high = sensor.iter().copied().fold(*high, f64::max);
        let (head, channels) = (&self.head, &self.channels);
        let before = ready.len();
        self.cutter.feed(&moments, |segment| {
            *shots += 1;
            ready.push_back(Ok(shot(head, channels, *shots, segment)));
        });
        self.found |= ready.len() > before;
    }

    fn finish(
        &mut self,
        level: Level,
        shots: &mut u64,
        ready: &mut VecDeque<Result<Record, Refused>>,
    ) {
        let (head, channels) = (&self.head, &self.channels);
        let before = ready.len();
        self.cutter.finish(|segment| {
            *shots += 1;
            ready.push_back(Ok(shot(head, channels, *shots, segment)));
        });
        self.found |= ready.len() > before;
        if !self.found {
            ready.push_back(Err(Refused::NeverPassed {
                source_name: self.head.source.clone(),
                level_v: level.volts,
                low_v: self.extremes_v.0,
                high_v: self.extremes_v.1,
            }));
        }
    }
}

fn empty(of: &Channel) -> Channel {
    Channel {
        name: of.name.clone(),
        samples: of.samples.with_volts(Vec::new()),
    }
}

/// A shot that was cut out, by its number in the file.
fn shot(head: &Record, channels: &[Channel], number: u64, segment: Segment<'_, Moment>) -> Record {
    let columns: [fn(&Moment) -> f64; 2] = [|moment| moment.sensor, |moment| moment.wall];
    let channels = channels.iter().zip(columns).map(|(channel, of)| Channel {
        name: channel.name.clone(),
        samples: channel
            .samples
            .with_volts(segment.samples.iter().map(of).collect()),
    });
    let fired_s = segment.trigger as f64 * head.interval_s;
    Record {
        source: format!("{}, shot {number} at {fired_s:.4} s", head.source),
        shot: Some(number),
        channels: channels.collect(),
        ..head.without_samples()
    }
}
