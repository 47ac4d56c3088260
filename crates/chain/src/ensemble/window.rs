//! The part of the chain that the waves have reached.

use super::column::{WIDTH, chunks};
use crate::system::System;

/// Chunks from the striker on that move in any lane. A step moves one more
/// body, and only if a force reaches it.
#[derive(Clone, Debug)]
pub(super) struct Window {
    pub chunks: usize,
    all: usize,
}

impl Window {
    pub fn new(systems: &[&System], (x, v): (&[f64], &[f64]), whole_chain: bool) -> Self {
        let lanes = systems.len();
        let all = chunks(systems[0].bodies(), lanes);
        let moves = |at: &usize| x[*at] != 0.0 || v[*at] != 0.0;
        let last = (0..all * WIDTH).rev().find(moves).unwrap_or(0);
        let pulled = systems.iter().any(|s| s.slope_m_s2 != 0.0 || s.periodic);
        let mut window = Self {
            chunks: (last / WIDTH + 2).min(all),
            all,
        };
        if whole_chain || pulled {
            window.chunks = all;
        }
        window
    }

    /// Wakes the next chunk once the last one moves.
    pub fn follow(&mut self, v: &[f64]) {
        if self.chunks == self.all {
            return;
        }
        let edge = &v[(self.chunks - 1) * WIDTH..self.chunks * WIDTH];
        if edge.iter().any(|&v| v != 0.0) {
            self.chunks += 1;
        }
    }

    /// All chunks.
    pub fn whole(&self) -> Self {
        let all = self.all;
        Self { chunks: all, all }
    }
}
