//! What went wrong, printed, with the exit code: 2 for the user's mistakes, 1
//! for ours.

use crate::failure;
pub(crate) use crate::failure::{Failure, why};
use crate::inference::{assumed, held_loads, unit_changes, warnings};
use crate::input::option;
use crate::options::Given;
use crate::options::{Assignment, CurveOptions as Measured};
use crate::program::print::warn;
use hertzchain_experiment::{Experiment, Warning};
use hertzchain_infer::{Data, Model};
use hertzchain_measure::records::without_controls;
use std::borrow::Cow;
use std::io::IsTerminal;

fn colour() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

/// Prints a report: in colour on a terminal, unless it quotes control characters.
fn show(report: impl Fn(bool) -> String) {
    let plain = report(false);
    match without_controls(&plain) {
        Cow::Borrowed(_) if colour() => eprint!("{}", report(true)),
        shown => eprint!("{shown}"),
    }
}

/// Prints why a verb failed and says how the program ends.
pub(crate) fn report(failure: &Failure) -> u8 {
    show(|colour| failure.report(colour));
    match failure {
        Failure::Mistakes(_) | Failure::User(_) => 2,
        Failure::Ours(_) => 1,
        Failure::BrokenPipe => 0,
    }
}

/// Warnings at a speed that an option gave, reported of the option.
pub(crate) fn print_option_warnings(option: &str, warnings: &[Warning]) {
    show(|colour| failure::option_warnings(option, warnings, colour));
}

/// What is assumed of data that do not say all.
pub(crate) fn print_assumed(data: &Data, measured: &Measured) {
    warn(assumed(data, measured));
}

/// Numbers that are kept while their unit changes, loads that the models do not have, and what is
/// improbable about these.
pub(crate) fn print_stored<'a>(models: impl IntoIterator<Item = &'a Model>, sets: &[Assignment]) {
    let models: Vec<&Model> = models.into_iter().collect();
    for model in &models {
        warn(unit_changes(model, sets).into_iter().chain(held_loads(model)));
    }
    print_improbable(models.into_iter().map(|model| &model.experiment));
}

/// What is improbable about experiments that a verb loads, each once.
pub(crate) fn print_improbable<'a>(experiments: impl IntoIterator<Item = &'a Experiment>) {
    print_speed_warnings(None, &warnings(experiments));
}

/// What is odd about an experiment at the speed that may have been given.
pub(crate) fn print_speed_warnings(given: Option<&Given>, warnings: &[Warning]) {
    match given {
        Some(given) => print_option_warnings(&option(given), warnings),
        None => show(|colour| failure::warnings(warnings, colour)),
    }
}
