//! The options of a run, left in its output folder for the run that goes on with it.

use super::{Arguments, CHAIN};
use crate::failure::Failure;
use hertzchain_measure::records::write_whole;
use std::fs;
use std::path::Path;

/// Where the options stand.
const OPTIONS: &str = "options.json";

/// Options that may differ where a run goes on: how far it goes.
const MAY_DIFFER: [&str; 1] = ["--steps"];

/// Leaves the options of a new run; of one that goes on, sees that they are the same, so
/// that what is recorded of it is true.
///
/// # Errors
/// Options that differ from those of the run before, by name; a folder that can't be used.
pub(super) fn left(arguments: &Arguments) -> Result<(), Failure> {
    let Some(out) = &arguments.out else {
        return Ok(());
    };
    let path = out.join(OPTIONS);
    let words = arguments.words();
    if arguments.resume && path.exists() {
        let refused = |why: &dyn std::fmt::Display| {
            Failure::User(format!("--resume: {}: {why}", path.display()))
        };
        let text = fs::read_to_string(&path).map_err(|error| refused(&error))?;
        let before: Vec<String> = serde_json::from_str(&text).map_err(|error| refused(&error))?;
        let differ = differing(&before, &words);
        if !differ.is_empty() {
            return Err(Failure::User(format!(
                "--resume goes on with the run that {} holds, which had other options: {}. Give the same again, or leave \
                 --resume out to begin anew",
                out.display(),
                differ.join("; ")
            )));
        }
    }
    let ours = |error: &dyn std::fmt::Display| Failure::Ours(error.to_string());
    fs::create_dir_all(out).map_err(|error| ours(&error))?;
    let text = serde_json::to_vec(&words).map_err(|error| ours(&error))?;
    write_whole(&path, |file| file.write_all(&text)).map_err(|error| ours(&error))
}

/// Forgets them where nothing is left to go on with.
pub(super) fn finished(out: &Path) {
    if !out.join(CHAIN).exists() {
        // What stays does no harm: a new run writes its own.
        let _ = fs::remove_file(out.join(OPTIONS));
    }
}

/// What stands in one list of options and not in the other, in words.
fn differing(before: &[String], now: &[String]) -> Vec<String> {
    let told = |one: &[String], other: &[String], when: &str| {
        let may = |word: &&String| MAY_DIFFER.contains(&word.split('=').next().unwrap_or(word));
        let only = one.iter().filter(|word| !other.contains(word));
        let only: Vec<String> = only.filter(|word| !may(word)).cloned().collect();
        (!only.is_empty()).then(|| format!("{when} {}", only.join(" ")))
    };
    let both = [told(before, now, "then"), told(now, before, "now")];
    both.into_iter().flatten().collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]
#[path = "tests/words.rs"]
mod tests;
