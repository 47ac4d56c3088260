//! `hertzchain merge`: shards of several machines put together.

use super::sweep;
use crate::program::arguments::Merge as Arguments;
use crate::program::print::print;
use crate::program::{Failure, Folder};
use hertzchain_sim::BatchResult;
use hertzchain_sim::rig::{CAMPAIGN_FILE, plan_of_folder};
use indicatif::HumanBytes;
use std::path::Path;

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let folders: Vec<&Path> = arguments.folders.iter().map(AsRef::as_ref).collect();
    match folders.iter().find(|folder| folder.join(CAMPAIGN_FILE).is_file()) {
        Some(folder) => campaign(folder, &folders, &arguments.out),
        None => merge_sweep(&folders, arguments),
    }
}

fn campaign(first: &Path, folders: &[&Path], out: &Path) -> Result<(), Failure> {
    let plan = plan_of_folder(first)?;
    let merged = hertzchain_sim::rig::merge(&plan, folders, out)?;
    print(&format!(
        "{} series of {}, {} of them copied now; {} of recordings in {}; seed {}.\n",
        merged.series,
        plan.experiment.title(),
        merged.copied,
        HumanBytes(merged.bytes),
        out.display(),
        plan.seed,
    ))
}

fn merge_sweep(folders: &[&Path], arguments: &Arguments) -> Result<(), Failure> {
    let part = BatchResult::gather(folders, None)?;
    let folder = Folder::open(&arguments.out, &[sweep::SWEEP], arguments.force)?;
    sweep::report_warnings(&part);
    sweep::print_table(&part)?;
    sweep::write(folder, &part)?;
    match sweep::nothing(&part) {
        true => Err(Failure::User("no speed gave a shot".into())),
        false => Ok(()),
    }
}
