//! What to measure next, computed beside the measuring of shots.

use crate::measure::MeasureResult;
use crate::options::{DesignOptions, LiveOptions, ModelOptions, ParameterOptions};
use crate::program::{Failure, failure, print};
use crate::{design, inference, sweep};
use hertzchain_measure::Shot;
use serde_json::json;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};

/// A shot, and all shots until then.
type Request = (Shot, MeasureResult);

/// Proposals of the next measurement, each printed when it is known.
pub(super) struct Proposals {
    requests: Sender<Request>,
    busy: Arc<AtomicBool>,
    worker: JoinHandle<Result<(), Failure>>,
}

impl Proposals {
    /// Starts if a model is named.
    pub(super) fn start(arguments: &LiveOptions) -> Result<Option<Self>, Failure> {
        let Some(model) = &arguments.model else { return Ok(None) };
        let modelled = ModelOptions::default().of_other(model);
        let free = arguments.free.clone();
        let freed = ParameterOptions { free, ..ParameterOptions::default() };
        let options = DesignOptions { modelled, freed, ..DesignOptions::default() };
        failure::print_improbable([&inference::experiment(&options.modelled, None)?]);
        let (requests, waiting) = channel();
        let json = arguments.measured.json;
        let busy = Arc::new(AtomicBool::new(false));
        let computing = busy.clone();
        let worker = thread::spawn(move || follow(&waiting, &options, json, &computing));
        Ok(Some(Self { requests, busy, worker }))
    }

    /// Asks for what follows a shot; while another is computed, the latest request waits alone.
    pub(super) fn ask(&self, shot: Shot, result: MeasureResult) {
        self.busy.store(true, Ordering::Relaxed);
        // A worker that has ended could not print; that is reported at the end.
        let _ended = self.requests.send((shot, result));
    }

    /// Whether a proposal is being computed that the user may wait for.
    pub(super) fn is_busy(&self) -> bool {
        self.busy.load(Ordering::Relaxed) && !self.worker.is_finished()
    }

    /// Waits for the last proposal.
    pub(super) fn finish(self) -> Result<(), Failure> {
        drop(self.requests);
        let broken = |_| Failure::Ours("proposing measurements was broken off".to_owned());
        self.worker.join().map_err(broken)?
    }
}

fn follow(
    waiting: &Receiver<Request>,
    options: &DesignOptions,
    json: bool,
    busy: &AtomicBool,
) -> Result<(), Failure> {
    // Threads of its own, so that it keeps no shot from being measured.
    let pool = sweep::pool(None)?;
    while let Ok(first) = waiting.recv() {
        busy.store(true, Ordering::Relaxed);
        let (shot, result) = waiting.try_iter().last().unwrap_or(first);
        let next = pool.install(|| proposed(&result, &shot.case, options));
        match json {
            true => print::print(&line_json(&shot, &next))?,
            false => print::print(&line_text(&shot, &next))?,
        }
        busy.store(false, Ordering::Relaxed);
    }
    Ok(())
}

/// What the model would measure next, by name.
fn proposed(
    result: &MeasureResult,
    case: &str,
    options: &DesignOptions,
) -> Result<String, Failure> {
    let experiment = inference::experiment(&options.modelled, Some(case))?;
    let (_, found) = design::design(&result.curve(case)?, &experiment, options)?;
    let best = found.design.ranked.first().map(|best| &found.candidates[best.candidate]);
    best.map(|best| best.name.clone()).ok_or_else(|| Failure::User("nothing would help".to_owned()))
}

fn line_text(shot: &Shot, next: &Result<String, Failure>) -> String {
    let name = super::name(shot);
    match next {
        Ok(best) => format!("  next after {name}: {best}\n"),
        Err(error) => format!("  next after {name}: not known yet: {error}\n"),
    }
}

fn line_json(shot: &Shot, next: &Result<String, Failure>) -> String {
    let line = json!({
        "shot": { "file": shot.file.display().to_string(), "shot": shot.shot, "case": shot.case },
        "next": next.as_ref().ok(),
        "next_missing": next.as_ref().err().map(ToString::to_string),
    });
    line.to_string()
}
