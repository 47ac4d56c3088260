//! `hertzchain --version`: which program this is and how it computes here.

use crate::input;
use crate::program::failure::Failure;
use crate::program::print;
use hertzchain_sim::InstructionSet;

/// Prints the version.
pub(crate) fn run(verbose: bool) -> Result<(), Failure> {
    let mut text = format!("hertzchain {}\n", env!("CARGO_PKG_VERSION"));
    if verbose {
        let sets = InstructionSet::available();
        let names: Vec<&str> = sets.into_iter().map(InstructionSet::name).collect();
        text += &format!(
            "instruction set  {}\navailable here   {}\nto choose        {}=NAME\n",
            input::instruction_set()?.name(),
            names.join(", "),
            input::INSTRUCTION_SET,
        );
    }
    print::print(&text)
}
