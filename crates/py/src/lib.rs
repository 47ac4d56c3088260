//! hertzchain for Python: all of its bindings.
//!
//! Thin: what a verb does is in `hertzchain` and below; here arguments
//! become Rust's, results become arrays and dicts, and Python's lock is let go
//! while anything is computed. The package around this module is in `python/`.

mod batch;
mod columns;
mod experiment;
mod failure;
mod inference;
mod job;
mod json;
mod law;
mod options;
mod program;
mod recordings;
mod shot;
mod spread;
mod theory;

use pyo3::prelude::*;

#[pymodule]
mod _hertzchain {
    #[pymodule_export]
    use super::batch::{Run, gather, speeds};
    #[pymodule_export]
    use super::experiment::{Experiment, presets, schema};
    #[pymodule_export]
    use super::inference::{design, fit, fit_pulses, gauge, is_table};
    #[pymodule_export]
    use super::law::Force;
    #[pymodule_export]
    use super::options::options;
    #[pymodule_export]
    use super::program::run_program;
    #[pymodule_export]
    use super::recordings::{campaign, campaign_series, measure};
    #[pymodule_export]
    use super::shot::shot;
    #[pymodule_export]
    use super::spread::{Likelihood, fit_spread};
    #[pymodule_export]
    use super::theory::{check, instruction_set, laws, theory};

    use pyo3::prelude::*;

    /// The version, as of the package.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
