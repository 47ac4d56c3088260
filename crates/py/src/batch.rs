//! Many shots: over speeds, over arrays of named numbers, in shards.

use crate::columns::{self, Columns, copied, list};
use crate::experiment::Experiment;
use crate::failure::PyFailure;
use crate::job::Job;
use crate::json;
use crate::options::parsed;
use hertzchain::failure::{Failure, why};
use hertzchain::options::SweepOptions;
use hertzchain::sweep::{self, SweepSummary};
use hertzchain_sim::{Batch, BatchResult, COLUMNS, Shard, StudyError, parse_speeds, stopped};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Speeds from text: "0.1,0.2", "FROM:TO:COUNT", "log:FROM:TO:COUNT".
#[pyfunction]
pub(crate) fn speeds<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let list = parse_speeds(text);
    let list = list.map_err(|error| PyFailure::from(Failure::User(error.to_string())))?;
    Ok(list.into_pyarray(py))
}

/// A sweep or an ensemble with everything that its numbers follow from; picklable.
#[pyclass(frozen, module = "hertzchain._hertzchain")]
pub struct Run {
    batch: Batch,
    threads: usize,
    experiment: Experiment,
    speeds_m_s: Vec<f64>,
    names: Vec<String>,
    values: Vec<Vec<f64>>,
    options: String,
}

#[pymethods]
impl Run {
    #[new]
    fn new(
        py: Python<'_>,
        experiment: &Experiment,
        speeds_m_s: PyReadonlyArrayDyn<'_, f64>,
        names: Vec<String>,
        values: Vec<PyReadonlyArrayDyn<'_, f64>>,
        options: String,
    ) -> PyResult<Self> {
        let speeds_m_s = copied(py, &speeds_m_s)?;
        let values: PyResult<Vec<_>> = values.iter().map(|array| copied(py, array)).collect();
        let values = values?;
        let asked: SweepOptions = parsed("sweep", &options)?;
        let batch = sweep::batch(&experiment.inner, speeds_m_s.clone(), &asked);
        let mut batch = batch.map_err(PyFailure::from)?;
        for (name, values) in names.iter().zip(&values) {
            let with = batch.with_number(name, values.clone());
            batch = with.map_err(PyFailure::from)?;
        }
        let threads = asked.threads.map_or(0, |threads| threads.0);
        let experiment = experiment.clone();
        Ok(Self { batch, threads, experiment, speeds_m_s, names, values, options })
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let class = py.get_type::<Self>().into_any();
        let parts = (
            self.experiment.clone(),
            self.speeds(py),
            self.names.clone(),
            self.values(py),
            self.options.clone(),
        );
        Ok((class, parts.into_pyobject(py)?))
    }

    /// A short name that follows from all inputs.
    #[getter]
    fn name(&self) -> String {
        self.batch.fingerprint().short()
    }

    /// Speeds of all shots in m/s.
    fn speeds<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.speeds_m_s.clone().into_pyarray(py)
    }

    /// Values of the named numbers in SI, one array a name.
    fn values<'py>(&self, py: Python<'py>) -> Vec<Bound<'py, PyArray1<f64>>> {
        let all = self.values.iter();
        all.map(|values| values.clone().into_pyarray(py)).collect()
    }

    /// All shots in this process; of a curve with power laws and the warnings of each.
    fn compute<'py>(
        &self,
        py: Python<'py>,
        is_curve: bool,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (mut table, mut errors, mut warnings) = (Columns::default(), vec![], vec![]);
        let (result, calibration) = Job::pooled(progress, self.threads).run(py, |stop| {
            let done = self.batch.run_each(Shard::WHOLE, &|| stop.count(1), |row| {
                table.push(row.shot.as_ref().ok());
                errors.extend(row.shot.err().map(|error| (row.place, why(&error))));
                if is_curve && !row.warnings.is_empty() {
                    warnings.push((row.place, row.warnings));
                }
            });
            match stopped() {
                true => Err(Failure::from(StudyError::Stopped)),
                false => Ok(done),
            }
        })?;
        let summary = SweepSummary::new(&self.experiment.inner, &result, calibration.as_ref());
        let found = json::object(py, &json!(summary))?.cast_into::<PyDict>()?;
        if is_curve {
            errors = result.rows.failed.into_iter().map(|it| (it.place, it.why)).collect();
            found.set_item("warnings", list(py, warnings)?)?;
        } else {
            found.set_item("warnings", columns::summary(result.rows.warnings))?;
        }
        found.set_item("speed_m_s", self.speeds(py))?;
        found.set_item("values", self.values(py))?;
        found.set_item("columns", table.arrays(py)?)?;
        found.set_item("errors", list(py, errors)?)?;
        Ok(found)
    }

    /// Computes a shard into a folder unless it is there; returns whether it was.
    fn shard<'py>(
        &self,
        py: Python<'py>,
        number: usize,
        of: usize,
        folder: PathBuf,
        threads: usize,
    ) -> PyResult<bool> {
        let part = Shard::new(number, of);
        let part = part.map_err(|error| PyFailure::from(Failure::User(error.to_string())))?;
        Job::pooled(None, threads).run(py, |stop| {
            let done = self.batch.run_into(&folder, part, &|| stop.count(1));
            Ok(done.map_err(Failure::from)?.stored)
        })
    }
}

/// All shards of a folder put together.
#[pyfunction]
pub(crate) fn gather<'py>(
    py: Python<'py>,
    run: &Run,
    folder: PathBuf,
) -> PyResult<Bound<'py, PyDict>> {
    let only = Some(run.batch.fingerprint());
    let whole = Job::alone()
        .run(py, |_| BatchResult::gather(&[Path::new(&folder)], only).map_err(Failure::from))?;
    let columns = PyDict::new(py);
    // Speeds are the run's own.
    for (name, values) in COLUMNS.iter().zip(whole.rows.columns).skip(1) {
        columns.set_item(name, values.into_pyarray(py))?;
    }
    let errors = whole.rows.failed.into_iter().map(|it| (it.place, it.why));
    let found = PyDict::new(py);
    found.set_item("columns", columns)?;
    found.set_item("errors", list(py, errors)?)?;
    found.set_item("warnings", columns::summary(whole.rows.warnings))?;
    found.set_item("error_control", whole.error_control)?;
    Ok(found)
}
