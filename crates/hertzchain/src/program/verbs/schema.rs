//! `hertzchain schema`: the JSON Schema of experiment files.

use crate::failure::Failure;
use crate::print;

/// Runs the verb.
pub(crate) fn run() -> Result<(), Failure> {
    print::print_json(&hertzchain_experiment::schema())
}
