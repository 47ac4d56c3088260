//! One shard into a folder.

use crate::shards::error::ShardsError;
use crate::shards::file::{read, write};
use crate::shards::gather::ENDING;
use crate::{Part, Run, Shard, stopped};
use std::fs;
use std::path::{Path, PathBuf};

/// What became of a shard.
#[derive(Clone, Debug)]
pub struct Done {
    /// Its file.
    pub path: PathBuf,
    /// Whether it was there before, whole.
    pub kept: bool,
    /// Its shots.
    pub part: Part,
}

/// Computes a shard into a folder, which is made if need be; one that is there
/// and whole is only read. `progress` is called after every shot, from any thread.
///
/// A shot that fails is a row of the shard like any other, with its reason; it
/// stops nothing.
///
/// # Errors
/// A folder or a file that can't be written.
pub fn run(
    run: &Run,
    shard: Shard,
    folder: &Path,
    progress: &(dyn Fn() + Sync),
) -> Result<Done, ShardsError> {
    fs::create_dir_all(folder).map_err(|error| ShardsError::Folder {
        path: folder.display().to_string(),
        error,
    })?;
    let empty = run.empty(shard);
    let path = folder.join(format!("{}{ENDING}", empty.name()));
    // What is not whole is written anew.
    if let Some(part) = read(&path).ok().filter(|part| same(part, &empty)) {
        return Ok(Done {
            path,
            kept: true,
            part,
        });
    }
    let part = run.part(shard, progress);
    if stopped() {
        return Err(ShardsError::Stopped);
    }
    Ok(Done {
        path: write(&part, folder)?,
        kept: false,
        part,
    })
}

/// The whole fingerprint: a name has a part of it.
fn same(found: &Part, asked: &Part) -> bool {
    found.run == asked.run && found.shard == asked.shard
}
