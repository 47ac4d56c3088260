//! `hertzchain sweep --shard`: one part of a sweep, as a file.

use super::Arguments;
use crate::input::assumed;
use crate::program::print::print;
use crate::program::{Failure, lines, print};
use hertzchain_sim::{Batch, BatchResult, Column, Shard};
use std::path::Path;
use std::time::Instant;

/// Computes a part into the folder, unless it is there.
pub(crate) fn run(
    arguments: &Arguments,
    batch: &Batch,
    shard: Shard,
    progress: &(dyn Fn() + Sync),
) -> Result<(), Failure> {
    let folder = arguments.out.as_deref().unwrap_or(Path::new("."));
    let begun = Instant::now();
    let done = batch.run_into(folder, shard, progress)?;
    report_warnings(&done.result);
    let shots = done.result.rows.len();
    let what = match done.stored {
        true => "there already".to_owned(),
        false => format!("computed in {:.1} s", begun.elapsed().as_secs_f64()),
    };
    let assumed = lines(assumed(&arguments.input));
    print(&format!(
        "{assumed}Shard {shard} of {}\n{shots} shots, {what}: {}\n",
        done.result.about,
        done.path.display()
    ))
}

/// Warnings and failed shots, on the error stream.
pub(crate) fn report_warnings(part: &BatchResult) {
    let speed = |place: usize| {
        let at = place / part.shard.of();
        part.rows.column(Column::Speed).get(at).copied().unwrap_or(f64::NAN)
    };
    if let Some(warnings) = &part.rows.warnings {
        print::warn(&warnings.lines);
        match warnings.shots {
            0 | 1 => {}
            shots => print::warn([format!("there are warnings at {shots} speeds")]),
        }
    }
    for failed in &part.rows.failed {
        let place = speed(failed.place);
        print::warn([format!("no shot at {place}: {}", failed.why)]);
    }
}
