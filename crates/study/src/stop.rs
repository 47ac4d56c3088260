//! Breaking off what takes long.

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

thread_local! {
    static OWN: RefCell<Option<Stop>> = const { RefCell::new(None) };
}

/// A wish to break off, which all threads of a pool look at: between blocks of
/// an ensemble, between steps of a shot.
///
/// What is broken off ends with [`crate::StudyError::Stopped`]; nothing of it counts.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Asks everything in the pool to break off.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether that was asked.
    #[must_use]
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Threads that look at this wish, all cores' if 0 are asked for.
    ///
    /// # Errors
    /// When the system gives no threads.
    pub fn pool(&self, threads: usize) -> Result<ThreadPool, ThreadPoolBuildError> {
        let stop = self.clone();
        let adopt = move |_| stop.clone().adopt();
        let builder = ThreadPoolBuilder::new().num_threads(threads);
        builder.start_handler(adopt).build()
    }

    /// Makes the calling thread look at this wish from now on.
    pub fn adopt(self) {
        OWN.with(|own| *own.borrow_mut() = Some(self));
    }
}

/// Whether the calling thread has been asked to break off; never where nobody
/// can ask.
#[must_use]
pub fn stopped() -> bool {
    OWN.with(|own| own.borrow().as_ref().is_some_and(Stop::is_asked))
}
