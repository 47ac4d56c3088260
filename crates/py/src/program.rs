//! The program `hertzchain`, for the command that the wheel installs.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the program with its arguments, its own name first, and returns its exit code.
#[pyfunction]
pub(crate) fn run_program(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| hertzchain::program::run(arguments))
}
