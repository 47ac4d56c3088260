//! Shots cut out of a recording that comes in pieces, where it passes a level.

use crate::MeasureError;
use crate::error::Result;
use crate::records::{Channel, Record};
use crate::signal::{extremes, median};
use std::collections::VecDeque;
use std::ops::Range;

/// A level trigger, as an oscilloscope has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Volts at which a shot begins, approached from the baseline.
    pub volts: f64,
    /// Samples of a shot; as many as 10 ms have when absent.
    pub samples: Option<usize>,
}

/// Length of a shot in s by default: three times what a wave takes along forty balls of steel and
/// back.
const SHOT_S: f64 = 10e-3;
const BEFORE: f64 = 0.1;
const BASELINE: usize = 4096;
/// Samples tested together: enough to keep the processor busy without a branch each.
const STRIDE: usize = 64;

/// Locates the shots of a recording that is fed piece by piece. Results do not depend on how the
/// recording was divided; the caller keeps the samples from [`Cutter::needed_from`] on.
#[derive(Debug)]
struct Cutter {
    /// The level, and how far the signal must have returned before it can fire again: both of a signal
    /// that rises, to which `sign` turns one that falls.
    level: f64,
    hysteresis: f64,
    sign: f64,
    /// Samples of a shot before the one that fires, and in all; no other fires within as many.
    before: u64,
    length: u64,
    position: u64,
    free_from: u64,
    state: TriggerState,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum TriggerState {
    /// Not armed before this sample, nor before the signal has returned.
    Resting(u64),
    Armed,
    /// In a shot that fired at this sample.
    Collecting(u64),
}

/// Samples of a shot, fewer at the recording's end and soon after its beginning or another shot, and
/// the one that fired; by their numbers in the recording.
type Segment = (Range<u64>, u64);

impl Cutter {
    fn new(level: f64, baseline: f64, length: usize) -> Result<Self> {
        MeasureError::require(level.is_finite(), "level of the trigger", level, "a finite number")?;
        MeasureError::positive("number of samples of a shot", length as f64)?;
        let sign = if level < baseline { -1.0 } else { 1.0 };
        Ok(Self {
            level: sign * level,
            hysteresis: 0.5 * (level - baseline).abs(),
            sign,
            before: (BEFORE * length as f64) as u64,
            length: length as u64,
            position: 0,
            free_from: 0,
            state: TriggerState::Resting(0),
        })
    }

    fn feed(&mut self, piece: &[f64]) -> Vec<Segment> {
        let (mut left, mut shots) = (piece, Vec::new());
        while !left.is_empty() {
            let used = match self.state {
                TriggerState::Collecting(fired) => {
                    let end = fired + self.length - self.before;
                    let used = usize::try_from(end - self.position).unwrap_or(usize::MAX);
                    if used <= left.len() {
                        shots.push((self.begins(fired)..end, fired));
                        self.free_from = end;
                        self.state = TriggerState::Resting(fired + self.length);
                    }
                    used.min(left.len())
                }
                TriggerState::Resting(until) => {
                    let waiting = usize::try_from(until.saturating_sub(self.position));
                    let skip = waiting.map_or(left.len(), |n| n.min(left.len()));
                    let lowest = self.level - self.hysteresis;
                    let back = first(&left[skip..], |x| self.sign * x < lowest);
                    self.state = back.map_or(self.state, |_| TriggerState::Armed);
                    back.map_or(left.len(), |at| skip + at)
                }
                TriggerState::Armed => {
                    let fires = first(left, |x| self.sign * x >= self.level);
                    let fired = |at: usize| TriggerState::Collecting(self.position + at as u64);
                    self.state = fires.map_or(self.state, fired);
                    fires.unwrap_or(left.len())
                }
            };
            self.position += used as u64;
            left = &left[used..];
        }
        shots
    }

    fn finish(&self) -> Option<Segment> {
        match self.state {
            TriggerState::Collecting(fired) => Some((self.begins(fired)..self.position, fired)),
            _ => None,
        }
    }

    /// The first sample that a shot still to come may have.
    fn needed_from(&self) -> u64 {
        self.begins(match self.state {
            TriggerState::Collecting(fired) => fired,
            TriggerState::Resting(_) | TriggerState::Armed => self.position,
        })
    }

