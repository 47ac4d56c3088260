//! How far long work is, on standard error.

use crate::options::Threads;
use crate::program::{Failure, print};
use hertzchain_measure::Watch;
use hertzchain_paper::reproduce::ReproduceProgress;
use hertzchain_sim::Stop;
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

const EVERY: Duration = Duration::from_secs(5);

/// Counted work: a bar in a terminal, a line every few seconds elsewhere.
pub(crate) struct Counter {
    bar: ProgressBar,
    /// When the stage began, and when a line was last printed.
    since: Mutex<(Instant, Instant)>,
}

impl Counter {
    /// Counts so many of what is named; 0 if their number is not known.
    pub(crate) fn new(what: &str, length: u64) -> Self {
        let bar = ProgressBar::no_length();
        let style = ProgressStyle::with_template("{msg:32} {wide_bar} {pos}/{len} {eta} left");
        style.into_iter().for_each(|style| bar.set_style(style));
        let counter = Self { bar, since: Mutex::new((Instant::now(), Instant::now())) };
        counter.begin(what, length);
        counter
    }

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn line(&self, elapsed: Duration) -> String {
        let (what, done) = (self.bar.message(), self.bar.position());
        let rate_hz = done as f64 / elapsed.as_secs_f64();
        match self.bar.length() {
            Some(length) if length >= done => format!(
                "{what}: {done} of {length}, {rate_hz:.1} a second, {:.0} s left",
                (length - done) as f64 / rate_hz
            ),
            _ => format!("{what}: {done}, {rate_hz:.1} a second"),
        }
    }
}

impl ReproduceProgress for Counter {
    fn begin(&self, what: &str, length: u64) {
        self.bar.reset();
        self.bar.set_length(length);
        self.bar.set_message(what.to_owned());
        *self.since.lock().unwrap_or_else(PoisonError::into_inner) =
            (Instant::now(), Instant::now());
    }

    fn advance(&self) {
        self.bar.inc(1);
        let mut since = self.since.lock().unwrap_or_else(PoisonError::into_inner);
        if self.bar.is_hidden() && since.1.elapsed() > EVERY {
            since.1 = Instant::now();
            print::note(&self.line(since.0.elapsed()));
        }
    }

    fn note(&self, text: &str) {
        self.bar.suspend(|| print::note(text));
    }
}

impl Watch for Counter {
    fn seen(&self) {
        self.advance();
    }
}

/// Runs work with so many threads, and prints what it notes of its progress, whether or not
/// standard error is a terminal.
pub(crate) fn with_notes<T: Send>(
    threads: Option<Threads>,
    work: impl FnOnce() -> Result<T, Failure> + Send,
) -> Result<T, Failure> {
    let stop = Stop::default();
    let pool = stop.pool(threads.map_or(0, |threads| threads.0));
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
        found
    })
}

#[cfg(test)]
mod tests {
    use super::{Counter, EVERY};
    use hertzchain_paper::reproduce::ReproduceProgress;

    #[test]
    fn a_line_has_rate_and_time_left() {
        let counter = Counter::new("shots", 32);
        (0..8).for_each(|_| counter.advance());
        assert_eq!(counter.line(2 * EVERY), "shots: 8 of 32, 0.8 a second, 30 s left");
    }

    #[test]
    fn work_of_unknown_length_has_no_time_left() {
        let counter = Counter::new("records", 0);
        (0..8).for_each(|_| counter.advance());
        assert_eq!(counter.line(2 * EVERY), "records: 8, 0.8 a second");
    }
}
