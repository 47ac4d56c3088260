//! `hertzchain theory`: what theory says of a chain's waves.

use crate::options::CheckOptions as Check;
use crate::program::failure::{self, Failure};
use crate::program::words::lines;
use crate::program::{format, print};
use crate::{describe, input};
use serde_json::json;

/// Runs the verb.
pub(crate) fn run(arguments: &Check) -> Result<(), Failure> {
    let experiment = input::open(&arguments.input)?;
    let found = describe::theory(&experiment, arguments)?;
    let assumed = input::assumed(&arguments.input);
    if arguments.json {
        // A list of groups has no place for it.
        print::warn(assumed);
        return print::print_json(&json!(found.groups));
    }
    failure::print_speed_warnings(arguments.speed.as_ref(), &found.warnings);
    let text = match found.groups.is_empty() {
        true => "No closed theory fits this chain: no striker, no preload.".to_owned(),
        false => format::groups(&found.groups, experiment.units()),
    };
    print::print(&(lines(assumed) + &text))
}
