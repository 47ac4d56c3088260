//! Recordings: made on a virtual rig, and measured.

use crate::experiment::Experiment;
use crate::failure::{PyFailure, warn};
use crate::job::Job;
use crate::json;
use crate::options::parsed;
use hertzchain::campaign::PreparedCampaign;
use hertzchain::inference::warnings;
use hertzchain::measure::{self as measuring, MeasureResult};
use hertzchain::options::{CampaignOptions, MeasureOptions as Measure};
use hertzchain_experiment::Warning;
use hertzchain_measure::{Watch, laws_csv, ratios_csv, shots_csv, speeds_csv};
use hertzchain_sim::rig::Progress;
use hertzchain_sim::{Stop, stopped};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Value, json};
use std::path::PathBuf;

/// How many series a campaign has.
#[pyfunction]
pub(crate) fn campaign_series(experiment: &Experiment, options: &str) -> Result<usize, PyFailure> {
    let options: CampaignOptions = parsed("campaign", options)?;
    Ok(PreparedCampaign::new(&experiment.inner, &options)?.plan.series.len())
}

/// Runs the series of a campaign that a folder does not have yet.
#[pyfunction]
pub(crate) fn campaign<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    options: &str,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let options: CampaignOptions = parsed("campaign", options)?;
    let threads = options.threads.map_or(0, |threads| threads.0);
    let done = Job::pooled(progress, threads).run(py, |stop| {
        let prepared = PreparedCampaign::new(&experiment.inner, &options)?;
        let done = prepared.run(&|progress: Progress| {
            if progress.fired > 0 {
                stop.count(1);
            }
        })?;
        Ok(json!({
            "kept": done.kept,
            "run": done.run,
            "shots": done.shots,
            "bytes": done.bytes,
            "failed": done.failed,
            "seed": prepared.plan.seed,
            "warnings": prepared.warnings,
        }))
    })?;
    json::object(py, &done)
}

struct Counted<'a>(&'a Stop);

impl Watch for Counted<'_> {
    fn seen(&self) {
        self.0.count(1);
    }

    fn stopped(&self) -> bool {
        stopped()
    }
}

/// All texts of a value without the name of a folder.
fn without(folder: &str, value: Value) -> Value {
    match value {
        Value::String(text) => Value::String(text.replace(folder, "")),
        Value::Array(all) => all.into_iter().map(|one| without(folder, one)).collect(),
        Value::Object(all) => {
            all.into_iter().map(|(name, one)| (name, without(folder, one))).collect()
        }
        other => other,
    }
}

/// Times of flight from recordings; those of a folder of this process alone have no folder in their names.
#[pyfunction]
pub(crate) fn measure<'py>(
    py: Python<'py>,
    records: Vec<PathBuf>,
    options: &str,
    threads: usize,
    folder: &str,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let arguments: Measure = parsed("measure", options)?;
    let rig = measuring::rig(&arguments).map_err(PyFailure::from)?;
    let lines: Vec<String> = warnings(&rig).iter().map(Warning::one_line).collect();
    warn(py, lines.iter().map(String::as_str))?;
    // A single recording may have millions of samples.
    let (found, tables) = Job::pooled(progress, threads).run_apart(py, move |stop| {
        let how = measuring::options(&arguments, rig.as_ref())?;
        let watch = Counted(stop);
        let found = measuring::measure_watched(&records, &arguments, &how, &watch)?;
        let MeasureResult { shots: measured, curves } = found;
        let mut found = measuring::json(&measured, &curves);
        let wrong = measuring::evaluate(&measured).err();
        found["verdict"] = wrong.map_or(Value::Null, |failure| {
            failure.report(false).trim_start_matches("error: ").trim_end().into()
        });
        let tables = [
            ("shots.csv", shots_csv(&measured.shots, &curves)),
            ("speeds.csv", speeds_csv(&curves)),
            ("power-laws.csv", laws_csv(&curves)),
            ("ratios.csv", ratios_csv(&curves)),
        ];
        Ok((found, tables))
    })?;
    let found = without(folder, found);
    let reported = json::object(py, &found)?.cast_into::<PyDict>()?;
    let texts = PyDict::new(py);
    for (name, text) in tables {
        texts.set_item(name, text.replace(folder, ""))?;
    }
    reported.set_item("tables", texts)?;
    Ok(reported.into_any())
}
