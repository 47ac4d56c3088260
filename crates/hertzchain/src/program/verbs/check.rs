//! `hertzchain check`: what was understood; runs nothing.

use crate::options::CheckOptions as Check;
use crate::program::failure::{self, Failure};
use crate::program::{format, print};
use crate::{input, json};
use hertzchain_sim::describe;
use serde_json::json;

/// Runs the verb.
pub(crate) fn run(arguments: &Check) -> Result<(), Failure> {
    if arguments.input.file.is_none() && arguments.input.preset.is_none() {
        return Err(Failure::User("check needs an experiment: FILE or --preset NAME".into()));
    }
    let experiment = input::open(&arguments.input)?;
    let speed = input::speed(arguments.speed.as_ref(), &experiment)?;
    // What the physics refuses is reported at its place in the file.
    let given = arguments.speed.as_ref();
    input::at_speed(given, experiment.system(speed))?;
    let (chain, warnings) = input::at_speed(given, experiment.chain(speed))?;
    let groups = describe(&experiment, &chain)?;
    if arguments.json {
        let warnings: Vec<String> = warnings.iter().map(|w| w.one_line()).collect();
        return print::print_json(
            &json!({ "groups": json::groups(&groups), "warnings": warnings }),
        );
    }
    failure::print_speed_warnings(given, &warnings);
    print::print(&format::groups(&groups, experiment.units()))
}
