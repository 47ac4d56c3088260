//! Ensembles: shots over arrays of speeds and of named numbers.

use crate::columns::{Columns, copied, list, told};
use crate::experiment::Experiment;
use crate::failure::Failed;
use crate::job::Job;
use crate::sweep::{Asked, batch};
use hertzchain::failure::{Failure, of_speed};
use hertzchain_sim::{Shard, StudyError, stopped};
use numpy::{IntoPyArray, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Why a row has no shot.
fn why(error: &StudyError) -> String {
    let of_speed = match error {
        StudyError::Mistakes(mistakes) => of_speed(mistakes),
        _ => None,
    };
    of_speed.unwrap_or_else(|| error.to_string())
}

/// Shots of rows of speeds and numbers.
#[pyfunction]
#[pyo3(signature = (experiment, speeds_m_s, names, values, asked, progress))]
pub(crate) fn ensemble<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    speeds_m_s: PyReadonlyArrayDyn<'py, f64>,
    names: Vec<String>,
    values: Vec<PyReadonlyArrayDyn<'py, f64>>,
    asked: Asked,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let speeds_m_s = copied(py, &speeds_m_s)?;
    let values = all_copied(py, &values)?;
    let numbers: Vec<_> = names.into_iter().zip(values.iter().cloned()).collect();
    let batch = batch(experiment, &speeds_m_s, &numbers, &asked).map_err(Failed::from)?;
    let (columns, errors, rows) = Job::pooled(progress, asked.threads).run(py, |stop| {
        let mut columns = Columns::default();
        let mut errors = Vec::new();
        let (result, _) = batch.run_each(Shard::WHOLE, &|| stop.count(1), |row| {
            columns.push(row.shot.as_ref().ok());
            errors.extend(row.shot.err().map(|error| (row.place, why(&error))));
        });
        match stopped() {
            true => Err(Failure::from(StudyError::Stopped)),
            false => Ok((columns, errors, result.rows)),
        }
    })?;
    let found = PyDict::new(py);
    found.set_item("speed_m_s", speeds_m_s.into_pyarray(py))?;
    let values = values.into_iter().map(|own| own.into_pyarray(py));
    found.set_item("values", values.collect::<Vec<_>>())?;
    found.set_item("columns", columns.arrays(py)?)?;
    found.set_item("errors", list(py, errors)?)?;
    found.set_item("odd", told(rows.warnings))?;
    Ok(found)
}

/// Numbers of several arrays.
pub(crate) fn all_copied(
    py: Python<'_>,
    arrays: &[PyReadonlyArrayDyn<'_, f64>],
) -> PyResult<Vec<Vec<f64>>> {
    arrays.iter().map(|array| copied(py, array)).collect()
}
