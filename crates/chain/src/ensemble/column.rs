//! Numbers of all lanes, laid out in chunks of eight.
//!
//! Element j of lane l sits at flat index j · lanes + l. With eight lanes a
//! chunk is one body (or contact) of every lane; with one lane it is eight
//! neighbours. Either way the right neighbour is `lanes` further on.

use super::aligned::Aligned;

/// Numbers in a chunk.
pub(super) const WIDTH: usize = 8;

/// Chunks that a quantity of `count` elements a lane takes.
pub(super) fn chunks(count: usize, lanes: usize) -> usize {
    (count * lanes).div_ceil(WIDTH)
}

/// A constant quantity: one chunk for all if all are equal, so that the nearest
/// cache holds what changes.
#[derive(Debug)]
pub(super) struct Column {
    values: Aligned,
    stride: usize,
}

impl Column {
    /// From values of element `j` of lane `l`; `rest` fills the last chunk up.
    pub fn new(count: usize, lanes: usize, rest: f64, value: impl Fn(usize, usize) -> f64) -> Self {
        let mut values = Aligned::of(rest, chunks(count, lanes) * WIDTH);
        for j in 0..count {
            for lane in 0..lanes {
                values[j * lanes + lane] = value(j, lane);
            }
        }
        let all = values.as_chunks::<WIDTH>().0;
        let equal = all.windows(2).all(|pair| pair[0] == pair[1]);
        Self {
            stride: usize::from(!equal),
            values,
        }
    }

    /// A reader of chunks.
    #[inline(always)]
    pub fn reader(&self) -> Reader<'_> {
        Reader {
            chunks: self.values.as_chunks().0,
            stride: self.stride,
        }
    }
}

/// Reads the chunks of a column.
#[derive(Clone, Copy)]
pub(super) struct Reader<'a> {
    chunks: &'a [[f64; WIDTH]],
    stride: usize,
}

impl<'a> Reader<'a> {
    /// Chunk `i`.
    #[inline(always)]
    pub fn at(self, i: usize) -> &'a [f64; WIDTH] {
        &self.chunks[i * self.stride]
    }
}
