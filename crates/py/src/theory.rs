//! What is known without a shot: descriptions, theory, laws.

use crate::experiment::Experiment;
use crate::failure::{Failed, finding};
use crate::job::Job;
use crate::json;
use hertzchain::failure::Failure;
use hertzchain::options::Given;
use hertzchain::{input, json as results};
use hertzchain_chain::Chain;
use hertzchain_experiment as experiment;
use hertzchain_sim::{Group, StudyError, describe, describe_theory};
use pyo3::prelude::*;
use pyo3::types::PyDict;

type Describe = fn(&experiment::Experiment, &Chain) -> Result<Vec<Group>, StudyError>;

fn described<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    speed: Option<String>,
    describe: Describe,
) -> PyResult<Bound<'py, PyDict>> {
    let inner = &experiment.inner;
    let given = speed.map(|text| Given::speed(&text)).transpose();
    let given = given.map_err(|error| Failed::from(Failure::User(error.to_string())))?;
    let speed_m_s = input::speed(given.as_ref(), inner).map_err(Failed::from)?;
    let (groups, warnings) = Job::alone().run(py, |_| {
        // What the physics refuses is reported at its place in the file.
        input::at_speed(given.as_ref(), inner.system(speed_m_s))?;
        let (chain, warnings) = input::at_speed(given.as_ref(), inner.chain(speed_m_s))?;
        Ok((describe(inner, &chain)?, warnings))
    })?;
    let described = PyDict::new(py);
    described.set_item("groups", json::object(py, &results::groups(&groups))?)?;
    let warnings: PyResult<Vec<_>> = warnings.iter().map(|odd| finding(py, odd)).collect();
    described.set_item("warnings", warnings?)?;
    Ok(described)
}

/// What was understood, in SI, and what follows from it.
#[pyfunction]
#[pyo3(signature = (experiment, speed))]
pub(crate) fn check<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    speed: Option<String>,
) -> PyResult<Bound<'py, PyDict>> {
    described(py, experiment, speed, describe)
}

/// What theory says of a chain's waves.
#[pyfunction]
#[pyo3(signature = (experiment, speed))]
pub(crate) fn theory<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    speed: Option<String>,
) -> PyResult<Bound<'py, PyDict>> {
    described(py, experiment, speed, describe_theory)
}

/// Contact laws with equation, parameters, units and source.
#[pyfunction]
#[pyo3(signature = (name))]
pub(crate) fn laws<'py>(py: Python<'py>, name: Option<&str>) -> PyResult<Bound<'py, PyAny>> {
    let infos = hertzchain::laws::infos(name).map_err(Failed::from)?;
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
    Ok(input::instruction_set().map_err(Failed::from)?.name())
}
