//! Numbers of all lanes, laid out in chunks of eight.
//!
//! Element j of lane l sits at flat index j · lanes + l. With eight lanes a
//! chunk is one body (or contact) of every lane; with one lane it is eight
//! neighbours. Either way the right neighbour is `lanes` further on.

/// Numbers in a chunk.
pub(super) const WIDTH: usize = 8;

/// Chunks that a quantity of `count` elements a lane takes.
pub(super) fn chunks(count: usize, lanes: usize) -> usize {
    (count * lanes).div_ceil(WIDTH)
}

/// A constant quantity: one chunk for all if all are equal, since what need
/// not be read leaves the nearest cache to what changes.
#[derive(Clone, Debug)]
pub(super) struct Column {
    chunks: Vec<[f64; WIDTH]>,
    stride: usize,
}

impl Column {
    /// From values of element `j` of lane `l`; `rest` where there is none.
    pub fn new(count: usize, lanes: usize, rest: f64, value: impl Fn(usize, usize) -> f64) -> Self {
        let mut chunks = vec![[rest; WIDTH]; chunks(count, lanes)];
        for j in 0..count {
            for lane in 0..lanes {
                let at = j * lanes + lane;
                chunks[at / WIDTH][at % WIDTH] = value(j, lane);
            }
        }
        Self { chunks, stride: 1 }
    }

    /// The same, kept as one chunk if all are equal.
    pub fn shared(mut self) -> Self {
        let same = self.chunks.windows(2).all(|pair| pair[0] == pair[1]);
        if same && !self.chunks.is_empty() {
            self.chunks.truncate(1);
            self.stride = 0;
        }
        self
    }

    /// Chunk `i`.
    #[inline(always)]
    pub fn at(&self, i: usize) -> &[f64; WIDTH] {
        &self.chunks[i * self.stride]
    }
}
