//! `hertzchain sweep --shard`: one part of a sweep, as a file.

use super::Arguments;
use crate::failure::Failure;
use crate::print::{self, print};
use crate::words::lines;
use hertzchain::input::assumed;
use hertzchain_sim::shards::ShardsError;
use hertzchain_sim::{Column, Part, Run, RunError, Shard};
use std::path::Path;
use std::time::Instant;

/// A run that can't be.
pub(crate) fn refused(error: RunError) -> Failure {
    match error {
        RunError::Mistakes(mistakes) => (*mistakes).into(),
        other => Failure::User(other.to_string()),
    }
}

/// Mistakes of the user and what a disk refuses.
pub(crate) fn failure(error: ShardsError) -> Failure {
    match error {
        ShardsError::Unwritable(error) => Failure::Ours(error.to_string()),
        other => Failure::User(other.to_string()),
    }
}

/// Computes a part into the folder, unless it is there.
pub(crate) fn run(
    arguments: &Arguments,
    run: &Run,
    shard: Shard,
    progress: &(dyn Fn() + Sync),
) -> Result<(), Failure> {
    let folder = arguments.out.as_deref().unwrap_or(Path::new("."));
    let begun = Instant::now();
    let done = hertzchain_sim::shards::run(run, shard, folder, progress).map_err(failure)?;
    told(&done.part);
    let shots = done.part.rows.len();
    let what = match done.kept {
        true => "there already".to_owned(),
        false => format!("computed in {:.1} s", begun.elapsed().as_secs_f64()),
    };
    let assumed = lines(assumed(&arguments.input).into_iter().collect());
    print(&format!(
        "{assumed}Shard {shard} of {}\n{shots} shots, {what}: {}\n",
        done.part.about,
        done.path.display()
    ))
}

/// What is odd and which shots are none, on the error stream.
pub(crate) fn told(part: &Part) {
    let speed = |place: usize| {
        let at = place / part.shard.of();
        part.rows
            .column(Column::Speed)
            .get(at)
            .copied()
            .unwrap_or(f64::NAN)
    };
    if let Some(odd) = &part.rows.odd {
        for line in &odd.lines {
            print::note(&format!("warning: {line}"));
        }
        match odd.shots {
            0 | 1 => {}
            shots => print::note(&format!(
                "warning: there is something odd at {} speeds",
                shots
            )),
        }
    }
    for failed in &part.rows.failed {
        let place = speed(failed.place);
        print::note(&format!("warning: no shot at {place}: {}", failed.why));
    }
}
