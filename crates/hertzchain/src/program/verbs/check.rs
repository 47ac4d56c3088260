//! `hertzchain check`: what was understood; runs nothing.

use crate::options::CheckOptions as Check;
use crate::program::failure::{self, Failure};
use crate::program::{format, print};
use crate::{describe, input};
use serde_json::json;

/// Runs the verb.
pub(crate) fn run(arguments: &Check) -> Result<(), Failure> {
    if arguments.input.file.is_none() && arguments.input.preset.is_none() {
        return Err(Failure::User("check needs an experiment: FILE or --preset NAME".into()));
    }
    let experiment = input::open(&arguments.input)?;
    let found = describe::check(&experiment, arguments)?;
    if arguments.json {
        let warnings: Vec<String> = found.warnings.iter().map(|w| w.one_line()).collect();
        return print::print_json(&json!({ "groups": found.groups, "warnings": warnings }));
    }
    failure::print_speed_warnings(arguments.speed.as_ref(), &found.warnings);
    print::print(&format::groups(&found.groups, experiment.units()))
}
