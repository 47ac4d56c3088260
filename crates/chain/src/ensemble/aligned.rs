//! Numbers that begin where a cache line does.
//!
//! A chunk of eight is a cache line. Were it to straddle two, each load and
//! store of it would cost two.

use std::ops::{Deref, DerefMut};

/// Bytes of a cache line.
const LINE: usize = 64;

/// Room to move the first number to the beginning of a line.
const SPARE: usize = LINE / size_of::<f64>();

/// A vector of fixed length, aligned to cache lines.
#[derive(Debug, Default)]
pub(super) struct Aligned {
    values: Vec<f64>,
    first: usize,
    length: usize,
}

impl Aligned {
    /// That many times a value.
    pub fn of(value: f64, length: usize) -> Self {
        let values = vec![value; length + SPARE];
        // Where alignment cannot be told, any place will do.
        let first = values.as_ptr().align_offset(LINE).min(SPARE);
        Self {
            values,
            first,
            length,
        }
    }
}

impl Deref for Aligned {
    type Target = [f64];

    #[inline(always)]
    fn deref(&self) -> &[f64] {
        &self.values[self.first..self.first + self.length]
    }
}

impl DerefMut for Aligned {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.values[self.first..self.first + self.length]
    }
}
