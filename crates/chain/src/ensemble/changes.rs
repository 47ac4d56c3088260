//! Openings and closings between two steps.

use super::column::LaneColumn;
use super::number::Number;
use crate::instruction_set::InstructionSet;
use fearless_simd::{dispatch, prelude::*};
use std::ops::Range;

/// Which contacts are open, and those that have changed.
#[derive(Clone, Debug)]
pub(super) struct Changes<const W: usize> {
    /// A bit for each contact of a chunk.
    open: Vec<u64>,
    changed: Vec<usize>,
}

impl<const W: usize> Changes<W> {
    pub(super) fn new(chunks: usize) -> Self {
        Self { open: vec![0; chunks], changed: Vec::with_capacity(chunks * W) }
    }

    /// A contact, by its place in the flat array, is open from now on.
    pub(super) fn opened(&mut self, at: usize) {
        self.open[at / W] |= 1 << (at % W);
    }

    /// Notes what has changed since the last look.
    pub(super) fn look<N: Number<W>>(
        &mut self,
        set: InstructionSet,
        (awake, lanes): (Range<usize>, usize),
        offset_m: &LaneColumn<N, W>,
        x: &[N],
    ) -> &[usize] {
        self.changed.clear();
        dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || self.compare(simd, (awake, lanes), offset_m, x)
        ));
        &self.changed
    }

    #[inline(always)]
    fn compare<S: Simd, N: Number<W>>(
        &mut self,
        simd: S,
        (awake, lanes): (Range<usize>, usize),
        offset_m: &LaneColumn<N, W>,
        x: &[N],
    ) {
        let left = x[..awake.end * W].as_chunks::<W>().0;
        let right = x[lanes..][..awake.end * W].as_chunks::<W>().0;
        let offset_m = offset_m.reader();
        let load = |chunk: &[N; W]| N::Wide::<S>::load_array_ref(simd, chunk);
        let zero = N::Wide::<S>::simd_from(simd, N::default());
        for i in awake {
            let depth = load(offset_m.at(i)) - (load(&right[i]) - load(&left[i]));
            let open = depth.simd_lt(zero).to_bitmask();
            let mut changed = open ^ self.open[i];
            self.open[i] = open;
            while changed != 0 {
                self.changed.push(i * W + changed.trailing_zeros() as usize);
                changed &= changed - 1;
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
