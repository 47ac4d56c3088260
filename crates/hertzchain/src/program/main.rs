//! The `hertzchain` program; all of it is in the library, as Python's package has it too.

use std::process::ExitCode;

#[cfg(not(target_family = "wasm"))]
fn main() -> ExitCode {
    ExitCode::from(hertzchain::program::run(std::env::args_os()))
}

/// In WebAssembly the engine of the explorer's page: one request from standard input to standard output.
#[cfg(target_family = "wasm")]
fn main() -> ExitCode {
    match hertzchain::explorer::run_engine() {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}
