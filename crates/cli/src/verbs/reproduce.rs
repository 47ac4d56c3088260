//! `hertzchain reproduce`: everything in the paper.

use crate::arguments::Reproduce;
use crate::failure::Failure;
use crate::folder::Folder;

/// Runs the verb.
pub fn run(arguments: &Reproduce) -> Result<(), Failure> {
    let _ = arguments.readings;
    let _folder = Folder::open(&arguments.out)?;
    Err(Failure::Ours("not built in yet".into()))
}
