//! Times of flight against speed.

use crate::columns::Columns;
use crate::experiment::Experiment;
use crate::failure::Failed;
use crate::job::Job;
use crate::json;
use hertzchain_study::{Judges, Plan, Settings, Sweep, parse_speeds};
use hertzchain_verbs::arguments::{How, parsed};
use hertzchain_verbs::failure::Failure;
use hertzchain_verbs::{input, json as results};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Speeds from text: "0.1,0.2", "FROM:TO:COUNT", "log:FROM:TO:COUNT".
#[pyfunction]
pub fn speeds<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let list = parse_speeds(text);
    let list = list.map_err(|error| Failed::from(Failure::User(error.to_string())))?;
    Ok(list.into_pyarray(py))
}

/// Who judges, by name.
pub fn judges(name: &str) -> Result<Judges, Failure> {
    match name {
        "each" => Ok(Judges::Each),
        "pilots" => Ok(Judges::Pilots),
        _ => Err(Failure::User(format!(
            "judges = {name:?}: expected \"each\" or \"pilots\""
        ))),
    }
}

/// What a sweep asks for beside its speeds.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Asked {
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
pub fn sweep<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    speeds_m_s: PyReadonlyArray1<'py, f64>,
    asked: Asked,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let speeds_m_s = speeds_m_s.as_array().to_vec();
    let inner = &experiment.inner;
    let how: How = parsed("sweep", &asked.options).map_err(Failed::from)?;
    let judges = judges(&asked.judges).map_err(Failed::from)?;
    let plan = representative(experiment, &how).map_err(Failed::from)?;
    let set = input::instruction_set().map_err(Failed::from)?;
    let swept = Job::pooled(progress, asked.threads).run(py, |meter| {
        let settings = Settings {
            adjust: &|plan| {
                input::adjust(&how, plan);
                plan.rebound = asked.rebound;
            },
            checked: how.check,
            judges,
            set,
            progress: &|| meter.count(),
        };
        Ok(hertzchain_study::sweep(inner, &speeds_m_s, &settings))
    })?;
    told(py, experiment, &plan, &swept, speeds_m_s)
}

/// A plan at the experiment's own speed, to refuse options before any work.
pub fn representative(experiment: &Experiment, how: &How) -> Result<Plan, Failure> {
    let inner = &experiment.inner;
    inner.needs_striker("shots at several speeds need a chain with a striker")?;
    input::check_times(how, inner)?;
    let (mut plan, _warnings) = Plan::from_experiment(inner, None)?;
    input::adjust(how, &mut plan);
    input::check_effort(how, &plan, inner.units())?;
    Ok(plan)
}

fn told<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    plan: &Plan,
    swept: &Sweep,
    speeds_m_s: Vec<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let mut columns = Columns::default();
    for point in &swept.points {
        columns.push(point.shot.as_ref().ok());
    }
    // The points stand in the columns.
    let outline = Sweep {
        points: Vec::new(),
        ..swept.clone()
    };
    let mut found = results::sweep(&experiment.inner, plan, &outline);
    found["power_law_incident"] = results::fit(&swept.incident, swept.incident_uncertainty().ok());
    found["power_law_reflected"] =
        results::fit(&swept.reflected, swept.reflected_uncertainty().ok());
    let told = json::object(py, &found)?.cast_into::<PyDict>()?;
    told.set_item("speed_m_s", speeds_m_s.into_pyarray(py))?;
    told.set_item("columns", columns.arrays(py)?)?;
    let points = || swept.points.iter().enumerate();
    let errors =
        points().filter_map(|(at, point)| Some((at, point.shot.as_ref().err()?.to_string())));
    told.set_item("errors", errors.collect::<Vec<_>>())?;
    let odd = points().filter(|(_, point)| !point.warnings.is_empty());
    let warnings = odd.map(|(at, point)| (at, point.warnings.clone()));
    told.set_item("warnings", warnings.collect::<Vec<_>>())?;
    Ok(told)
}
