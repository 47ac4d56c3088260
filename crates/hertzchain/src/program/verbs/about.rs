//! What the program says of itself: `--version`, `schema`, `completions` and `man`.

use crate::input;
use crate::program::arguments::Program;
use crate::program::{Failure, Folder, print};
use clap::{Command, CommandFactory};
use clap_complete::{Shell, generate};
use clap_mangen::Man;
use hertzchain_sim::InstructionSet;
use std::path::Path;

/// Prints the version and, if asked for, how this machine computes.
pub(crate) fn version(verbose: bool) -> Result<(), Failure> {
    let mut text = format!("hertzchain {}\n", env!("CARGO_PKG_VERSION"));
    if verbose {
        let sets = InstructionSet::available();
        let names: Vec<&str> = sets.into_iter().map(InstructionSet::name).collect();
        text += &format!(
            "instruction set  {}\navailable here   {}\nto choose        {}=NAME\n",
            input::instruction_set()?.name(),
            names.join(", "),
            input::INSTRUCTION_SET,
        );
    }
    print::print(&text)
}

pub(crate) fn schema() -> Result<(), Failure> {
    print::print_json(&hertzchain_experiment::schema())
}

pub(crate) fn completions(shell: Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    generate(shell, &mut Program::command(), "hertzchain", &mut script);
    print::print(&String::from_utf8_lossy(&script))
}

/// Prints the manual page, or writes one page a verb.
pub(crate) fn man(out: Option<&Path>) -> Result<(), Failure> {
    let mut program = Program::command();
    program.build();
    let Some(out) = out else {
        return print::print(&String::from_utf8_lossy(&page(program)?));
    };
    // Pages are this version's, and no results of a run.
    let mut folder = Folder::open(out, &[], true)?;
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
