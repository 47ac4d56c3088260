//! From times of flight to contacts.

use crate::experiment::Experiment;
use crate::failure::{PyFailure, warn};
use crate::job::Job;
use crate::json;
use crate::options::parsed;
use hertzchain::failure::Failure;
use hertzchain::fit::pulses;
use hertzchain::inference::{changed, in_case, parsed as data, user};
use hertzchain::options::{
    CurveOptions as Measured, DesignOptions as Design, FitOptions as Fit, GaugeOptions as Gauge,
};
use hertzchain::{design as designing, fit as fitting, gauge as gauging};
use hertzchain_infer::gauge::oils;
use hertzchain_infer::{CurveProblem, Data};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value;
use std::path::PathBuf;

/// A table by name and text.
pub(crate) type Table = (String, String);

fn read((name, text): &Table, measured: &Measured, case: Option<&String>) -> Result<Data, Failure> {
    data(name, text, measured, case.or(measured.case.as_ref()).cloned())
}

/// Contact parameters from times of flight.
#[pyfunction]
pub(crate) fn fit<'py>(
    py: Python<'py>,
    tables: Vec<(Table, PyRef<'py, Experiment>)>,
    options: &str,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let tables = tables.into_iter().map(|(table, experiment)| (table, experiment.inner.clone()));
    let tables: Vec<_> = tables.collect();
    found(py, options, progress, |arguments| {
        let problem = joint_problem(&tables, arguments)?;
        let fit_result = fitting::fit_result(problem, arguments)?;
        left(&fit_result.inferred, arguments)?;
        Ok(Found::of(&fit_result, arguments))
    })
}

/// Leaves walkers in the output folder, if there is one.
pub(crate) fn left(inferred: &fitting::Inferred, arguments: &Fit) -> Result<(), Failure> {
    let out = arguments.out.as_deref();
    out.map_or(Ok(()), |out| fitting::leave(inferred, out))
}

fn found<'py>(
    py: Python<'py>,
    options: &str,
    progress: Option<Bound<'py, PyAny>>,
    fit_result: impl FnOnce(&Fit) -> Result<Found, Failure> + Send,
) -> PyResult<Bound<'py, PyAny>> {
    let arguments: Fit = parsed("fit", options)?;
    let threads = arguments.modelled.threads.map_or(0, |threads| threads.0);
    let found = Job::pooled(progress, threads).run(py, |_| fit_result(&arguments))?;
    found.reported(py)
}

/// Whether a file is a table of curves; what else can be read is a recording.
#[pyfunction]
pub(crate) fn is_table(path: PathBuf, with_options_of_recordings: bool) -> PyResult<bool> {
    let found = hertzchain::inference::is_table(&path, with_options_of_recordings);
    Ok(found.map_err(PyFailure::from)?)
}

/// Contact parameters from whole pulses of recordings.
#[pyfunction]
pub(crate) fn fit_pulses<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    options: &str,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    found(py, options, progress, |arguments| {
        let case = arguments.measured.case.as_deref().unwrap_or_default();
        let inner = in_case(experiment.inner.clone(), case)?;
        let inner = changed(inner, &arguments.modelled.set)?;
        let recorded = pulses::recorded_of(&inner, arguments)?;
        let fit_result = pulses::fit_result(recorded, arguments)?;
        left(&fit_result.inferred, arguments)?;
        Ok(Found {
            fit: pulses::json(&fit_result, arguments),
            rows: pulses::rows_json(&pulses::shown(&fit_result)?),
            samples: samples(&fit_result.inferred),
        })
    })
}

/// What is to be fitted to what.
pub(crate) fn joint_problem(
    tables: &[(Table, hertzchain_experiment::Experiment)],
    arguments: &Fit,
) -> Result<CurveProblem, Failure> {
    let case = arguments.measured.case.as_ref();
    let pair = |(at, (table, experiment)): (usize, &(Table, _))| {
        // A case is the first table's: others have theirs alone.
        let case = case.filter(|_| at == 0).cloned();
        Ok((data(&table.0, &table.1, &arguments.measured, case)?, Clone::clone(experiment)))
    };
    let pairs = tables.iter().enumerate().map(pair).collect::<Result<Vec<_>, Failure>>()?;
    hertzchain::inference::joint_problem(&pairs, arguments)
}

