//! `hertzchain man`: manual pages.

use crate::program::arguments::Program;
use crate::program::failure::Failure;
use crate::program::folder::Folder;
use crate::program::print;
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use std::path::Path;

/// Runs the verb.
pub(crate) fn run(out: Option<&Path>) -> Result<(), Failure> {
    let mut program = Program::command();
    program.build();
    let Some(out) = out else {
        return print::print(&String::from_utf8_lossy(&page(program)?));
    };
    let mut folder = Folder::open(out)?;
    folder.write("hertzchain.1", &page(program.clone())?)?;
    for verb in program.get_subcommands().filter(|verb| verb.get_name() != "help") {
        let name = format!("hertzchain-{}", verb.get_name());
        let titled = verb.clone().display_name(name.clone());
        folder.write(&format!("{name}.1"), &page(titled)?)?;
    }
    print::print(&format!("Manual pages:\n{}", folder.finish()?))
}

fn page(command: Command) -> Result<Vec<u8>, Failure> {
    let mut page = Vec::new();
    let rendered = Man::new(command).render(&mut page);
    rendered.map_err(|error| Failure::Ours(format!("manual page: {error}")))?;
    Ok(page)
}
