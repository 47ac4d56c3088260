//! Shots that were computed before.

use crate::claims::Point;
use hertzchain_sim::Plan;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Mutex, PoisonError};

/// Remembers shots by everything that decides them, each as every pick times it:
/// many readings leave many of the paper's chains as they are.
#[derive(Debug, Default)]
pub struct Memory(Mutex<HashMap<[u64; 2], Vec<Point>>>);

impl Memory {
    /// The remembered points of a plan, one a pick.
    pub(super) fn recall(&self, plan: &Plan) -> Option<Vec<Point>> {
        let key = key(plan);
        self.lock().get(&key).cloned()
    }

    /// Remembers the points of a plan.
    pub(super) fn keep(&self, plan: &Plan, points: &[Point]) {
        let key = key(plan);
        self.lock().insert(key, points.to_vec());
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, HashMap<[u64; 2], Vec<Point>>> {
        // A panic elsewhere leaves whole points behind.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Two independent hashes of a plan as written out, numbers to the last bit:
/// among the thousands of plans of a scan no two share both.
fn key(plan: &Plan) -> [u64; 2] {
    let text = format!("{plan:?}");
    [0_u8, 1].map(|salt| {
        let mut hasher = DefaultHasher::new();
        salt.hash(&mut hasher);
        text.hash(&mut hasher);
        hasher.finish()
    })
}
