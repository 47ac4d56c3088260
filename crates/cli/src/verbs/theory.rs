//! `hertzchain theory`: what theory says of a chain's waves.

use crate::arguments::Check;
use crate::failure::{Failure, print_warnings};
use crate::{format, input, json, print};
use hertzchain_study::describe_theory;

/// Runs the verb.
pub fn run(arguments: &Check) -> Result<(), Failure> {
    let experiment = input::open(&arguments.input)?;
    let (chain, warnings) = experiment.chain(arguments.speed)?;
    let groups = describe_theory(&experiment, &chain)?;
    if arguments.json {
        return print::print_json(&json::groups(&groups));
    }
    print_warnings(&warnings);
    match groups.is_empty() {
        true => print::print("No closed theory fits this chain: no striker, no preload."),
        false => print::print(&format::groups(&groups, experiment.units())),
    }
}
