//! `hertzchain check` and `hertzchain theory`: what is known of an experiment without a shot.

use crate::options::CheckOptions as Arguments;
use crate::program::{Failure, failure, format, lines, print};
use crate::{describe, input};
use serde_json::json;

pub(crate) fn check(arguments: &Arguments) -> Result<(), Failure> {
    if !input::is_named(&arguments.input) {
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

/// Prints what theory says of a chain's waves.
pub(crate) fn theory(arguments: &Arguments) -> Result<(), Failure> {
    let experiment = input::open(&arguments.input)?;
    let found = describe::theory(&experiment, arguments)?;
    let assumed = input::assumed(&arguments.input);
    if arguments.json {
        // A list of groups has no place for these.
        print::warn(assumed);
        failure::print_speed_warnings(arguments.speed.as_ref(), &found.warnings);
        return print::print_json(&json!(found.groups));
    }
    failure::print_speed_warnings(arguments.speed.as_ref(), &found.warnings);
    let text = match found.groups.is_empty() {
        true => "No closed theory fits this chain: no striker, no preload.".to_owned(),
        false => format::groups(&found.groups, experiment.units()),
    };
    print::print(&(lines(assumed) + &text))
}
