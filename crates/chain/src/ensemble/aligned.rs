//! Numbers that begin where a cache line does.
//!
//! A chunk is a cache line. Were it to straddle two, each load and
//! store of it would cost two.

use std::ops::{Deref, DerefMut};

/// Bytes of a cache line.
const LINE: usize = 64;

/// A vector of fixed length, aligned to cache lines.
#[derive(Debug, Default)]
pub(super) struct Aligned<T> {
    values: Vec<T>,
    first: usize,
    length: usize,
}

impl<T: Copy> Aligned<T> {
    pub(super) fn of(value: T, length: usize) -> Self {
        // Room to move the first number to the beginning of a line.
        let spare = LINE / size_of::<T>();
        let values = vec![value; length + spare];
        // Where alignment is not known, any place will do.
        let first = values.as_ptr().align_offset(LINE).min(spare);
        Self { values, first, length }
    }
}

impl<T> Deref for Aligned<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.values[self.first..self.first + self.length]
    }
}

impl<T> DerefMut for Aligned<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.values[self.first..self.first + self.length]
    }
}
