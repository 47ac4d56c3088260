//! Shots cut out of a recording that comes in pieces, where it passes a level.

use crate::error::SignalError;

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

/// A shot cut out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<'a, T> {
    /// Number of its first sample in the recording, from 0.
    pub first_sample: u64,
    /// Number of the sample that fired.
    pub trigger: u64,
    /// Its samples: fewer than asked for at the recording's end, and before a
    /// trigger that comes soon after its beginning or after another shot.
    pub samples: &'a [T],
    /// Whether the recording lasted to the shot's end.
    pub complete: bool,
}

/// Cuts shots out of a recording that is given piece by piece.
///
/// What comes out does not depend on how the recording was divided into
/// pieces. Holds one shot and what comes before a trigger, no more.
#[derive(Clone, Debug)]
pub struct Cutter<T> {
    trigger: Trigger,
    /// Samples of the shot under way, or the last ones that may come before one.
    held: Vec<T>,
    /// Number of the next sample.
    position: u64,
    state: State,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    /// No firing before this sample, nor before the signal was back; looks for that.
    Resting(u64),
    /// Fires at the level.
    Armed,
    /// Collects a shot that fired at this sample until it has so many.
    Collecting(u64, usize),
}

/// Samples looked at together: enough to keep the processor busy without a branch each.
const STRIDE: usize = 64;

impl<T: Copy + Into<f64>> Cutter<T> {
    /// # Errors
    /// No sample after the trigger; a level that is not finite; negative hysteresis.
    pub fn new(trigger: Trigger) -> Result<Self, SignalError> {
        trigger.check()?;
        Ok(Self {
            trigger,
            held: Vec::new(),
            position: 0,
            state: State::Resting(0),
        })
    }

    /// Takes the next piece of the recording and hands out the shots that end in it.
    pub fn feed(&mut self, piece: &[T], mut shot: impl FnMut(Segment<'_, T>)) {
        let mut left = piece;
        while !left.is_empty() {
            let used = match self.state {
                State::Collecting(fired, length) => self.collect(left, fired, length, &mut shot),
                State::Resting(until) => self.rest(left, until),
                State::Armed => self.wait(left),
            };
            left = left.get(used..).unwrap_or_default();
        }
    }

    /// Hands out what the recording's end cut short, if anything, and begins anew.
    pub fn finish(&mut self, mut shot: impl FnMut(Segment<'_, T>)) {
        if let State::Collecting(fired, _) = self.state
            && !self.held.is_empty()
        {
            shot(self.segment(&self.held, fired, false));
        }
        self.held.clear();
        self.position = 0;
        self.state = State::Resting(0);
    }

    fn segment<'a>(&self, samples: &'a [T], fired: u64, complete: bool) -> Segment<'a, T> {
        Segment {
            first_sample: self.position - samples.len() as u64,
            trigger: fired,
            samples,
            complete,
        }
    }

    /// Adds to the shot under way; returns how many samples it took.
    fn collect(
        &mut self,
        left: &[T],
        fired: u64,
        length: usize,
        shot: &mut impl FnMut(Segment<'_, T>),
    ) -> usize {
        let used = left.len().min(length - self.held.len());
        self.position += used as u64;
        let whole = self.held.len() + used == length;
        let (taken, _) = left.split_at(used);
        if whole && self.held.is_empty() {
            // All in one piece: no need to copy it.
            shot(self.segment(taken, fired, true));
        } else {
            self.held.extend_from_slice(taken);
        }
        if whole {
            if !self.held.is_empty() {
                shot(self.segment(&self.held, fired, true));
                self.held.clear();
            }
            let until = fired.saturating_add(self.trigger.hold_off);
            self.state = State::Resting(self.position.max(until));
        }
        used
    }

    /// Waits for the signal to be back, `until` a sample at least.
    fn rest(&mut self, left: &[T], until: u64) -> usize {
        let waiting = until.saturating_sub(self.position);
        let skip = usize::try_from(waiting).map_or(left.len(), |n| n.min(left.len()));
        let back = first(&left[skip..], |x| self.trigger.is_back(x));
        if back.is_some() {
            self.state = State::Armed;
        }
        let used = back.map_or(left.len(), |at| skip + at);
        self.remember(&left[..used]);
        used
    }

    /// Waits for the level.
    fn wait(&mut self, left: &[T]) -> usize {
        let trigger = self.trigger;
        let fires = first(left, |x| trigger.fires(x));
        let used = fires.unwrap_or(left.len());
        self.remember(&left[..used]);
        if fires.is_some() {
            let after = trigger.length - trigger.before;
            self.state = State::Collecting(self.position, self.held.len() + after);
        }
        used
    }

    /// Keeps the last samples that a shot may need.
    fn remember(&mut self, passed: &[T]) {
        let before = self.trigger.before;
        self.position += passed.len() as u64;
        let new = &passed[passed.len().saturating_sub(before)..];
        let surplus = (self.held.len() + new.len()).saturating_sub(before);
        self.held.drain(..surplus);
        self.held.extend_from_slice(new);
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
fn first<T: Copy + Into<f64>>(samples: &[T], test: impl Fn(f64) -> bool) -> Option<usize> {
    let mut start = 0;
    for chunk in samples.chunks(STRIDE) {
        // Without early exit inside, so that it runs many samples at a time.
        let any = chunk.iter().fold(false, |any, x| any | test((*x).into()));
        if any {
            let at = chunk.iter().position(|x| test((*x).into()))?;
            return Some(start + at);
        }
        start += chunk.len();
    }
    None
}
