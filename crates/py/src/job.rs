//! Long calls: without Python's lock, with progress, to be broken off.

use hertzchain_study::Stop;
use hertzchain_verbs::failure::Failure;
use pyo3::prelude::*;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::{Builder, scope};
use std::time::Duration;

use crate::failure::Failed;

/// How often Python is asked for signals and told of progress.
const LOOK: Duration = Duration::from_millis(20);

/// Room for deep calls, as a main thread has.
const STACK_BYTES: usize = 16 << 20;

/// Where a job is computed.
#[derive(Clone, Copy, Debug)]
pub enum Threads {
    /// In one thread.
    One,
    /// In so many, all cores' if 0.
    Many(usize),
}

/// A job's way to Python: whom it tells what is done, and how it is stopped.
pub struct Job<'py> {
    /// Called with what is done since the last time.
    pub progress: Option<Bound<'py, PyAny>>,
    /// Where it is computed.
    pub threads: Threads,
    /// Asked once Python wants no more.
    pub stop: Stop,
    /// What progress is told of.
    counted: fn(&Stop) -> u64,
}

impl<'py> Job<'py> {
    /// With a pool of threads.
    pub fn pooled(progress: Option<Bound<'py, PyAny>>, threads: usize) -> Self {
        Self {
            progress,
            threads: Threads::Many(threads),
            stop: Stop::default(),
            counted: Stop::done,
        }
    }

    /// In one thread, without progress.
    pub fn alone() -> Self {
        Self {
            progress: None,
            threads: Threads::One,
            stop: Stop::default(),
            counted: Stop::done,
        }
    }

    /// In one thread, telling of the steps of a single shot.
    pub fn of_steps(progress: Option<Bound<'py, PyAny>>) -> Self {
        Self {
            progress,
            counted: Stop::steps,
            ..Self::alone()
        }
    }

    /// Computes without Python's lock. A signal, or a progress that raises,
    /// breaks off and is raised. Progress is told of what is counted on the
    /// [`Stop`] that the work gets.
    ///
    /// # Errors
    /// What Python raised meanwhile, or what `work` says.
    pub fn run<T: Send>(
        self,
        py: Python<'py>,
        work: impl FnOnce(&Stop) -> Result<T, Failure> + Send,
    ) -> PyResult<T> {
        let teller = self.progress.map(Bound::unbind);
        let (stop, threads, counted) = (self.stop, self.threads, self.counted);
        let told = AtomicU64::new(0);
        let tell = || {
            let done = counted(&stop);
            let news = done - told.swap(done, Ordering::Relaxed);
            Python::attach(|py| match &teller {
                Some(teller) if news > 0 => teller.call1(py, (news,)).map(drop),
                _ => Ok(()),
            })
        };
        let look = || Python::attach(|py| py.check_signals()).and_then(|()| tell());
        let (outcome, raised) = py.detach(|| watched(&stop, threads, || work(&stop), look));
        match raised {
            Some(error) => Err(error),
            None => {
                tell()?;
                Ok(outcome.map_err(Failed::from)?)
            }
        }
    }
}

/// Works in another thread while this one looks after Python.
fn watched<T: Send>(
    stop: &Stop,
    threads: Threads,
    work: impl FnOnce() -> Result<T, Failure> + Send,
    look: impl Fn() -> PyResult<()>,
) -> (Result<T, Failure>, Option<PyErr>) {
    let (done, waiting) = channel::<()>();
    scope(|scope| {
        let worker = Builder::new().stack_size(STACK_BYTES);
        let worker = worker.spawn_scoped(scope, move || {
            let _told_when_dropped = done;
            computed(stop, threads, work)
        });
        let worker = match worker {
            Ok(worker) => worker,
            Err(error) => return (Err(Failure::Ours(format!("threads: {error}"))), None),
        };
        let mut raised = None;
        while waiting.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
            if raised.is_none()
                && let Err(error) = look()
            {
                stop.ask();
                raised = Some(error);
            }
        }
        match worker.join() {
            Ok(outcome) => (outcome, raised),
            Err(panic) => resume_unwind(panic),
        }
    })
}

fn computed<T: Send>(
    stop: &Stop,
    threads: Threads,
    work: impl FnOnce() -> Result<T, Failure> + Send,
) -> Result<T, Failure> {
    match threads {
        Threads::One => {
            stop.clone().adopt();
            work()
        }
        Threads::Many(count) => {
            let pool = stop.pool(count);
            let pool = pool.map_err(|error| Failure::Ours(format!("threads: {error}")))?;
            pool.install(work)
        }
    }
}
