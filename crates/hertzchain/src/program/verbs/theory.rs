//! `hertzchain theory`: what theory says of a chain's waves.

use crate::options::CheckOptions as Check;
use crate::program::failure::{self, Failure};
use crate::program::words::lines;
use crate::program::{format, print};
use crate::{input, json};
use hertzchain_sim::describe_theory;

/// Runs the verb.
pub(crate) fn run(arguments: &Check) -> Result<(), Failure> {
    let experiment = input::open(&arguments.input)?;
    let speed = input::speed(arguments.speed.as_ref(), &experiment)?;
    // What the physics refuses is reported at its place in the file.
    let given = arguments.speed.as_ref();
    input::at_speed(given, experiment.system(speed))?;
    let (chain, warnings) = input::at_speed(given, experiment.chain(speed))?;
    let groups = describe_theory(&experiment, &chain)?;
    if arguments.json {
        // A list of groups has no place for it.
        if let Some(assumed) = input::assumed(&arguments.input) {
            print::note(&format!("warning: {assumed}"));
        }
        return print::print_json(&json::groups(&groups));
    }
    failure::print_speed_warnings(given, &warnings);
    let assumed = lines(input::assumed(&arguments.input).into_iter().collect());
    let text = match groups.is_empty() {
        true => "No closed theory fits this chain: no striker, no preload.".to_owned(),
        false => format::groups(&groups, experiment.units()),
    };
    print::print(&(assumed + &text))
}
