//! Numbers of all lanes, laid out in chunks as long as a cache line.
//!
//! Element j of lane l sits at flat index j · lanes + l. With as many lanes as
//! a chunk is wide a chunk is one body (or contact) of every lane; with one
//! lane it is that many neighbours. Either way the right neighbour is `lanes`
//! further on.

use super::aligned::Aligned;
use super::number::Number;

/// Chunks that a quantity of `count` elements a lane takes.
pub(super) fn chunks<const W: usize>(count: usize, lanes: usize) -> usize {
    (count * lanes).div_ceil(W)
}

/// A constant quantity: one chunk for all if all are equal, so that the nearest
/// cache holds what changes.
#[derive(Debug)]
pub(super) struct LaneColumn<N, const W: usize> {
    values: Aligned<N>,
    stride: usize,
    /// What all its numbers are, if they are one.
    only: Option<N>,
}

impl<N: Number<W>, const W: usize> LaneColumn<N, W> {
    /// From values of element `j` of chain `l`: of all lanes, or of the one
    /// that all share. `rest` fills the last chunk up.
    pub(super) fn new(
        count: usize,
        (lanes, chains): (usize, usize),
        rest: f64,
        value: impl Fn(usize, usize) -> f64,
    ) -> Self {
        let mut values = Aligned::of(N::of(rest), chunks::<W>(count, lanes) * W);
        for (j, row) in values.chunks_exact_mut(lanes).take(count).enumerate() {
            match chains {
                1 => row.fill(N::of(value(j, 0))),
                _ => {
                    for (lane, cell) in row.iter_mut().enumerate() {
                        *cell = N::of(value(j, lane));
                    }
                }
            }
        }
        let all = values.as_chunks::<W>().0;
        let equal = all.windows(2).all(|pair| pair[0] == pair[1]);
        Self {
            stride: usize::from(!equal),
            only: values.first().copied().filter(|first| values.iter().all(|v| v == first)),
            values,
        }
    }

    /// All its chunks, if they are equal, as one.
    #[inline(always)]
    pub(super) fn uniform(&self) -> Option<&[N; W]> {
        self.values.as_chunks().0.first().filter(|_| self.stride == 0)
    }

    #[inline(always)]
    pub(super) fn is_all(&self, value: f64) -> bool {
        self.only == Some(N::of(value))
    }

    #[inline(always)]
    pub(super) fn reader(&self) -> ColumnReader<'_, N, W> {
        ColumnReader { chunks: self.values.as_chunks().0, stride: self.stride }
    }
}

#[derive(Clone, Copy)]
pub(super) struct ColumnReader<'a, N, const W: usize> {
    chunks: &'a [[N; W]],
    stride: usize,
}

impl<'a, N, const W: usize> ColumnReader<'a, N, W> {
    #[inline(always)]
    pub(super) fn all(&self) -> &'a [[N; W]] {
        self.chunks
    }

    #[inline(always)]
    pub(super) fn at(&self, i: usize) -> &'a [N; W] {
        &self.chunks[i * self.stride]
    }
}
