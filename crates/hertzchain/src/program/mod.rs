//! The program `hertzchain`: one file a verb, no logic of its own.

mod arguments;
mod failure;
mod folder;
mod format;
mod notes;
mod pictures;
mod print;
mod verbs;
mod words;

use self::{
    arguments::{Program, Verb},
    failure::{Failure, print_assumed, print_stored},
    folder::{Folder, require_free},
    format::{Style, digits, with_error},
    notes::{Counter, with_notes},
    print::heading,
    words::{chi_square_text, estimate, lines, misfit, percent},
};
use clap::Parser;
use hertzchain_measure::records::remove_copies;
use std::ffi::OsString;

/// Exit code of a program that the user ended: 128 and the number of SIGINT.
const INTERRUPTED: i32 = 130;

/// Runs the program with these arguments, the first of which is its own name, and returns its exit code.
///
/// It prints and writes as the program does, ends the process itself for `--help` and for arguments
/// that it rejects, and ends it at Ctrl-C with exit code 130.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    end_on_interrupt();
    let program = Program::parse_from(arguments);
    let done = match program.verb {
        Some(verb) => run_verb(verb),
        None => verbs::about::version(program.verbose),
    };
    let code = match done {
        Ok(()) => 0,
        Err(failure) => failure::report(&failure),
    };
    remove_copies();
    code
}

/// Ends the program with a message at Ctrl-C. Files appear whole, so none has to be closed.
fn end_on_interrupt() {
    let installed = ctrlc::set_handler(|| {
        print::note("interrupted: what was not finished is not written");
        std::process::exit(INTERRUPTED);
    });
    if let Err(error) = installed {
        print::warn([format!("Ctrl-C ends without a message: {error}")]);
    }
}

fn run_verb(verb: Verb) -> Result<(), Failure> {
    match verb {
        Verb::Reproduce(arguments) => verbs::reproduce::run(&arguments),
        Verb::Shot(arguments) => verbs::shot::run(&arguments),
        Verb::Sweep(arguments) => verbs::sweep::run(&arguments),
        Verb::Merge(arguments) => verbs::merge::run(&arguments),
        Verb::Campaign(arguments) => verbs::campaign::run(&arguments),
        Verb::Measure(arguments) => verbs::measure::run(&arguments),
        Verb::Live(arguments) => verbs::live::run(&arguments),
        Verb::Fit(arguments) => verbs::fit::run(&arguments),
        Verb::Design(arguments) => verbs::design::run(&arguments),
        Verb::Gauge(arguments) => verbs::gauge::run(&arguments),
        #[cfg(feature = "explore")]
        Verb::Explore(arguments) => verbs::explore::run(&arguments),
        Verb::Check(arguments) => verbs::about::check(&arguments),
        Verb::Theory(arguments) => verbs::about::theory(&arguments),
        Verb::Laws(arguments) => verbs::about::laws(&arguments),
        Verb::Presets(arguments) => verbs::about::presets(&arguments),
        Verb::Schema => verbs::about::schema(),
        Verb::Completions { shell } => verbs::about::completions(shell),
        Verb::Man { out } => verbs::about::man(out.as_deref()),
    }
}
