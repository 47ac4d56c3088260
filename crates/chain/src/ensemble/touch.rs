//! Overlaps, their roots and their rates, chunk by chunk.

use super::column::ColumnReader;
use super::number::Number;
use super::section::SweepPlace;
use fearless_simd::prelude::*;

/// One chunk of contacts as laws see them.
pub(super) struct LaneTouch<V> {
    /// Overlap, negative across a gap.
    pub depth: V,
    pub overlap: V,
    pub root: V,
    /// Overlap rate; 0 where open, so that gated laws give no force there.
    pub rate: V,
    /// Overlap rate whether open or not.
    pub across: V,
}

/// Positions and velocities of the bodies left and right of some contacts.
pub(super) struct Sides<'a, N, const W: usize> {
    offset_m: ColumnReader<'a, N, W>,
    first: usize,
    /// Overlaps of this size and less are none.
    slightest_m: [N; W],
    starting: bool,
    x: [&'a [[N; W]]; 2],
    v: [&'a [[N; W]]; 2],
}

impl<'a, N: Number<W>, const W: usize> Sides<'a, N, W> {
    /// Of `count` chunks of contacts from `first` on.
    #[inline(always)]
    pub(super) fn new(place: &SweepPlace<'a, N, W>, first: usize, count: usize) -> Self {
        let part = |values: &'a [N], from: usize| -> &'a [[N; W]] {
            &values[from..].as_chunks().0[..count]
        };
        let pair = |values: &'a [N]| {
            let left = first * W;
            [part(values, left), part(values, left + place.lanes)]
        };
        Self {
            offset_m: place.offset_m.reader(),
            first,
            slightest_m: place.slightest_m,
            starting: place.starting,
            x: pair(place.x),
            v: pair(place.v),
        }
    }

    /// Chunk `i` of them: closed ⇔ δ > 0, or δ = 0 and approaching. The latter
    /// can only be at the start: whatever approaches from contact overlaps a
    /// step later.
    #[inline(always)]
    pub(super) fn touch<S: Simd>(&self, simd: S, i: usize) -> LaneTouch<N::Wide<S>> {
        let load = |chunk: &[N; W]| N::Wide::<S>::load_array_ref(simd, chunk);
        let apart = load(&self.x[1][i]) - load(&self.x[0][i]);
        let depth = load(self.offset_m.at(self.first + i)) - apart;
        self.touch_at(simd, i, depth, self.starting)
    }

    /// The same in a chain without gaps and loads that has been set in motion.
    #[inline(always)]
    pub(super) fn plain_touch<S: Simd>(&self, simd: S, i: usize) -> LaneTouch<N::Wide<S>> {
        let load = |chunk: &[N; W]| N::Wide::<S>::load_array_ref(simd, chunk);
        let depth = load(&self.x[0][i]) - load(&self.x[1][i]);
        self.touch_at(simd, i, depth, false)
    }

    #[inline(always)]
    fn touch_at<S: Simd>(
        &self,
        simd: S,
        i: usize,
        depth: N::Wide<S>,
        starting: bool,
    ) -> LaneTouch<N::Wide<S>> {
        let load = |chunk: &[N; W]| N::Wide::<S>::load_array_ref(simd, chunk);
        let zero = N::Wide::<S>::simd_from(simd, N::default());
        let across = load(&self.v[0][i]) - load(&self.v[1][i]);
        let deep = depth.simd_gt(load(&self.slightest_m));
        let overlap = deep.select(depth, zero);
        let closed = match starting {
            true => deep | (depth.simd_ge(zero) & across.simd_gt(zero)),
            false => deep,
        };
        LaneTouch {
            depth,
            overlap,
            root: N::roots(simd, overlap, deep.to_bitmask()),
            rate: closed.select(across, zero),
            across,
        }
    }
}

/// Notes which contacts of a chunk are open, where that is followed.
#[inline(always)]
pub(super) fn note_open<S: Simd, N: Number<W>, const W: usize>(
    simd: S,
    open: Option<&mut u64>,
    touch: &LaneTouch<N::Wide<S>>,
) {
    if let Some(open) = open {
        let zero = N::Wide::<S>::simd_from(simd, N::default());
        *open = touch.depth.simd_lt(zero).to_bitmask();
    }
}
