//! What can be wrong with shards, told to people.

use hertzchain_measure::records::RecordError;
use std::io;

/// Why shards can't be written, read or put together.
#[derive(Debug, thiserror::Error)]
pub enum ShardsError {
    /// It was broken off: nothing is written.
    #[error("the shard was broken off")]
    Stopped,
    /// A folder that can't be used.
    #[error("cannot use {path}: {error}")]
    Folder {
        /// Which one.
        path: String,
        /// What the system says.
        error: io::Error,
    },
    /// A file that can't be written.
    #[error(transparent)]
    Unwritable(RecordError),
    /// A file that is no shard, or not whole.
    #[error("{file} is no whole shard of a sweep: {why}; remove it and run its shard again")]
    Damaged {
        /// Which one.
        file: String,
        /// What is wrong with it.
        why: String,
    },
    /// No shard anywhere.
    #[error(
        "no shards in {0}: expected files that `hertzchain sweep --shard i/n --out DIR` has written"
    )]
    Nothing(String),
    /// Shards that do not belong together.
    #[error(
        "shards of {} different runs do not mix:\n{}give the folders of one run, or move the others' files away",
        .0.len(), lines(.0)
    )]
    SeveralRuns(Vec<String>),
    /// Two files of one shard that are not the same.
    #[error(
        "{one} and {other} are the same shard with other numbers: one of them is damaged, or was made on \
         a machine whose mathematical library differs; remove one and run its shard again"
    )]
    Differ {
        /// One file.
        one: String,
        /// The other.
        other: String,
    },
    /// Not all shards are there.
    #[error(
        "{} of {of} shards are missing of {about}: {}; run the same command with --shard {}/{of}{}{}",
        .missing.len(), ranges(.missing), .missing.first().unwrap_or(&1), array(.missing), damage(.damaged)
    )]
    Missing {
        /// The run in words.
        about: String,
        /// How many shards it has.
        of: usize,
        /// Numbers of those that are missing, from 1, ascending.
        missing: Vec<usize>,
        /// Files that are no whole shards, with why.
        damaged: Vec<String>,
    },
}

fn lines(texts: &[String]) -> String {
    texts.iter().map(|text| format!("  {text}\n")).collect()
}

fn array(missing: &[usize]) -> String {
    match missing.len() {
        0 | 1 => String::new(),
        _ => format!(
            " and so on, or in a Slurm array --array={}",
            ranges(missing)
        ),
    }
}

fn damage(damaged: &[String]) -> String {
    match damaged.is_empty() {
        true => String::new(),
        false => format!("\nnot counted, as they are not whole:\n{}", lines(damaged)),
    }
}

/// Ascending numbers as Slurm has them: 2,5-7.
pub(crate) fn ranges(numbers: &[usize]) -> String {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for &number in numbers {
        match runs.last_mut() {
            Some((_, last)) if *last + 1 == number => *last = number,
            _ => runs.push((number, number)),
        }
    }
    let text = |(first, last): &(usize, usize)| match first == last {
        true => first.to_string(),
        false => format!("{first}-{last}"),
    };
    runs.iter().map(text).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
#[path = "tests/error.rs"]
mod tests;
