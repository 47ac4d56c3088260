//! The part of the chain that the waves have reached.

use super::column::{WIDTH, chunks};
use crate::system::System;

/// Under load, speeds below this fraction of the shot's are rounding of the
/// static forces and wake nothing.
const AT_REST_UNDER_LOAD: f64 = 1e-17;

/// Chunks from the striker on that move in any lane. A step moves one more
/// body, and only if a force reaches it.
#[derive(Clone, Debug)]
pub(super) struct Window {
    pub chunks: usize,
    all: usize,
    /// Speed of each lane that counts as motion.
    floor: [f64; WIDTH],
}

impl Window {
    pub fn new(systems: &[&System], (x, v): (&[f64], &[f64]), whole_chain: bool) -> Self {
        let lanes = systems.len();
        let all = chunks(systems[0].bodies(), lanes);
        let floor = |system: &System| {
            let loaded = system.static_force_n.iter().any(|&force| force != 0.0);
            f64::from(u8::from(loaded)) * AT_REST_UNDER_LOAD * system.scales().speed_m_s
        };
        let floor = std::array::from_fn(|lane| floor(systems[lane % lanes]));
        let moves = |at: &usize| x[*at] != 0.0 || v[*at] != 0.0;
        let last = (0..all * WIDTH).rev().find(moves).unwrap_or(0);
        let pulled = systems.iter().any(|s| s.slope_m_s2 != 0.0 || s.periodic);
        let mut window = Self {
            chunks: (last / WIDTH + 2).min(all),
            all,
            floor,
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
        if edge
            .iter()
            .zip(self.floor)
            .any(|(v, floor)| v.abs() > floor)
        {
            self.chunks += 1;
        }
    }
}
