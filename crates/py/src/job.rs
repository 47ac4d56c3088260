//! Long calls: without Python's lock, with progress, to be broken off.

use hertzchain::failure::Failure;
use hertzchain_sim::Stop;
use pyo3::prelude::*;
use std::fmt::Display;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{Builder, Result as Joined, scope};
use std::time::Duration;

use crate::failure::PyFailure;

/// How often Python is asked for signals, and progress is reported.
const LOOK: Duration = Duration::from_millis(20);

/// Room for deep calls, as a main thread has.
const STACK_BYTES: usize = 16 << 20;

/// A job's way to Python: to whom it reports what is done, and how it is stopped.
pub(crate) struct Job<'py> {
    /// Called with what is done since the last time.
    progress: Option<Bound<'py, PyAny>>,
    /// In how many threads of a pool, all cores' if 0; in one thread if `None`.
    threads: Option<usize>,
    /// Asked once Python wants no more.
    pub stop: Stop,
    /// What progress counts.
    counted: fn(&Stop) -> u64,
}

impl<'py> Job<'py> {
    /// With a pool of threads.
    pub(crate) fn pooled(progress: Option<Bound<'py, PyAny>>, threads: usize) -> Self {
        Self { progress, threads: Some(threads), ..Self::alone() }
    }

    /// In one thread, without progress.
    pub(crate) fn alone() -> Self {
        Self { progress: None, threads: None, stop: Stop::default(), counted: Stop::done }
    }

    /// In one thread, reporting of the steps of a single shot.
    pub(crate) fn of_steps(progress: Option<Bound<'py, PyAny>>) -> Self {
        Self { progress, counted: Stop::steps, ..Self::alone() }
    }

    /// Computes without Python's lock. A signal, or a progress that raises,
    /// breaks off and is raised. Progress is what is counted on the
    /// [`Stop`] that the work gets.
    pub(crate) fn run<T: Send>(
        self,
        py: Python<'py>,
        work: impl FnOnce(&Stop) -> Result<T, Failure> + Send,
    ) -> PyResult<T> {
        self.followed(py, |stop, threads, look| watched(stop, threads, work, look))
    }

    /// The same for work that leaves nothing behind but its result and has pieces that
    /// take long and look at no wish to stop: once there is one, no caller waits for the
    /// piece under way. Its thread ends with it.
    pub(crate) fn run_apart<T: Send + 'static>(
        self,
        py: Python<'py>,
        work: impl FnOnce(&Stop) -> Result<T, Failure> + Send + 'static,
    ) -> PyResult<T> {
        self.followed(py, |stop, threads, look| apart(stop, threads, work, look))
    }

    fn followed<T: Send>(
        self,
        py: Python<'py>,
        compute: impl FnOnce(&Stop, Option<usize>, Look<'_>) -> PyResult<Result<T, Failure>> + Send,
    ) -> PyResult<T> {
        let teller = self.progress.map(Bound::unbind);
        let (stop, threads, counted) = (self.stop, self.threads, self.counted);
        let reported = AtomicU64::new(0);
        let report = || {
            let done = counted(&stop);
            let news = done - reported.swap(done, Ordering::Relaxed);
            Python::attach(|py| match &teller {
                Some(teller) if news > 0 => teller.call1(py, (news,)).map(drop),
                _ => Ok(()),
            })
        };
        let look = || Python::attach(|py| py.check_signals()).and_then(|()| report());
        let outcome = py.detach(|| compute(&stop, threads, &look))?;
        report()?;
        Ok(outcome.map_err(PyFailure::from)?)
    }
}

/// Asks Python for signals and reports progress to it.
type Look<'a> = &'a (dyn Fn() -> PyResult<()> + Sync);

/// Works in another thread while this one looks after Python.
fn watched<T: Send>(
    stop: &Stop,
    threads: Option<usize>,
    work: impl FnOnce(&Stop) -> Result<T, Failure> + Send,
    look: Look<'_>,
) -> PyResult<Result<T, Failure>> {
    let (done, waiting) = channel::<()>();
    scope(|scope| {
        let work = move || computed(stop, threads, work, done);
        let worker = match Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, work) {
            Ok(worker) => worker,
            Err(error) => return Ok(Err(no_threads(&error))),
        };
        let looked = look_after(&waiting, look).inspect_err(|_| stop.ask());
        let outcome = joined(worker.join());
        looked.map(|()| outcome)
    })
}

/// The same in a thread that goes its own way once Python wants no more.
fn apart<T: Send + 'static>(
    stop: &Stop,
    threads: Option<usize>,
    work: impl FnOnce(&Stop) -> Result<T, Failure> + Send + 'static,
    look: Look<'_>,
) -> PyResult<Result<T, Failure>> {
    let (done, waiting) = channel::<()>();
    let own = stop.clone();
    let work = move || computed(&own, threads, work, done);
    let worker = match Builder::new().stack_size(STACK_BYTES).spawn(work) {
        Ok(worker) => worker,
        Err(error) => return Ok(Err(no_threads(&error))),
    };
    look_after(&waiting, look).inspect_err(|_| stop.ask())?;
    Ok(joined(worker.join()))
}

/// Looks after Python until a worker is done or Python wants no more.
fn look_after(worker: &Receiver<()>, look: Look<'_>) -> PyResult<()> {
    while worker.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
        look()?;
    }
    Ok(())
}

/// A worker's panic goes on in this thread.
fn joined<T>(outcome: Joined<T>) -> T {
    outcome.unwrap_or_else(|panic| resume_unwind(panic))
}

fn no_threads(error: &dyn Display) -> Failure {
    Failure::Ours(format!("threads: {error}"))
}

/// Dropping `_done` signals the end, by a panic too.
fn computed<T: Send>(
    stop: &Stop,
    threads: Option<usize>,
    work: impl FnOnce(&Stop) -> Result<T, Failure> + Send,
    _done: Sender<()>,
) -> Result<T, Failure> {
    let Some(count) = threads else {
        stop.clone().adopt();
        return work(stop);
    };
    let pool = stop.pool(count).map_err(|error| no_threads(&error))?;
    pool.install(|| work(stop))
}
