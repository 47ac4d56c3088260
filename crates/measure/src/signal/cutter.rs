//! Shots cut out of a recording that is fed in pieces, where it passes a level.

use crate::signal::error::SignalError;
use std::ops::Range;

/// A level trigger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trigger {
    /// Level in the samples' unit; the first sample on or beyond it fires.
    pub level: f64,
    /// Whether signals fall through it rather than rise.
    pub falling: bool,
    /// How far the signal must have returned before it can fire again, in the samples' unit.
    pub hysteresis: f64,
    /// Samples of a shot before the one that fires.
    pub before: usize,
    /// Samples of a shot, those before included.
    pub length: usize,
    /// Samples after one firing before which there is no other; at least the shot's own.
    pub hold_off: u64,
}

/// The range of a shot in a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Numbers of its samples in the recording, from 0: fewer than the trigger's length at the
    /// recording's end, and soon after its beginning or another shot.
    pub samples: Range<u64>,
    /// Number of the sample that fired.
    pub trigger: u64,
    /// Whether the recording lasted to the shot's end.
    pub complete: bool,
}

/// Locates the shots of a recording that is fed piece by piece.
///
/// Results do not depend on how the recording was divided into pieces. Holds no samples: the caller
/// keeps those from [`Cutter::needed_from`] on.
#[derive(Clone, Debug)]
pub struct Cutter {
    trigger: Trigger,
    /// Number of the next sample.
    position: u64,
    /// End of the last shot.
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

/// Samples tested together: enough to keep the processor busy without a branch each.
const STRIDE: usize = 64;

impl Cutter {
    /// # Errors
    /// No sample after the trigger; a level that is not finite; negative hysteresis.
    pub fn new(trigger: Trigger) -> Result<Self, SignalError> {
        trigger.check()?;
        Ok(Self {
            trigger,
            position: 0,
            free_from: 0,
            state: TriggerState::Resting(0),
        })
    }

    /// Processes the next piece of the recording, given what its samples are in the trigger's
    /// unit, and passes the shots that end in it to `shot`.
    pub fn feed<T: Copy>(
        &mut self,
        piece: &[T],
        value: impl Fn(T) -> f64,
        mut shot: impl FnMut(Segment),
    ) {
        let mut left = piece;
        while !left.is_empty() {
            let used = match self.state {
                TriggerState::Collecting(fired) => self.collect(left.len(), fired, &mut shot),
                TriggerState::Resting(until) => self.rest(left, until, &value),
                TriggerState::Armed => self.wait(left, &value),
            };
            left = left.get(used..).unwrap_or_default();
        }
    }

    /// Passes a shot that the recording's end cut short to `shot`, and resets.
    pub fn finish(&mut self, mut shot: impl FnMut(Segment)) {
        if let TriggerState::Collecting(fired) = self.state {
            shot(Segment {
                samples: self.begins(fired)..self.position,
                trigger: fired,
                complete: false,
            });
        }
        self.position = 0;
        self.free_from = 0;
        self.state = TriggerState::Resting(0);
    }

    /// The first sample that a shot still to come may have.
    #[must_use]
    pub fn needed_from(&self) -> u64 {
        self.begins(match self.state {
            TriggerState::Collecting(fired) => fired,
            TriggerState::Resting(_) | TriggerState::Armed => self.position,
        })
    }

    fn begins(&self, fires: u64) -> u64 {
        let before = self.trigger.before as u64;
        fires.saturating_sub(before).max(self.free_from)
    }

    /// Continues the current shot; returns how many samples it took.
    fn collect(&mut self, left: usize, fired: u64, shot: &mut impl FnMut(Segment)) -> usize {
        let end = fired + (self.trigger.length - self.trigger.before) as u64;
        let wanted = end - self.position;
        if wanted > left as u64 {
            self.position += left as u64;
            return left;
        }
        shot(Segment {
            samples: self.begins(fired)..end,
            trigger: fired,
            complete: true,
        });
        self.position = end;
        self.free_from = end;
        let until = fired.saturating_add(self.trigger.hold_off);
        self.state = TriggerState::Resting(end.max(until));
        wanted as usize
    }

    fn rest<T: Copy>(&mut self, left: &[T], until: u64, value: impl Fn(T) -> f64) -> usize {
        let waiting = until.saturating_sub(self.position);
        let skip = usize::try_from(waiting).map_or(left.len(), |n| n.min(left.len()));
        let back = first(&left[skip..], |x| self.trigger.is_back(value(x)));
        if back.is_some() {
            self.state = TriggerState::Armed;
        }
        let used = back.map_or(left.len(), |at| skip + at);
        self.position += used as u64;
        used
    }

    fn wait<T: Copy>(&mut self, left: &[T], value: impl Fn(T) -> f64) -> usize {
        let fires = first(left, |x| self.trigger.fires(value(x)));
        let used = fires.unwrap_or(left.len());
        self.position += used as u64;
        if fires.is_some() {
            self.state = TriggerState::Collecting(self.position);
        }
        used
    }
}

impl Trigger {
    fn check(&self) -> Result<(), SignalError> {
        let (level, hysteresis) = (self.level, self.hysteresis);
        let name = "level of the trigger";
        SignalError::require(level.is_finite(), name, level, "a finite number")?;
        let accepted = hysteresis >= 0.0 && hysteresis.is_finite();
        SignalError::require(
            accepted,
            "hysteresis of the trigger",
            hysteresis,
            "0 or more",
        )?;
        let after = self.length as f64 - self.before as f64;
        SignalError::positive("number of samples of a shot after its trigger", after)
    }

    fn sign(self) -> f64 {
        if self.falling { -1.0 } else { 1.0 }
    }

    fn fires(self, x: f64) -> bool {
        self.sign() * x >= self.sign() * self.level
    }

    fn is_back(self, x: f64) -> bool {
        self.sign() * x < self.sign() * self.level - self.hysteresis
    }
}

/// First sample for which `test` holds.
fn first<T: Copy>(samples: &[T], test: impl Fn(T) -> bool) -> Option<usize> {
    let mut start = 0;
    for chunk in samples.chunks(STRIDE) {
        // Without early exit inside, so that it runs many samples at a time.
        let any = chunk.iter().fold(false, |any, x| any | test(*x));
        if any {
            let at = chunk.iter().position(|x| test(*x))?;
            return Some(start + at);
        }
        start += chunk.len();
    }
    None
}
