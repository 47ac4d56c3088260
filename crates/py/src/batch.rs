//! Many shots: over speeds, over arrays of named numbers, in shards.

use crate::columns::{Columns, copied, list, summary};
use crate::experiment::Experiment;
use crate::failure::Failed;
use crate::job::Job;
use crate::json;
use hertzchain::failure::{Failure, of_speed};
use hertzchain::options::{SimulationOptions, parsed};
use hertzchain::{input, json as results};
use hertzchain_sim::{
    Batch, BatchOptions, BatchResult, COLUMNS, Column, ErrorControl, Plan, Shard, StudyError,
    parse_speeds, stopped,
};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::path::{Path, PathBuf};

/// Speeds from text: "0.1,0.2", "FROM:TO:COUNT", "log:FROM:TO:COUNT".
#[pyfunction]
pub(crate) fn speeds<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let list = parse_speeds(text);
    let list = list.map_err(|error| Failed::from(Failure::User(error.to_string())))?;
    Ok(list.into_pyarray(py))
}

/// Settings of a batch.
#[derive(Clone, FromPyObject, IntoPyObject)]
pub(crate) struct Asked {
    #[pyo3(item)]
    options: Vec<String>,
    #[pyo3(item)]
    rebound: bool,
    #[pyo3(item)]
    error_control: String,
    #[pyo3(item)]
    threads: usize,
}

impl Asked {
    fn options(&self, experiment: &Experiment) -> Result<BatchOptions, Failure> {
        let how: SimulationOptions = parsed("sweep", &self.options)?;
        let plan = representative(experiment, &how)?;
        let error_control = match self.error_control.as_str() {
            "per-shot" => ErrorControl::PerShot,
            "calibrated" => ErrorControl::Calibrated,
            "none" => ErrorControl::None,
            other => {
                return Err(Failure::User(format!(
                    "error_control = {other:?}: expected \"per-shot\" or \"calibrated\""
                )));
            }
        };
        Ok(BatchOptions {
            accuracy: plan.accuracy,
            solver: plan.solver,
            duration_s: plan.duration_s,
            pick: plan.pick,
            rebound: self.rebound,
            checked: how.check,
            error_control,
            set: input::instruction_set()?,
        })
    }
}

/// A plan at the experiment's own speed, to reject options before any work.
fn representative(experiment: &Experiment, how: &SimulationOptions) -> Result<Plan, Failure> {
    let inner = &experiment.inner;
    inner.needs_striker("shots at several speeds need a chain with a striker")?;
    input::check_times(how, inner)?;
    let (mut plan, _warnings) = Plan::from_experiment(inner, None)?;
    input::adjust(how, &mut plan);
    input::check_effort(how, &plan, inner.units())?;
    Ok(plan)
}

/// Why a row has no shot.
fn why(error: &StudyError) -> String {
    let of_speed = match error {
        StudyError::Mistakes(mistakes) => of_speed(mistakes),
        _ => None,
    };
    of_speed.unwrap_or_else(|| error.to_string())
}

/// A sweep or an ensemble with everything that its numbers follow from; picklable.
#[pyclass(frozen, module = "hertzchain._hertzchain")]
pub struct Run {
    batch: Batch,
    accuracy: f64,
    experiment: Experiment,
    speeds_m_s: Vec<f64>,
    names: Vec<String>,
    values: Vec<Vec<f64>>,
    asked: Asked,
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
        asked: Asked,
    ) -> PyResult<Self> {
        let speeds_m_s = copied(py, &speeds_m_s)?;
        let values: PyResult<Vec<_>> = values.iter().map(|array| copied(py, array)).collect();
        let values = values?;
        let options = asked.options(experiment).map_err(Failed::from)?;
        let accuracy = options.accuracy;
        let batch = Batch::new(&experiment.inner, speeds_m_s.clone(), options);
        let mut batch = batch.map_err(Failed::from)?;
        for (name, values) in names.iter().zip(&values) {
            let with = batch.with_number(name, values.clone());
            batch = with.map_err(Failed::from)?;
        }
        Ok(Self {
            batch,
            accuracy,
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
        let parts = (
            self.experiment.clone(),
            self.speeds(py),
            self.names.clone(),
            self.values(py),
            self.asked.clone(),
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
        let (mut columns, mut errors, mut warnings) = (Columns::default(), vec![], vec![]);
        let (result, calibration) = Job::pooled(progress, self.asked.threads).run(py, |stop| {
            let done = self.batch.run_each(Shard::WHOLE, &|| stop.count(1), |row| {
                columns.push(row.shot.as_ref().ok());
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
        let BatchResult { rows, error_control, .. } = result;
        let found = if is_curve {
            let laws = [Column::Incident, Column::Reflected].map(|of| rows.law(of, self.accuracy));
            let laws = laws.each_ref().map(|(law, least)| (law, least.clone()));
            let found = results::outline(&self.experiment.inner, calibration.as_ref(), laws);
            let found = json::object(py, &found)?.cast_into::<PyDict>()?;
            errors = rows.failed.into_iter().map(|it| (it.place, it.why)).collect();
            found.set_item("warnings", list(py, warnings)?)?;
            found
        } else {
            let found = PyDict::new(py);
            found.set_item("warnings", summary(rows.warnings))?;
            found
        };
        found.set_item("error_control", error_control)?;
        found.set_item("speed_m_s", self.speeds(py))?;
        found.set_item("values", self.values(py))?;
        found.set_item("columns", columns.arrays(py)?)?;
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
        let part = part.map_err(|error| Failed::from(Failure::User(error.to_string())))?;
        Job::pooled(None, threads).run(py, |stop| {
            let done = self.batch.run_into(&folder, part, &|| stop.count(1));
            Ok(done.map_err(Failure::from)?.stored)
        })
    }
}

/// All shards of a folder put together.
#[pyfunction]
pub(crate) fn gather<'py>(py: Python<'py>, folder: PathBuf) -> PyResult<Bound<'py, PyDict>> {
    let whole = Job::alone()
        .run(py, |_| BatchResult::gather(&[Path::new(&folder)]).map_err(Failure::from))?;
    let columns = PyDict::new(py);
    for (name, values) in COLUMNS.iter().zip(whole.rows.columns) {
        columns.set_item(name, values.into_pyarray(py))?;
    }
    let errors = whole.rows.failed.into_iter().map(|it| (it.place, it.why));
    let found = PyDict::new(py);
    found.set_item("columns", columns)?;
    found.set_item("errors", list(py, errors)?)?;
    found.set_item("warnings", summary(whole.rows.warnings))?;
    Ok(found)
}
