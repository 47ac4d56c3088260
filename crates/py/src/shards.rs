//! Parts of a run, for several machines.

use crate::columns::{copied, list, told as told_of};
use crate::ensemble::all_copied;
use crate::experiment::Experiment;
use crate::failure::Failed;
use crate::job::Job;
use crate::sweep::{Asked, batch};
use hertzchain::failure::Failure;
use hertzchain_sim::{Batch, BatchResult, COLUMNS, Shard};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::path::{Path, PathBuf};

/// A sweep or an ensemble with everything that its numbers follow from.
#[pyclass(frozen, module = "hertzchain._hertzchain")]
pub struct Run {
    inner: Batch,
    experiment: Experiment,
    speeds_m_s: Vec<f64>,
    names: Vec<String>,
    values: Vec<Vec<f64>>,
    asked: Asked,
}

#[pymethods]
impl Run {
    #[new]
    #[pyo3(signature = (experiment, speeds_m_s, names, values, asked))]
    fn new(
        py: Python<'_>,
        experiment: &Experiment,
        speeds_m_s: PyReadonlyArrayDyn<'_, f64>,
        names: Vec<String>,
        values: Vec<PyReadonlyArrayDyn<'_, f64>>,
        asked: Asked,
    ) -> PyResult<Self> {
        let speeds_m_s = copied(py, &speeds_m_s)?;
        let values = all_copied(py, &values)?;
        let numbers: Vec<_> = names.iter().cloned().zip(values.iter().cloned()).collect();
        let inner = batch(experiment, &speeds_m_s, &numbers, &asked);
        Ok(Self {
            inner: inner.map_err(Failed::from)?,
            experiment: experiment.clone(),
            speeds_m_s,
            names,
            values,
            asked,
        })
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let class = py.get_type::<Self>().into_any();
        let asked = PyDict::new(py);
        asked.set_item("options", &self.asked.options)?;
        asked.set_item("rebound", self.asked.rebound)?;
        asked.set_item("judges", &self.asked.judges)?;
        asked.set_item("threads", self.asked.threads)?;
        let parts = (
            self.experiment.clone(),
            self.speeds(py),
            self.names.clone(),
            self.values(py),
            asked,
        );
        Ok((class, parts.into_pyobject(py)?))
    }

    /// A short name that follows from all inputs.
    #[getter]
    fn name(&self) -> String {
        self.inner.fingerprint().short()
    }

    /// Speeds of all shots in m/s.
    fn speeds<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.speeds_m_s.clone().into_pyarray(py)
    }

    /// Values of the named numbers in SI, one array a name.
    fn values<'py>(&self, py: Python<'py>) -> Vec<Bound<'py, PyArray1<f64>>> {
        self.values
            .iter()
            .map(|values| values.clone().into_pyarray(py))
            .collect()
    }
}

/// Computes a shard into a folder unless it is there; tells whether it was.
#[pyfunction]
#[pyo3(signature = (run, number, of, folder, threads, progress))]
pub(crate) fn shard<'py>(
    py: Python<'py>,
    run: &Run,
    number: usize,
    of: usize,
    folder: PathBuf,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<bool> {
    let part = Shard::new(number, of);
    let part = part.map_err(|error| Failed::from(Failure::User(error.to_string())))?;
    Job::pooled(progress, threads).run(py, |stop| {
        let done = run.inner.run_into(&folder, part, &|| stop.count(1));
        Ok(done.map_err(Failure::from)?.stored)
    })
}

/// All shards of a folder put together.
#[pyfunction]
pub(crate) fn gather<'py>(py: Python<'py>, folder: PathBuf) -> PyResult<Bound<'py, PyDict>> {
    let whole = Job::alone().run(py, |_| {
        BatchResult::gather(&[Path::new(&folder)]).map_err(Failure::from)
    })?;
    let columns = PyDict::new(py);
    for (name, values) in COLUMNS.iter().zip(whole.rows.columns) {
        columns.set_item(name, values.into_pyarray(py))?;
    }
    let errors = whole
        .rows
        .failed
        .into_iter()
        .map(|failed| (failed.place, failed.why));
    let told = PyDict::new(py);
    told.set_item("columns", columns)?;
    told.set_item("errors", list(py, errors)?)?;
    told.set_item("odd", told_of(whole.rows.warnings))?;
    Ok(told)
}
