//! `hertzchain merge`: shards of several machines put together.

use super::sweep::{reported, shard};
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
        None => sweep(&folders, arguments),
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

fn sweep(folders: &[&Path], arguments: &Arguments) -> Result<(), Failure> {
    let part = BatchResult::gather(folders)?;
    let folder = Folder::open(&arguments.out, &[reported::SWEEP], arguments.force)?;
    shard::report_warnings(&part);
    reported::show(&part)?;
    reported::write(folder, &part)?;
    match reported::nothing(&part) {
        true => Err(Failure::User("no speed gave a shot".into())),
        false => Ok(()),
    }
}
