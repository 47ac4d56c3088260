//! `hertzchain completions`: a script for a shell.

use crate::program::arguments::Program;
use crate::program::failure::Failure;
use crate::program::print;
use clap::CommandFactory;
use clap_complete::{Shell, generate};

/// Runs the verb.
pub(crate) fn run(shell: Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    generate(shell, &mut Program::command(), "hertzchain", &mut script);
    print::print(&String::from_utf8_lossy(&script))
}
