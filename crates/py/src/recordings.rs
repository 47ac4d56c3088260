//! Recordings: made on a virtual rig, and measured.

use crate::experiment::Experiment;
use crate::failure::Failed;
use crate::job::Job;
use crate::json;
use hertzchain::failure::Failure;
use hertzchain::inference::wanted;
use hertzchain::measure as measuring;
use hertzchain::options::MeasureOptions as Measure;
use hertzchain::options::parsed;
use hertzchain_measure::{Curves, Watch, laws_csv, ratios_csv, shots_csv, speeds_csv};
use hertzchain_sim::rig::{Plan, RigError};
use hertzchain_sim::{Stop, stopped};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// The user's mistakes are reported as such; a full disk is not theirs.
fn failure(error: RigError) -> Failure {
    match error {
        RigError::Mistakes(mistakes) => (*mistakes).into(),
        RigError::Record(error) => Failure::Ours(error.to_string()),
        other => Failure::User(other.to_string()),
    }
}

/// How many series a campaign has.
#[pyfunction]
#[pyo3(signature = (experiment, seed))]
pub(crate) fn campaign_series(experiment: &Experiment, seed: Option<u64>) -> Result<usize, Failed> {
    let plan = Plan::new(&experiment.inner, seed).map_err(failure)?;
    Ok(plan.series.len())
}

/// Runs the series of a campaign that a folder does not have yet.
#[pyfunction]
#[pyo3(signature = (experiment, out, shard, seed, threads, progress))]
pub(crate) fn campaign<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    out: PathBuf,
    shard: &str,
    seed: Option<u64>,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let part = shard.parse();
    let part = part.map_err(|error: hertzchain_sim::StudyError| {
        Failed::from(Failure::User(error.to_string()))
    })?;
    let (done, seed, warnings) = Job::pooled(progress, threads).run(py, |stop| {
        let plan = Plan::new(&experiment.inner, seed).map_err(failure)?;
        let warnings = hertzchain_sim::rig::forecast(&plan).map_err(failure)?;
        let watch = |progress: hertzchain_sim::rig::Progress| {
            if progress.fired > 0 {
                stop.count(1);
            }
        };
        let done = hertzchain_sim::rig::campaign(&plan, &out, part, &watch).map_err(failure)?;
        Ok((done, plan.seed, warnings))
    })?;
    let reported = PyDict::new(py);
    reported.set_item("kept", done.kept)?;
    reported.set_item("run", done.run)?;
    reported.set_item("shots", done.shots)?;
    reported.set_item("bytes", done.bytes)?;
    reported.set_item("failed", done.failed)?;
    reported.set_item("seed", seed)?;
    reported.set_item("warnings", warnings)?;
    Ok(reported)
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

/// Times of flight from recordings.
#[pyfunction]
#[pyo3(signature = (options, threads, progress))]
pub(crate) fn measure<'py>(
    py: Python<'py>,
    options: Vec<String>,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let arguments: Measure = parsed("measure", &options).map_err(Failed::from)?;
    // A single recording may have millions of samples.
    let (found, tables) = Job::pooled(progress, threads).run_apart(py, move |stop| {
        let (files, notes) = measuring::files(&arguments.records, arguments.shots.as_deref())?;
        let how = measuring::options(&arguments)?;
        let mut measured = hertzchain_measure::measure(&files, &how, &Counted(stop));
        measured.notes.splice(0..0, notes);
        wanted()?;
        measuring::suits(&measured)?;
        let grouping = measuring::grouping(&arguments);
        let curves = Curves::of(&measured.shots, &grouping);
        wanted()?;
        let mut found = measuring::json(&measured, &curves);
        let wrong = measuring::evaluate(&measured).err();
        found["verdict"] = wrong.map_or(serde_json::Value::Null, |failure| {
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
    let reported = json::object(py, &found)?.cast_into::<PyDict>()?;
    let texts = PyDict::new(py);
    for (name, text) in tables {
        texts.set_item(name, text)?;
    }
    reported.set_item("tables", texts)?;
    Ok(reported.into_any())
}
