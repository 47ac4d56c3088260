//! What is known without a shot: descriptions, theory, laws.

use crate::experiment::Experiment;
use crate::failure::{PyFailure, finding};
use crate::job::Job;
use crate::json;
use crate::options::parsed;
use hertzchain::Description;
use hertzchain::failure::Failure;
use hertzchain::options::CheckOptions;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::json;

type Describe =
    fn(&hertzchain_experiment::Experiment, &CheckOptions) -> Result<Description, Failure>;

fn described<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    options: &str,
    describe: Describe,
) -> PyResult<Bound<'py, PyDict>> {
    let options: CheckOptions = parsed("check", options)?;
    let found = Job::alone().run(py, |_| describe(&experiment.inner, &options))?;
    let described = PyDict::new(py);
    described.set_item("groups", json::object(py, &json!(found.groups))?)?;
    let warnings: PyResult<Vec<_>> = found.warnings.iter().map(|it| finding(py, it)).collect();
    described.set_item("warnings", warnings?)?;
    Ok(described)
}

/// What was understood, in SI, and what follows from it.
#[pyfunction]
pub(crate) fn check<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    options: &str,
) -> PyResult<Bound<'py, PyDict>> {
    described(py, experiment, options, hertzchain::check)
}

/// What theory says of a chain's waves.
#[pyfunction]
pub(crate) fn theory<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    options: &str,
) -> PyResult<Bound<'py, PyDict>> {
    described(py, experiment, options, hertzchain::theory)
}

/// Contact laws with equation, parameters, units and source.
#[pyfunction]
#[pyo3(signature = (name))]
pub(crate) fn laws<'py>(py: Python<'py>, name: Option<&str>) -> PyResult<Bound<'py, PyAny>> {
    let infos = hertzchain::laws::infos(name).map_err(PyFailure::from)?;
    json::object(py, &hertzchain::laws::json(&infos))
}

/// The vector instructions with which ensembles are computed here.
///
/// Last bits depend on them; ``HERTZCHAIN_INSTRUCTION_SET`` chooses others.
///
/// Returns
/// -------
/// str
///     Such as ``"avx2"``.
///
/// Raises
/// ------
/// OptionError
///     A choice that this machine does not have.
///
/// References
/// ----------
/// What must be the same on all machines: docs/how-to/many-machines.md.
#[pyfunction]
pub(crate) fn instruction_set() -> PyResult<&'static str> {
    Ok(hertzchain::instruction_set().map_err(PyFailure::from)?.name())
}
