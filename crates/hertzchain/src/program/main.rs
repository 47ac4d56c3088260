//! The `hertzchain` program; all of it is in the library, as Python's package has it too.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(hertzchain::program::run(std::env::args_os()))
}
