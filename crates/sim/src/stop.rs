//! Cancellation and progress of long work.

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

thread_local! {
    static OWN: RefCell<Option<Stop>> = const { RefCell::new(None) };
}

/// A request to stop, which all threads of a pool check between blocks of
/// a batch and between steps of a shot, and counters of what is done.
///
/// What is stopped ends with [`crate::StudyError::Stopped`]; nothing of it counts.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<Shared>);

#[derive(Debug, Default)]
struct Shared {
    asked: AtomicBool,
    done: AtomicU64,
    steps: AtomicU64,
    note: Mutex<String>,
    /// The note is of a single shot.
    of_shot: AtomicBool,
    watch: Option<fn(&Stop)>,
}

impl Stop {
    /// Returns a request that calls a function whenever a counter or the note has changed.
    pub fn watched(watch: fn(&Self)) -> Self {
        Self(Arc::new(Shared { watch: Some(watch), ..Shared::default() }))
    }

    /// Asks everything in the pool to stop.
    pub fn ask(&self) {
        self.0.asked.store(true, Ordering::Relaxed);
    }

    /// Whether that was asked.
    pub fn is_asked(&self) -> bool {
        self.0.asked.load(Ordering::Relaxed)
    }

    /// Counts so many more as done, from any thread; what a single shot noted gives way to the count.
    pub fn count(&self, more: u64) {
        self.0.done.fetch_add(more, Ordering::Relaxed);
        if self.0.of_shot.load(Ordering::Relaxed) {
            self.set_note(String::new(), false);
        }
    }

    fn set_note(&self, note: String, of_shot: bool) {
        *self.0.note.lock().unwrap_or_else(PoisonError::into_inner) = note;
        self.0.of_shot.store(of_shot, Ordering::Relaxed);
    }

    /// Steps of single shots so far, to some dozens.
    pub fn steps(&self) -> u64 {
        self.0.steps.load(Ordering::Relaxed)
    }

    /// How many are done.
    pub fn done(&self) -> u64 {
        self.0.done.load(Ordering::Relaxed)
    }

    /// How far long work is, in words; empty where nothing was noted.
    pub fn note(&self) -> String {
        let note = self.0.note.lock().unwrap_or_else(PoisonError::into_inner);
        note.clone()
    }

    /// Threads that check this request, all cores' if 0 are asked for.
    ///
    /// # Errors
    /// When the system gives no threads.
    pub fn pool(&self, threads: usize) -> Result<ThreadPool, ThreadPoolBuildError> {
        let stop = self.clone();
        let adopt = move |_| stop.clone().adopt();
        let builder = ThreadPoolBuilder::new().num_threads(threads);
        builder.start_handler(adopt).build()
    }

    /// Makes the calling thread check this request from now on.
    pub fn adopt(self) {
        OWN.with(|own| *own.borrow_mut() = Some(self));
    }
}

/// Whether the calling thread has been asked to stop.
pub fn stopped() -> bool {
    OWN.with(|own| own.borrow().as_ref().is_some_and(Stop::is_asked))
}

/// As many threads as asked for, all cores' if 0, that check the calling thread's request.
///
/// # Errors
/// When the system gives no threads.
pub fn pool(threads: usize) -> Result<ThreadPool, ThreadPoolBuildError> {
    OWN.with(|own| own.borrow().clone()).unwrap_or_default().pool(threads)
}

/// Counts so many more as done on the calling thread's [`Stop`], if it has one.
pub fn count_done(more: usize) {
    with_own(|stop| stop.count(more as u64));
}

/// Notes how far long work is on the calling thread's [`Stop`], if it has one.
pub fn note_progress(note: &dyn std::fmt::Display) {
    with_own(|stop| stop.set_note(note.to_string(), false));
}

/// The same of a single shot, where nothing is counted or noted of more than it.
pub(crate) fn note_shot(note: &dyn std::fmt::Display) {
    with_own(|stop| {
        let alone = stop.0.of_shot.load(Ordering::Relaxed) || stop.note().is_empty();
        if stop.done() == 0 && alone {
            stop.set_note(note.to_string(), true);
        }
    });
}

/// Counts steps of a shot in the same way.
pub(crate) fn count_steps(more: u64) {
    with_own(|stop| {
        stop.0.steps.fetch_add(more, Ordering::Relaxed);
    });
}

fn with_own(act: impl Fn(&Stop)) {
    OWN.with(|own| {
        if let Some(stop) = own.borrow().as_ref() {
            act(stop);
            if let Some(watch) = stop.0.watch {
                watch(stop);
            }
        }
    });
}
