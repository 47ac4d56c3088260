//! A whole campaign: every series a file, several at once.

use crate::Shard;
use crate::rig::error::RigError;
use crate::rig::keep::{Folder, fingerprint};
use crate::rig::plan::{Plan, Series};
use crate::rig::recording;
use hertzchain_measure::records::untriggered;
use rayon::prelude::*;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// How far a campaign is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Shots fired in this run.
    pub fired: u64,
    /// Shots to be fired in this run.
    pub shots: u64,
}

/// What a run has done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Done {
    /// Series that were finished before.
    pub kept: usize,
    /// Series run now.
    pub run: usize,
    /// Shots fired now.
    pub shots: u64,
    /// Bytes of all files of this part.
    pub bytes: u64,
    /// Series that can't be computed, each with the reason; they have no file.
    pub failed: Vec<String>,
    /// Series of this part with shots whose trigger never fired, and how many of them.
    pub untriggered: Vec<(String, usize)>,
}

/// Runs the series of a part that a folder does not have yet, and calls
/// `watch` after every shot. Those that it has are opened and compared with what
/// this campaign would write. What a killed run has left under way is removed.
///
/// Files depend on neither the number of threads nor the order of series; a
/// run that is broken off and begun again ends with the same bytes. A series that
/// can't be computed is told in [`Done::failed`] and stops no other.
///
/// # Errors
/// A folder that can't be used, a file in it that is not this campaign's, a recording
/// that can't be written: finished files stay as they are.
pub fn campaign(
    plan: &Plan,
    out: &Path,
    shard: Shard,
    watch: &(dyn Fn(Progress) + Sync),
) -> Result<Done, RigError> {
    let folder = Folder::open(out, plan)?;
    folder.clear(plan);
    let dealt = plan.series.iter().enumerate();
    let part: Vec<&Series> = dealt
        .filter(|(at, _)| shard.holds(*at))
        .map(|(_, series)| series)
        .collect();
    let (done, due): (Vec<&Series>, Vec<&Series>) =
        part.iter().copied().partition(|series| folder.has(series));
    let fired = AtomicU64::new(0);
    let shots = plan.shots(due.len());
    let inputs = fingerprint(plan).short();
    for series in &done {
        recording::verify(plan, series, &folder.file(series), &inputs)?;
    }
    watch(Progress { fired: 0, shots });
    let series = due.par_iter().with_max_len(1).map(|series| {
        let seen = || {
            let fired = fired.fetch_add(1, Ordering::Relaxed) + 1;
            watch(Progress { fired, shots });
        };
        match recording::write(plan, series, &folder.file(series), &inputs, &seen) {
            // The others may be sound; a full disk would be full for them too.
            Err(error @ RigError::Shot { .. }) => Ok(Some(error.to_string())),
            written => written.map(|()| None),
        }
    });
    let failed: Vec<Option<String>> = series.collect::<Result<_, RigError>>()?;
    let failed: Vec<String> = failed.into_iter().flatten().collect();
    let size = |series: &&Series| folder.file(series).metadata().map_or(0, |data| data.len());
    let finished = part.iter().copied().filter(|series| folder.has(series));
    let untriggered: Result<Vec<(String, usize)>, RigError> = finished
        .map(|series| {
            let missed = untriggered(&folder.file(series)).map_err(RigError::NotOurs)?;
            Ok((series.name.clone(), missed))
        })
        .filter(|told| !matches!(told, Ok((_, 0))))
        .collect();
    Ok(Done {
        kept: done.len(),
        run: due.len() - failed.len(),
        shots: fired.load(Ordering::Relaxed),
        bytes: part.iter().map(size).sum(),
        failed,
        untriggered: untriggered?,
    })
}
