//! Openings and closings between two steps.

use super::column::{Column, WIDTH};
use crate::instruction_set::InstructionSet;
use fearless_simd::{dispatch, f64x8, prelude::*};
use std::ops::Range;

/// Which contacts are open, and those that have changed.
#[derive(Clone, Debug)]
pub(super) struct Changes {
    open: Vec<[bool; WIDTH]>,
    changed: Vec<usize>,
}

impl Changes {
    pub fn new(chunks: usize) -> Self {
        Self {
            open: vec![[false; WIDTH]; chunks],
            changed: Vec::with_capacity(chunks * WIDTH),
        }
    }

    /// Notes what has changed since the last look.
    pub fn look(
        &mut self,
        set: InstructionSet,
        (awake, lanes): (Range<usize>, usize),
        offset_m: &Column,
        x: &[f64],
    ) -> &[usize] {
        self.changed.clear();
        dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || self.compare(simd, (awake, lanes), offset_m, x)
        ));
        &self.changed
    }

    #[inline(always)]
    fn compare<S: Simd>(
        &mut self,
        simd: S,
        (awake, lanes): (Range<usize>, usize),
        offset_m: &Column,
        x: &[f64],
    ) {
        let left = x[..awake.end * WIDTH].as_chunks::<WIDTH>().0;
        let right = x[lanes..][..awake.end * WIDTH].as_chunks::<WIDTH>().0;
        let offset_m = offset_m.reader();
        for i in awake {
            let load = |chunk: &[f64; WIDTH]| -> f64x8<S> { (*chunk).simd_into(simd) };
            let depth = load(offset_m.at(i)) - (load(&right[i]) - load(&left[i]));
            let depth: [f64; WIDTH] = depth.into();
            let open = depth.map(|depth| depth < 0.0);
            if open != self.open[i] {
                let lanes = (0..WIDTH).filter(|&lane| open[lane] != self.open[i][lane]);
                self.changed.extend(lanes.map(|lane| i * WIDTH + lane));
                self.open[i] = open;
            }
        }
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
    pub fn since_s(&self, step_s: f64) -> Option<f64> {
        if self.depth_m >= 0.0 || self.rate_m_s >= 0.0 {
            return None;
        }
        // δ = w t + r t²/2, looked back upon: t from δ and w now.
        let first = self.depth_m / self.rate_m_s;
        let second = first + 0.5 * self.change_m_s2 * first * first / self.rate_m_s;
        Some(second.clamp(0.0, step_s))
    }

    /// Overlap and its rate a time before now, taken as not below 0.
    pub fn at(&self, before_s: f64) -> (f64, f64) {
        let depth = self.depth_m - before_s * (self.rate_m_s - 0.5 * self.change_m_s2 * before_s);
        (depth.max(0.0), self.rate_m_s - self.change_m_s2 * before_s)
    }
}
