//! Shots cut out of a recording that comes in pieces, where it passes a level.

use crate::signal::error::SignalError;
use std::ops::Range;

/// When a level trigger fires.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trigger {
    /// Fires on the first sample on or beyond this, in the samples' unit.
    pub level: f64,
    /// Whether signals fall through it rather than rise.
    pub falling: bool,
    /// How far the signal must have been back before it can fire again, in the samples' unit.
    pub hysteresis: f64,
    /// Samples of a shot before that which fires.
    pub before: usize,
    /// Samples of a shot, those before included.
    pub length: usize,
    /// Samples after one firing before which there is no other; at least the
    /// shot's own samples are waited for in any case.
    pub hold_off: u64,
}

/// A shot that was cut out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Numbers of its samples in the recording, from 0: fewer than asked for at the
    /// recording's end, and before a trigger that comes soon after its beginning or after
    /// another shot.
    pub samples: Range<u64>,
    /// Number of the sample that fired.
    pub trigger: u64,
    /// Whether the recording lasted to the shot's end.
    pub complete: bool,
}

/// Tells where the shots of a recording are that is given piece by piece.
///
/// What comes out does not depend on how the recording was divided into pieces. Holds no
/// samples: who feeds it keeps those from [`Cutter::needed_from`] on.
#[derive(Clone, Debug)]
pub struct Cutter {
    trigger: Trigger,
    /// Number of the next sample.
    position: u64,
    /// End of the last shot.
    free_from: u64,
    state: State,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    /// No firing before this sample, nor before the signal was back; looks for that.
    Resting(u64),
    /// Fires at the level.
    Armed,
    /// In a shot that fired at this sample.
    Collecting(u64),
}

/// Samples looked at together: enough to keep the processor busy without a branch each.
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
            state: State::Resting(0),
        })
    }

    /// Takes the next piece of the recording, what its samples are worth in the trigger's
    /// unit, and hands out the shots that end in it.
    pub fn feed<T: Copy>(
        &mut self,
        piece: &[T],
        value: impl Fn(T) -> f64,
        mut shot: impl FnMut(Segment),
    ) {
        let mut left = piece;
        while !left.is_empty() {
            let used = match self.state {
                State::Collecting(fired) => self.collect(left.len(), fired, &mut shot),
                State::Resting(until) => self.rest(left, until, &value),
                State::Armed => self.wait(left, &value),
            };
            left = left.get(used..).unwrap_or_default();
        }
    }

    /// Hands out what the recording's end cut short, if anything, and begins anew.
    pub fn finish(&mut self, mut shot: impl FnMut(Segment)) {
        if let State::Collecting(fired) = self.state {
            shot(Segment {
                samples: self.begins(fired)..self.position,
                trigger: fired,
                complete: false,
            });
        }
        self.position = 0;
        self.free_from = 0;
        self.state = State::Resting(0);
    }

    /// The first sample that a shot still to come may have.
    #[must_use]
    pub fn needed_from(&self) -> u64 {
        self.begins(match self.state {
            State::Collecting(fired) => fired,
            State::Resting(_) | State::Armed => self.position,
        })
    }

    /// First sample of a shot that fires at this one.
    fn begins(&self, fires: u64) -> u64 {
        let before = self.trigger.before as u64;
        fires.saturating_sub(before).max(self.free_from)
    }

    /// Goes on in the shot under way; returns how many samples it took.
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
        self.state = State::Resting(end.max(until));
        wanted as usize
    }

    /// Waits for the signal to be back, `until` a sample at least.
    fn rest<T: Copy>(&mut self, left: &[T], until: u64, value: impl Fn(T) -> f64) -> usize {
        let waiting = until.saturating_sub(self.position);
        let skip = usize::try_from(waiting).map_or(left.len(), |n| n.min(left.len()));
        let back = first(&left[skip..], |x| self.trigger.is_back(value(x)));
        if back.is_some() {
            self.state = State::Armed;
        }
        let used = back.map_or(left.len(), |at| skip + at);
        self.position += used as u64;
        used
    }

    /// Waits for the level.
    fn wait<T: Copy>(&mut self, left: &[T], value: impl Fn(T) -> f64) -> usize {
        let fires = first(left, |x| self.trigger.fires(value(x)));
        let used = fires.unwrap_or(left.len());
        self.position += used as u64;
        if fires.is_some() {
            self.state = State::Collecting(self.position);
        }
        used
    }
}

impl Trigger {
    fn check(&self) -> Result<(), SignalError> {
        if !self.level.is_finite() {
            return Err(SignalError::Option {
                name: "level of the trigger",
                value: self.level,
                expected: "a finite number",
            });
        }
        if !(self.hysteresis >= 0.0 && self.hysteresis.is_finite()) {
            return Err(SignalError::Option {
                name: "hysteresis of the trigger",
                value: self.hysteresis,
                expected: "0 or more",
            });
        }
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
