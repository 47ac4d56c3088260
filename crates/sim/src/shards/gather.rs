//! Shards of some folders put together.

use crate::shards::error::ShardsError;
use crate::shards::file::read;
use crate::{Fingerprint, Part, Rows, Shard};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// How names of shards begin.
pub const PREFIX: &str = "sweep-";

/// How names of shards end.
pub const ENDING: &str = ".h5";

/// Whether a file is called like a shard of a sweep.
#[must_use]
pub fn is_shard(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.starts_with(PREFIX) && name.ends_with(ENDING) && name.contains("-of-")
}

/// The shards of a run by their numbers from 1, each with its file.
type Found = BTreeMap<usize, (PathBuf, Part)>;

/// Puts all shards of the one run in these folders together: the part that is
/// the whole, with the bits of a run that was never cut.
///
/// Where the run was cut in several ways, one whole set of shards is enough.
///
/// # Errors
/// [`ShardsError::Missing`] with what is missing; shards of several runs; two
/// that should be the same and are not; no shards at all.
pub fn gather(folders: &[&Path]) -> Result<Part, ShardsError> {
    let mut damaged = Vec::new();
    let mut cuts: BTreeMap<(Fingerprint, usize), Found> = BTreeMap::new();
    for path in files(folders)? {
        let part = match read(&path) {
            Ok(part) => part,
            Err(error) => {
                damaged.push(error.to_string());
                continue;
            }
        };
        let found = cuts.entry((part.run, part.shard.of())).or_default();
        let number = part.shard.number();
        match found.get(&number) {
            Some((other, same)) if !equal(same, &part) => {
                return Err(ShardsError::Differ {
                    one: other.display().to_string(),
                    other: path.display().to_string(),
                });
            }
            _ => found.insert(number, (path, part)),
        };
    }
    one_run(&cuts)?;
    let fewest = cuts
        .into_iter()
        .min_by_key(|((_, of), found)| of - found.len());
    match fewest {
        Some(((_, of), found)) => whole(of, found, damaged),
        None if damaged.is_empty() => Err(ShardsError::Nothing(names(folders))),
        None => Err(ShardsError::Nothing(format!(
            "{}\n{}",
            names(folders),
            damaged.join("\n")
        ))),
    }
}

fn names(folders: &[&Path]) -> String {
    let names = folders.iter().map(|folder| folder.display().to_string());
    names.collect::<Vec<_>>().join(", ")
}

/// Files called like shards, by name.
fn files(folders: &[&Path]) -> Result<BTreeSet<PathBuf>, ShardsError> {
    let mut files = BTreeSet::new();
    for folder in folders {
        let refused = |error| ShardsError::Folder {
            path: folder.display().to_string(),
            error,
        };
        for entry in fs::read_dir(folder).map_err(refused)? {
            files.insert(entry.map_err(refused)?.path());
        }
    }
    files.retain(|path| is_shard(path));
    Ok(files)
}

fn one_run(cuts: &BTreeMap<(Fingerprint, usize), Found>) -> Result<(), ShardsError> {
    let mut runs: BTreeMap<Fingerprint, (usize, String)> = BTreeMap::new();
    for ((run, _), found) in cuts {
        let about = found.values().next().map(|(_, part)| part.about.clone());
        let told = runs.entry(*run).or_insert((0, about.unwrap_or_default()));
        told.0 += found.len();
    }
    if runs.len() < 2 {
        return Ok(());
    }
    let told = runs.iter().map(|(run, (files, about))| {
        let short = run.short();
        format!("{files} files sweep-{short}-…: {about}")
    });
    Err(ShardsError::SeveralRuns(told.collect()))
}

/// Bit for bit, NaN included.
fn equal(one: &Part, other: &Part) -> bool {
    let bits = |part: &Part| {
        let values = part.rows.columns.iter().flatten();
        values.map(|value| value.to_bits()).collect::<Vec<u64>>()
    };
    bits(one) == bits(other) && one.rows.failed == other.rows.failed && one.tuned == other.tuned
}

fn whole(of: usize, found: Found, damaged: Vec<String>) -> Result<Part, ShardsError> {
    let missing: Vec<usize> = (1..=of)
        .filter(|number| !found.contains_key(number))
        .collect();
    let parts: Vec<Part> = found.into_values().map(|(_, part)| part).collect();
    match parts.first() {
        Some(first) if missing.is_empty() => {
            let rows: Vec<Rows> = parts.iter().map(|part| part.rows.clone()).collect();
            Ok(Part {
                shard: Shard::WHOLE,
                rows: Rows::dealt(&rows),
                ..first.clone()
            })
        }
        first => Err(ShardsError::Missing {
            about: first.map_or_else(String::new, |part| part.about.clone()),
            of,
            missing,
            damaged,
        }),
    }
}
