//! `hertzchain schema`: the JSON Schema of experiment files.

use crate::program::failure::Failure;
use crate::program::print;

/// Runs the verb.
pub(crate) fn run() -> Result<(), Failure> {
    print::print_json(&hertzchain_experiment::schema())
}
