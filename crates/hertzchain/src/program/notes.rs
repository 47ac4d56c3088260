//! How far long work is, on standard error.

use crate::program::failure::Failure;
use crate::program::print;
use hertzchain_sim::Stop;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// Time between lines.
const EVERY: Duration = Duration::from_secs(5);

/// Runs work with so many threads, and prints what it notes of its progress, whether or not
/// standard error is a terminal.
pub(crate) fn with_notes<T: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> T + Send,
) -> Result<T, Failure> {
    let stop = Stop::default();
    let pool = stop.pool(threads.unwrap_or(0));
    let pool = pool.map_err(|error| Failure::Ours(format!("threads: {error}")))?;
    let (working, ended) = channel::<()>();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            let mut last = String::new();
            while ended.recv_timeout(EVERY) == Err(RecvTimeoutError::Timeout) {
                let note = match (stop.note(), stop.done()) {
                    (note, 1..) if note.is_empty() => {
                        format!("{} curves of the model computed", stop.done())
                    }
                    (note, _) => note,
                };
                if note != last {
                    print::note(&note);
                    last = note;
                }
            }
        });
        let found = pool.install(work);
        drop(working);
        Ok(found)
    })
}
