//! Requests that are being answered: one a lane, a new one ends the one before.

use hertzchain_sim::Stop;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

/// Requests that wait or are answered, at most, and those that are answered.
const MOST_WAITING: usize = 24;
const MOST_RUNNING: usize = 3;

/// Longest name of a lane.
const LONGEST_LANE: usize = 64;

/// What is being answered.
pub(super) struct Jobs {
    lanes: Mutex<Lanes>,
    places: Arc<Semaphore>,
}

#[derive(Default)]
struct Lanes {
    next: u64,
    stops: HashMap<String, (u64, Stop)>,
}

impl Default for Jobs {
    fn default() -> Self {
        Self { lanes: Mutex::default(), places: Arc::new(Semaphore::new(MOST_RUNNING)) }
    }
}

/// A request's place in its lane. Dropping it asks its work to stop: so ends what a page that
/// went away has asked for.
pub(super) struct Job<'a> {
    jobs: &'a Jobs,
    lane: String,
    number: u64,
    pub(super) stop: Stop,
}

impl Jobs {
    fn lanes(&self) -> MutexGuard<'_, Lanes> {
        self.lanes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns a place in a lane, whose work so far is asked to stop; `None` if too many wait.
    pub(super) fn enter(&self, lane: &str) -> Option<Job<'_>> {
        let lane: String = lane.chars().take(LONGEST_LANE).collect();
        let mut lanes = self.lanes();
        if let Some((_, stale)) = lanes.stops.remove(&lane) {
            stale.ask();
        }
        if lanes.stops.len() >= MOST_WAITING {
            return None;
        }
        let (number, stop) = (lanes.next, Stop::default());
        lanes.next += 1;
        lanes.stops.insert(lane.clone(), (number, stop.clone()));
        drop(lanes);
        Some(Job { jobs: self, lane, number, stop })
    }

    /// Returns the work of a lane, if it has some.
    pub(super) fn of_lane(&self, lane: &str) -> Option<Stop> {
        self.lanes().stops.get(lane).map(|(_, stop)| stop.clone())
    }
}

impl Job<'_> {
    /// Waits until there is a core for this request.
    pub(super) async fn turn(&self) -> Option<OwnedSemaphorePermit> {
        let place = self.jobs.places.clone().acquire_owned().await.ok();
        place.filter(|_| !self.stop.is_asked())
    }
}

impl Drop for Job<'_> {
    fn drop(&mut self) {
        self.stop.ask();
        let mut lanes = self.jobs.lanes();
        let own = lanes.stops.get(&self.lane);
        if own.is_some_and(|(number, _)| *number == self.number) {
            lanes.stops.remove(&self.lane);
        }
    }
}
