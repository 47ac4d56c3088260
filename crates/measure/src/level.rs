//! Shots cut out of a recording where it passes a level.

use crate::MeasureError;
use crate::records::{Channel, Record, Samples};
use crate::signal::{Cutter, Segment, Trigger, median};
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

/// The shots of recordings that come in pieces, one recording after the other.
pub(crate) struct AtLevel<I> {
    pieces: I,
    level: Level,
    shots: u64,
    /// The recording that is being cut.
    under_way: Option<UnderWay>,
    ready: VecDeque<Result<Record, MeasureError>>,
}

/// A recording that is being cut.
struct UnderWay {
    /// Its first piece without samples.
    head: Record,
    cutter: Cutter,
    /// Pieces that a shot still to come may need.
    kept: VecDeque<Record>,
    /// Lowest and highest voltage until a shot was found.
    extremes_v: (f64, f64),
    found: bool,
}

impl<I: Iterator<Item = Result<Record, MeasureError>>> AtLevel<I> {
    pub(crate) fn new(pieces: I, level: Level) -> Self {
        Self {
            pieces,
            level,
            shots: 0,
            under_way: None,
            ready: VecDeque::new(),
        }
    }

    fn piece(&mut self, piece: Record) {
        if piece.first_sample == 0 {
            self.finish();
            match UnderWay::new(&piece, self.level) {
                Ok(begun) => self.under_way = Some(begun),
                Err(error) => self.ready.push_back(Err(error)),
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

impl<I: Iterator<Item = Result<Record, MeasureError>>> Iterator for AtLevel<I> {
    type Item = Result<Record, MeasureError>;

    fn next(&mut self) -> Option<Self::Item> {
        while self.ready.is_empty() {
            match self.pieces.next() {
                Some(Ok(piece)) => self.piece(piece),
                Some(Err(error)) => {
                    self.finish();
                    self.ready.push_back(Err(error));
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
    fn new(piece: &Record, level: Level) -> Result<Self, MeasureError> {
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
            cutter: cutter.map_err(|cause| {
                MeasureError::Shots(piece.source.clone(), format!("cannot be cut: {cause}"))
            })?,
            kept: VecDeque::new(),
            extremes_v: (f64::INFINITY, f64::NEG_INFINITY),
            found: false,
        })
    }

    fn feed(
        &mut self,
        piece: Record,
        shots: &mut u64,
        ready: &mut VecDeque<Result<Record, MeasureError>>,
    ) {
        self.kept.push_back(piece);
        let mut cut = Vec::new();
        let newest = self.kept.back().and_then(|piece| piece.channels.first());
        let Some(Channel { samples, .. }) = newest else {
            return;
        };
        if !self.found {
            let (low, high) = samples.extremes_v();
            self.extremes_v = (self.extremes_v.0.min(low), self.extremes_v.1.max(high));
        }
        match samples {
            Samples::Volts(volts) => self.cutter.feed(volts, |volt| volt, |one| cut.push(one)),
            Samples::Counts {
                counts,
                volts_per_count,
                offset_v,
            } => {
                let volts = |count| f64::from(count) * volts_per_count + offset_v;
                self.cutter.feed(counts, volts, |one| cut.push(one));
            }
        }
        self.hand_out(&cut, shots, ready);
        let needed_from = self.cutter.needed_from();
        self.kept
            .retain(|piece| piece.first_sample + piece.len() as u64 > needed_from);
    }

    fn hand_out(
        &mut self,
        cut: &[Segment],
        shots: &mut u64,
        ready: &mut VecDeque<Result<Record, MeasureError>>,
    ) {
        self.found |= !cut.is_empty();
        for segment in cut {
            *shots += 1;
            ready.push_back(Ok(self.shot(*shots, segment)));
        }
    }

    /// A shot that was cut out, by its number in the file.
    fn shot(&self, number: u64, segment: &Segment) -> Record {
        let fired_s = segment.trigger as f64 * self.head.interval_s;
        let mut shot = Record {
            source: format!("{}, shot {number} at {fired_s:.4} s", self.head.source),
            shot: Some(number),
            ..self.head.clone()
        };
        for piece in &self.kept {
            add(&mut shot, piece, segment);
        }
        shot
    }

    fn finish(
        &mut self,
        level: Level,
        shots: &mut u64,
        ready: &mut VecDeque<Result<Record, MeasureError>>,
    ) {
        let mut cut = Vec::new();
        self.cutter.finish(|one| cut.push(one));
        self.hand_out(&cut, shots, ready);
        if !self.found {
            let (low_v, high_v) = self.extremes_v;
            let detail = format!(
                "never passes the level of {} V; its samples lie between {low_v:.4} and {high_v:.4} V",
                level.volts
            );
            let source = self.head.source.clone();
            ready.push_back(Err(MeasureError::Shots(source, detail)));
        }
    }
}

/// Adds what a piece has of a shot.
fn add(shot: &mut Record, piece: &Record, segment: &Segment) {
    let first = piece.first_sample;
    let within = |sample: u64| (sample.saturating_sub(first) as usize).min(piece.len());
    let (from, to) = (within(segment.samples.start), within(segment.samples.end));
    if from < to {
        shot.append(piece, from, to - from);
    }
}