/// A fit as Python gets it.
pub(crate) struct Found {
    fit: Value,
    rows: Value,
    samples: Option<(usize, Vec<f64>)>,
}

impl Found {
    /// Of a fit.
    pub(crate) fn of(fit_result: &fitting::FitResult, arguments: &Fit) -> Self {
        Self {
            fit: fitting::json(fit_result, arguments),
            rows: fitting::rows_json(fit_result),
            samples: samples(&fit_result.inferred),
        }
    }

    /// As a dict.
    pub(crate) fn reported(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        let reported = reported(py, &self.fit)?.cast_into::<PyDict>()?;
        reported.set_item("rows", json::object(py, &self.rows)?)?;
        if let Some((parameters, samples)) = self.samples {
            let samples = samples.into_pyarray(py);
            let count = samples.len()? / parameters.max(1);
            reported.set_item("samples", samples.reshape([parameters, count])?)?;
        }
        Ok(reported.into_any())
    }
}

/// A result as Python's own objects, after warnings about its models.
fn reported<'py>(py: Python<'py>, found: &Value) -> PyResult<Bound<'py, PyAny>> {
    let warnings = found["warnings"].as_array().into_iter().flatten();
    warn(py, warnings.filter_map(Value::as_str))?;
    json::object(py, found)
}

/// Samples of a posterior, parameter by parameter, and how many parameters there are.
fn samples(inferred: &fitting::Inferred) -> Option<(usize, Vec<f64>)> {
    match &inferred.more {
        fitting::More::Sampled(sampled) => {
            let posterior = sampled.posterior.as_ref().ok()?;
            let parameters = posterior.mean.len();
            Some((parameters, posterior.samples.iter().flatten().copied().collect()))
        }
        _ => None,
    }
}

/// What to measure next.
#[pyfunction]
pub(crate) fn design<'py>(
    py: Python<'py>,
    table: Table,
    experiment: &Experiment,
    options: &str,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let arguments: Design = parsed("design", options)?;
    let threads = arguments.modelled.threads.map_or(0, |threads| threads.0);
    let found = Job::pooled(progress, threads).run(py, |_| {
        let data = read(&table, &arguments.measured, None)?;
        let (problem, found) = designing::design(&data, &experiment.inner, &arguments)?;
        Ok(designing::json(&problem, &found))
    })?;
    reported(py, &found)
}

/// Which oil is on the contacts.
#[pyfunction]
pub(crate) fn gauge<'py>(
    py: Python<'py>,
    tables: (Table, Table),
    experiments: (PyRef<'py, Experiment>, PyRef<'py, Experiment>),
    more_oils: Option<Table>,
    options: &str,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let arguments: Gauge = parsed("gauge", options)?;
    let (wet_model, dry_model) = (experiments.0.inner.clone(), experiments.1.inner.clone());
    let found =
        Job::pooled(progress, arguments.threads.map_or(0, |threads| threads.0)).run(py, |_| {
            let measured = &arguments.measured;
            let wet = read(&tables.0, measured, arguments.wet_case.as_ref())?;
            let dry = read(&tables.1, measured, arguments.dry_case.as_ref())?;
            let mut all = gauging::all_oils(None)?;
            if let Some((name, text)) = &more_oils {
                all.extend(oils(name, text).map_err(user)?);
            }
            let chains = [&wet_model, &dry_model];
            let run_gauge = gauging::gauge([wet, dry], chains, all, &arguments)?;
            let mut reported = gauging::json(&run_gauge);
            reported["options"] = hertzchain::options::recorded(&arguments);
            Ok(reported)
        })?;
    reported(py, &found)
}
