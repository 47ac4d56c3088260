//! Overlaps, their roots and their rates, chunk by chunk.

use super::column::{Column, Reader, WIDTH};
use super::root::roots;
use crate::system::FLUSH;
use fearless_simd::{f64x8, prelude::*};

/// One chunk of contacts as laws see them.
pub(super) struct Touch {
    pub overlap: [f64; WIDTH],
    pub root: [f64; WIDTH],
    /// Overlap rate; 0 where open, so that gated laws give no force there.
    pub rate: [f64; WIDTH],
    /// Overlap rate whether open or not.
    pub across: [f64; WIDTH],
}

/// Positions and velocities of the bodies left and right of each contact.
pub(super) struct Sides<'a> {
    offset_m: Reader<'a>,
    starting: bool,
    x: [&'a [[f64; WIDTH]]; 2],
    v: [&'a [[f64; WIDTH]]; 2],
}

impl<'a> Sides<'a> {
    /// Of the first `count` chunks of contacts.
    #[inline(always)]
    pub fn new(
        offset_m: &'a Column,
        (count, lanes): (usize, usize),
        (x, v): (&'a [f64], &'a [f64]),
        starting: bool,
    ) -> Self {
        let pair = |values: &'a [f64]| {
            let right = &values[lanes..][..count * WIDTH];
            [values[..count * WIDTH].as_chunks().0, right.as_chunks().0]
        };
        Self {
            offset_m: offset_m.reader(),
            starting,
            x: pair(x),
            v: pair(v),
        }
    }

    /// Chunk `i`: closed ⇔ δ > 0, or δ = 0 and approaching. The latter can only
    /// be at the start: whatever approaches from contact overlaps a step later.
    #[inline(always)]
    pub fn touch<S: Simd>(&self, simd: S, i: usize) -> Touch {
        let load = |chunk: &[f64; WIDTH]| -> f64x8<S> { (*chunk).simd_into(simd) };
        let zero = f64x8::splat(simd, 0.0);
        let depth = load(self.offset_m.at(i)) - (load(&self.x[1][i]) - load(&self.x[0][i]));
        let rate = load(&self.v[0][i]) - load(&self.v[1][i]);
        let deep = depth.simd_gt(f64x8::splat(simd, FLUSH));
        let overlap = deep.select(depth, zero);
        let closed = match self.starting {
            true => deep | (depth.simd_ge(zero) & rate.simd_gt(zero)),
            false => deep,
        };
        Touch {
            overlap: overlap.into(),
            root: roots(simd, overlap).into(),
            rate: closed.select(rate, zero).into(),
            across: rate.into(),
        }
    }
}
