//! Openings and closings between two steps.

use std::ops::Range;

/// Which contacts are open, and those that have changed.
#[derive(Clone, Debug)]
pub(super) struct Changes<const W: usize> {
    /// A bit for each contact of a chunk, as the force pass has seen it now.
    pub now: Vec<u64>,
    /// The same at the last look.
    open: Vec<u64>,
    changed: Vec<usize>,
}

impl<const W: usize> Changes<W> {
    pub(super) fn new(chunks: usize) -> Self {
        Self {
            now: vec![0; chunks],
            open: vec![0; chunks],
            changed: Vec::with_capacity(chunks * W),
        }
    }

    /// A contact, by its place in the flat array, is open from now on.
    pub(super) fn opened(&mut self, at: usize) {
        self.open[at / W] |= 1 << (at % W);
    }

    /// Notes what has changed since the last look among some chunks.
    pub(super) fn look(&mut self, awake: Range<usize>) -> &[usize] {
        self.changed.clear();
        for i in awake {
            let mut changed = self.now[i] ^ self.open[i];
            self.open[i] = self.now[i];
            while changed != 0 {
                self.changed.push(i * W + changed.trailing_zeros() as usize);
                changed &= changed - 1;
            }
        }
        &self.changed
    }
}

/// A contact's motion just after it has opened.
#[derive(Clone, Copy, Debug)]
pub(super) struct Opening {
    /// Overlap now, negative.
    pub depth_m: f64,
    pub rate_m_s: f64,
    /// Rate of change of the rate.
    pub change_m_s2: f64,
}

impl Opening {
    /// Time since the overlap was 0, in s, at most a step; `None` if it has
    /// not just become negative.
    pub(super) fn since_s(&self, step_s: f64) -> Option<f64> {
        if self.depth_m >= 0.0 || self.rate_m_s >= 0.0 {
            return None;
        }
        // δ = w t + r t²/2, looked back upon: t from δ and w now.
        let first = self.depth_m / self.rate_m_s;
        let second = first + 0.5 * self.change_m_s2 * first * first / self.rate_m_s;
        Some(second.clamp(0.0, step_s))
    }

    /// Overlap and its rate a time before now, taken as not below 0.
    pub(super) fn at(&self, before_s: f64) -> (f64, f64) {
        let depth = self.depth_m - before_s * (self.rate_m_s - 0.5 * self.change_m_s2 * before_s);
        (depth.max(0.0), self.rate_m_s - self.change_m_s2 * before_s)
    }
}
