//! What is improbable about the experiments that a verb loads.

use hertzchain_experiment::{Experiment, Warning};
use serde_json::Value;
use std::collections::HashSet;

/// Warnings about experiments at their own speeds, such as of units that are wrong, each once.
pub fn warnings<'a>(experiments: impl IntoIterator<Item = &'a Experiment>) -> Vec<Warning> {
    // What is wrong with an experiment is reported where it is used.
    let found = experiments.into_iter().filter_map(|of| Some(of.chain(None).ok()?.1));
    let mut all: Vec<Warning> = found.flatten().collect();
    let mut seen = HashSet::new();
    all.retain(|warning| seen.insert(warning.one_line()));
    all
}

/// The same for programs, a line each.
pub(crate) fn warnings_json<'a>(experiments: impl IntoIterator<Item = &'a Experiment>) -> Value {
    warnings(experiments).iter().map(Warning::one_line).collect()
}
