//! Validation of a fit's options before anything is computed.

use super::checkpoint::check_options;
use super::{Arguments, CHAIN};
use crate::failure::Failure;

pub(super) fn of_table(arguments: &Arguments) -> Result<(), Failure> {
    let recorded = &arguments.recorded;
    let why = "is for recordings, and DATA is a table of times of flight: leave it out";
    refuse("--shots", recorded.shots.is_some(), why)?;
    refuse("--rate", recorded.rate.is_some(), why)?;
    refuse("--channel", !recorded.channel.is_empty(), why)?;
    refuse("--low-pass", recorded.low_pass.is_some(), why)?;
    refuse("--filter", recorded.filter.is_some(), why)?;
    let why = "can't be combined with --against: models are compared by likelihoods, and a robust loss is none; \
               compare without --robust, or leave outliers out of the table";
    refuse("--robust", arguments.robust && !arguments.against.is_empty(), why)?;
    of_any(arguments)
}

pub(super) fn of_recordings(arguments: &Arguments) -> Result<(), Failure> {
    let why = "compares models of a table of times of flight, and DATA are recordings: take their times by \
               `hertzchain measure` and compare models of speeds.csv, or fit the other model to the recordings by itself";
    refuse("--against", !arguments.against.is_empty(), why)?;
    let why =
        "fits several tables of times of flight together, and DATA are recordings: leave it out";
    refuse("--also", !arguments.also.is_empty(), why)?;
    let why = "is for tables of times of flight, and DATA are recordings, whose noise is taken from themselves: leave it out";
    refuse("--tof-error", arguments.measured.tof_error.is_some(), why)?;
    refuse("--ratio-error", arguments.measured.ratio_error.is_some(), why)?;
    let shots = arguments.measured.error_shots;
    refuse("--error-shots", shots.is_some(), why)?;
    of_any(arguments)
}

fn of_any(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(out) = arguments.out.as_deref().filter(|_| arguments.resume) {
        let why = format!(
            "continues a posterior that was interrupted, and {} holds nothing of one: leave it out",
            out.display()
        );
        refuse("--resume", !out.join(CHAIN).exists(), &why)?;
    }
    check_options(arguments)
}

fn refuse(option: &str, given: bool, why: &str) -> Result<(), Failure> {
    match given {
        true => Err(Failure::User(format!("{option} {why}"))),
        false => Ok(()),
    }
}