    fn begins(&self, fires: u64) -> u64 {
        fires.saturating_sub(self.before).max(self.free_from)
    }
}

fn first(samples: &[f64], test: impl Fn(f64) -> bool) -> Option<usize> {
    for (number, chunk) in samples.chunks(STRIDE).enumerate() {
        // Without early exit inside, so that it runs many samples at a time.
        if chunk.iter().fold(false, |any, x| any | test(*x)) {
            let at = chunk.iter().position(|x| test(*x))?;
            return Some(number * STRIDE + at);
        }
    }
    None
}

/// Returns the shots of recordings that come in pieces, one recording after the other, as soon as
/// each is whole.
pub fn shots_at_level(
    pieces: impl Iterator<Item = Result<Record>>,
    level: Level,
) -> impl Iterator<Item = Result<Record>> {
    AtLevel { pieces, level, shots: 0, under_way: None, ready: VecDeque::new() }
}

struct AtLevel<I> {
    pieces: I,
    level: Level,
    shots: u64,
    under_way: Option<UnderWay>,
    ready: VecDeque<Result<Record>>,
}

struct UnderWay {
    head: Record,
    cutter: Cutter,
    /// Pieces that a shot still to come may need.
    stored: VecDeque<Record>,
    extremes_v: (f64, f64),
    found: bool,
}

impl<I: Iterator<Item = Result<Record>>> AtLevel<I> {
    fn piece(&mut self, piece: Record) -> Result<()> {
        if piece.first_sample == 0 {
            self.finish();
            self.under_way = Some(UnderWay::new(&piece, self.level)?);
        }
        if let Some(under_way) = &mut self.under_way {
            let cut = under_way.feed(piece);
            under_way.shots(&cut, &mut self.shots, &mut self.ready);
            under_way.drop_old();
        }
        Ok(())
    }

    fn finish(&mut self) {
        let Some(mut ended) = self.under_way.take() else {
            return;
        };
        let last: Vec<Segment> = ended.cutter.finish().into_iter().collect();
        ended.shots(&last, &mut self.shots, &mut self.ready);
        if !ended.found {
            let (low_v, high_v) = ended.extremes_v;
            let detail = format!(
                "never passes the level of {} V; its samples lie between {low_v:.4} and {high_v:.4} V",
                self.level.volts
            );
            let error = MeasureError::Shots(ended.head.source, detail);
            self.ready.push_back(Err(error));
        }
    }
}

impl<I: Iterator<Item = Result<Record>>> Iterator for AtLevel<I> {
    type Item = Result<Record>;

    fn next(&mut self) -> Option<Self::Item> {
        while self.ready.is_empty() {
            let Some(piece) = self.pieces.next() else {
                self.finish();
                break;
            };
            if let Err(error) = piece.and_then(|piece| self.piece(piece)) {
                self.finish();
                self.ready.push_back(Err(error));
            }
        }
        self.ready.pop_front()
    }
}

impl UnderWay {
    fn new(piece: &Record, level: Level) -> Result<Self> {
        let usual = (SHOT_S / piece.interval_s).round() as usize;
        let length = level.samples.unwrap_or(usual.max(1));
        let channel = piece.channels.first();
        let volts = channel.map_or(&[][..], |channel| &channel.volts);
        let stride = volts.len().div_ceil(BASELINE).max(1);
        let some: Vec<f64> = volts.iter().copied().step_by(stride).collect();
        let baseline_v = median(&some).unwrap_or(0.0);
        let cutter = Cutter::new(level.volts, baseline_v, length);
        Ok(Self {
            head: piece.without_samples(),
            cutter: cutter.map_err(|cause| {
                MeasureError::Shots(piece.source.clone(), format!("cannot be cut: {cause}"))
            })?,
            stored: VecDeque::new(),
            extremes_v: (f64::INFINITY, f64::NEG_INFINITY),
            found: false,
        })
    }

    fn feed(&mut self, piece: Record) -> Vec<Segment> {
        self.stored.push_back(piece);
        let newest = self.stored.back().and_then(|piece| piece.channels.first());
        let Some(Channel { volts, .. }) = newest else {
            return Vec::new();
        };
        if !self.found {
            let (low, high) = extremes(volts);
            self.extremes_v = (self.extremes_v.0.min(low), self.extremes_v.1.max(high));
        }
        self.cutter.feed(volts)
    }

    /// The shots that were cut out, by their numbers in the file.
    fn shots(&mut self, cut: &[Segment], number: &mut u64, ready: &mut VecDeque<Result<Record>>) {
        self.found |= !cut.is_empty();
        for (samples, trigger) in cut {
            *number += 1;
            let fired_s = *trigger as f64 * self.head.interval_s;
            let mut shot = Record {
                source: format!("{}, shot {number} at {fired_s:.4} s", self.head.source),
                shot: Some(*number),
                ..self.head.clone()
            };
            for piece in &self.stored {
                let first = piece.first_sample;
                let within = |at: u64| (at.saturating_sub(first) as usize).min(piece.len());
                let (from, to) = (within(samples.start), within(samples.end));
                if from < to {
                    shot.append(piece, from, to - from);
                }
            }
            ready.push_back(Ok(shot));
        }
    }

    fn drop_old(&mut self) {
        let needed_from = self.cutter.needed_from();
        let end = |piece: &Record| piece.first_sample + piece.len() as u64;
        self.stored.retain(|piece| end(piece) > needed_from);
    }
}

#[cfg(test)]
#[path = "tests/cutting.rs"]
mod tests;
