//! Times of flight against speed.

use crate::columns::{Columns, copied, list};
use crate::experiment::Experiment;
use crate::failure::Failed;
use crate::job::Job;
use crate::json;
use hertzchain::failure::Failure;
use hertzchain::options::{SimulationOptions as How, parsed};
use hertzchain::{input, json as results};
use hertzchain_sim::{
    Batch, BatchOptions, Calibration, Column, ErrorControl, Plan, Rows, Shard, StudyError,
    parse_speeds,
};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Speeds from text: "0.1,0.2", "FROM:TO:COUNT", "log:FROM:TO:COUNT".
#[pyfunction]
pub(crate) fn speeds<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let list = parse_speeds(text);
    let list = list.map_err(|error| Failed::from(Failure::User(error.to_string())))?;
    Ok(list.into_pyarray(py))
}

/// How errors are controlled, by name.
fn error_control(name: &str) -> Result<ErrorControl, Failure> {
    match name {
        "each" | "per-shot" => Ok(ErrorControl::PerShot),
        "pilots" | "calibrated" => Ok(ErrorControl::Calibrated),
        "none" => Ok(ErrorControl::None),
        _ => Err(Failure::User(format!(
            "judges = {name:?}: expected \"each\" or \"pilots\""
        ))),
    }
}

/// What a sweep asks for beside its speeds.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked {
    /// Options as on the command line.
    pub options: Vec<String>,
    /// Follow the striker.
    pub rebound: bool,
    /// Who judges.
    pub judges: String,
    /// Threads; all cores' if 0.
    pub threads: usize,
}

/// Shots at many speeds and their power laws.
#[pyfunction]
#[pyo3(signature = (experiment, speeds_m_s, asked, progress))]
pub(crate) fn sweep<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    speeds_m_s: PyReadonlyArrayDyn<'py, f64>,
    asked: Asked,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let speeds_m_s = copied(py, &speeds_m_s)?;
    let how: How = parsed("sweep", &asked.options).map_err(Failed::from)?;
    let plan = representative(experiment, &how).map_err(Failed::from)?;
    let batch = batch(experiment, &speeds_m_s, &[], &asked).map_err(Failed::from)?;
    let swept = Job::pooled(progress, asked.threads)
        .run(py, |stop| Ok(Swept::of(&batch, &|| stop.count(1))))?;
    swept.told(py, experiment, plan.accuracy)
}

/// A sweep as numbers: no shot of it is kept whole.
struct Swept {
    columns: Columns,
    rows: Rows,
    warnings: Vec<(usize, Vec<String>)>,
    calibration: Option<Calibration>,
}

impl Swept {
    fn of(batch: &Batch, progress: &(dyn Fn() + Sync)) -> Self {
        let mut columns = Columns::default();
        let mut warnings = Vec::new();
        let (result, calibration) = batch.run_each(Shard::WHOLE, progress, |point| {
            columns.push(point.shot.as_ref().ok());
            if !point.warnings.is_empty() {
                warnings.push((point.place, point.warnings));
            }
        });
        Self {
            columns,
            rows: result.rows,
            warnings,
            calibration,
        }
    }

    fn told<'py>(
        self,
        py: Python<'py>,
        experiment: &Experiment,
        accuracy: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let laws = [Column::Incident, Column::Reflected].map(|of| self.rows.law(of, accuracy));
        let through = laws.each_ref().map(|(law, least)| (law, least.clone()));
        let found = results::outline(&experiment.inner, self.calibration, through);
        let told = json::object(py, &found)?.cast_into::<PyDict>()?;
        let [speeds_m_s, ..] = self.rows.columns;
        told.set_item("speed_m_s", speeds_m_s.into_pyarray(py))?;
        told.set_item("columns", self.columns.arrays(py)?)?;
        let errors = self.rows.failed.into_iter();
        told.set_item("errors", list(py, errors.map(|it| (it.place, it.why)))?)?;
        told.set_item("warnings", list(py, self.warnings)?)?;
        Ok(told)
    }
}

/// A batch of speeds and named numbers, one value a speed.
pub(crate) fn batch(
    experiment: &Experiment,
    speeds_m_s: &[f64],
    numbers: &[(String, Vec<f64>)],
    asked: &Asked,
) -> Result<Batch, Failure> {
    let how: How = parsed("sweep", &asked.options)?;
    let plan = representative(experiment, &how)?;
    let options = BatchOptions {
        accuracy: plan.accuracy,
        solver: plan.solver,
        duration_s: plan.duration_s,
        pick: plan.pick,
        rebound: asked.rebound,
        checked: how.check,
        error_control: error_control(&asked.judges)?,
        set: input::instruction_set()?,
    };
    let batch = Batch::new(&experiment.inner, speeds_m_s.to_vec(), options)?;
    let with =
        |batch: Batch, (name, values): &(String, Vec<f64>)| batch.with_number(name, values.clone());
    let batch: Result<Batch, StudyError> = numbers.iter().try_fold(batch, with);
    Ok(batch?)
}

/// A plan at the experiment's own speed, to refuse options before any work.
pub(crate) fn representative(experiment: &Experiment, how: &How) -> Result<Plan, Failure> {
    let inner = &experiment.inner;
    inner.needs_striker("shots at several speeds need a chain with a striker")?;
    input::check_times(how, inner)?;
    let (mut plan, _warnings) = Plan::from_experiment(inner, None)?;
    input::adjust(how, &mut plan);
    input::check_effort(how, &plan, inner.units())?;
    Ok(plan)
}
