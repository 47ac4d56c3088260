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

/// A constant quantity.
#[derive(Debug)]
pub(super) struct Column {
    values: Aligned,
}

impl Column {
    /// From values of element `j` of lane `l`; `rest` where there is none.
    pub fn new(count: usize, lanes: usize, rest: f64, value: impl Fn(usize, usize) -> f64) -> Self {
        let mut values = Aligned::of(rest, chunks(count, lanes) * WIDTH);
        for j in 0..count {
            for lane in 0..lanes {
                values[j * lanes + lane] = value(j, lane);
            }
        }
        Self { values }
    }

    /// All numbers.
    #[inline(always)]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// All chunks.
    #[inline(always)]
    pub fn chunks(&self) -> &[[f64; WIDTH]] {
        self.values.as_chunks().0
    }
}
