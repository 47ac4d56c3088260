//! A posterior whose likelihoods are computed on other machines, in batches.

use crate::experiment::Experiment;
use crate::failure::PyFailure;
use crate::inference::{Found, Table, joint_problem, left};
use crate::job::Job;
use crate::options::parsed;
use hertzchain::failure::Failure;
use hertzchain::fit as fitting;
use hertzchain::options::FitOptions as Fit;
use hertzchain_infer::{Batch, CurveProblem, ModelError, Outcomes, Problem, Residuals, Spread};
use hertzchain_sim::{Stop, StudyError, stopped};
use pyo3::exceptions::PyConnectionError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::sync::OnceLock;

/// How long a look at what is computed elsewhere waits for it, in seconds.
const WAIT_S: f64 = 0.02;

/// Measurements against a model with free numbers, to be fitted; pickled, it goes
/// to where batches are computed.
#[pyclass(frozen, module = "hertzchain._hertzchain")]
pub struct Likelihood {
    inner: CurveProblem,
    arguments: Fit,
    table: Table,
    experiment: Experiment,
    options: String,
}

/// Residuals of a point with their ln σ, or why there are none.
#[derive(FromPyObject, IntoPyObject)]
enum SpreadOutcome {
    Residuals(Vec<f64>, Vec<f64>),
    PyFailure(String),
}

impl From<Result<Residuals, ModelError>> for SpreadOutcome {
    fn from(outcome: Result<Residuals, ModelError>) -> Self {
        match outcome {
            Ok(found) => Self::Residuals(found.standardised, found.ln_sigmas),
            Err(ModelError(why)) => Self::PyFailure(why),
        }
    }
}

impl From<SpreadOutcome> for Result<Residuals, ModelError> {
    fn from(outcome: SpreadOutcome) -> Self {
        match outcome {
            SpreadOutcome::Residuals(standardised, ln_sigmas) => {
                Ok(Residuals { standardised, ln_sigmas })
            }
            SpreadOutcome::PyFailure(why) => Err(ModelError(why)),
        }
    }
}

#[pymethods]
impl Likelihood {
    #[new]
    #[pyo3(signature = (table, experiment, options))]
    fn new(table: Table, experiment: &Experiment, options: String) -> Result<Self, PyFailure> {
        let arguments: Fit = parsed("fit", &options)?;
        Ok(Self {
            inner: joint_problem(&[(table.clone(), experiment.inner.clone())], &arguments)?,
            arguments,
            table,
            experiment: experiment.clone(),
            options,
        })
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let class = py.get_type::<Self>().into_any();
        let parts = (self.table.clone(), self.experiment.clone(), self.options.clone());
        Ok((class, parts.into_pyobject(py)?))
    }

    /// A short name that follows from all inputs.
    #[getter]
    fn name(&self) -> String {
        self.inner.fingerprint().short()
    }

    /// What becomes of points, in their order, computed in one thread.
    fn outcomes(&self, py: Python<'_>, points: Vec<Vec<f64>>) -> PyResult<Vec<SpreadOutcome>> {
        let wanted = self.inner.parameters().len();
        if points.iter().any(|point| point.len() != wanted) {
            let text = format!("every point has {wanted} numbers, one a free parameter");
            return Err(PyFailure::from(Failure::User(text)).into());
        }
        Job::pooled(None, 1).run(py, |_| {
            let found = self.inner.residuals(&points);
            match stopped() {
                true => Err(Failure::User(StudyError::Stopped.to_string())),
                false => Ok(found.into_iter().map(SpreadOutcome::from).collect()),
            }
        })
    }
}

/// Batches handed over to Python, and waited for.
struct Elsewhere {
    /// Given names and points of batches; gives a function that waits for some
    /// seconds, and then gives outcomes, batch by batch, or none yet.
    compute: Py<PyAny>,
    stop: Stop,
    /// What was raised when no caller could be asked any more.
    gone: OnceLock<PyErr>,
}

impl Elsewhere {
    /// The caller stops once batches are lost: nothing of it would count.
    fn outcomes(&self, batches: &[Batch]) -> Result<Vec<Outcomes>, String> {
        self.waited(batches).map_err(|error| {
            self.stop.ask();
            let why = error.to_string();
            if Python::attach(|py| error.is_instance_of::<PyConnectionError>(py)) {
                self.gone.get_or_init(|| error);
            }
            why
        })
    }

    fn waited(&self, batches: &[Batch]) -> PyResult<Vec<Outcomes>> {
        let named = batches.iter().map(|batch| (batch.name.short(), &batch.points));
        let named: Vec<_> = named.collect();
        let waiting = Python::attach(|py| self.compute.call1(py, (named,)))?;
        loop {
            if stopped() {
                return Err(PyFailure::from(Failure::User(StudyError::Stopped.to_string())).into());
            }
            let found = Python::attach(|py| {
                let found = waiting.call1(py, (WAIT_S,))?;
                found.extract::<Option<Vec<Vec<SpreadOutcome>>>>(py)
            })?;
            if let Some(found) = found {
                let batch = |found: Vec<SpreadOutcome>| found.into_iter().map(Into::into).collect();
                return Ok(found.into_iter().map(batch).collect());
            }
        }
    }
}

/// Contact parameters from times of flight, with residuals computed elsewhere in
/// batches of at most `size` points, one or more for each of the `workers`; here
/// without `compute`.
#[pyfunction]
#[pyo3(signature = (likelihood, size, workers, compute, progress))]
pub(crate) fn fit_spread<'py>(
    py: Python<'py>,
    likelihood: &Likelihood,
    size: usize,
    workers: usize,
    compute: Option<Py<PyAny>>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let arguments = &likelihood.arguments;
    let job = Job::pooled(progress, arguments.modelled.threads.map_or(0, |threads| threads.0));
    let stop = job.stop.clone();
    let elsewhere = compute.map(|compute| Elsewhere { compute, stop, gone: OnceLock::new() });
    let found = job.run(py, |_| {
        let problem = &likelihood.inner;
        let Some(elsewhere) = &elsewhere else {
            return fit_result(problem, problem, arguments);
        };
        let compute = |batches: &[Batch]| elsewhere.outcomes(batches);
        let spread = Spread::new(problem, problem.fingerprint(), size, workers, &compute);
        let found = fit_result(problem, &spread, arguments);
        match spread.failure() {
            Some(why) => Err(Failure::User(why.to_owned())),
            None => found,
        }
    });
    // A cluster that is gone is no mistake of the user's: raised as it came.
    match (found, elsewhere.and_then(|it| it.gone.into_inner())) {
        (Err(_), Some(gone)) => Err(gone),
        (found, _) => found?.reported(py),
    }
}

/// A fit, whose walkers are left in the output folder.
fn fit_result(
    problem: &CurveProblem,
    computed: &dyn Problem,
    arguments: &Fit,
) -> Result<Found, Failure> {
    let fit_result = fitting::fit_from_other_starts(problem.clone(), computed, arguments)?;
    left(&fit_result.inferred, arguments)?;
    Ok(Found::of(&fit_result, arguments))
}
