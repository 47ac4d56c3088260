//! Failures as Python's exceptions, with the reports of the command line.

use hertzchain::failure::{self, Failure};
use hertzchain_experiment::{Finding, Mistakes};
use hertzchain_measure::records::without_controls as plain;
use miette::Diagnostic;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ffi::CString;

/// Where the exceptions are declared.
const ERRORS: &str = "hertzchain.errors";

/// A failure on its way to Python.
pub struct PyFailure(Failure);

impl<E: Into<Failure>> From<E> for PyFailure {
    fn from(error: E) -> Self {
        Self(error.into())
    }
}

impl From<PyFailure> for PyErr {
    fn from(PyFailure(failure): PyFailure) -> Self {
        Python::attach(|py| match raised(py, &failure) {
            Ok(error) => Self::from_value(error),
            Err(error) => error,
        })
    }
}

fn raised<'py>(py: Python<'py>, failure: &Failure) -> PyResult<Bound<'py, PyAny>> {
    let class = |name: &str| py.import(ERRORS)?.getattr(name);
    match failure {
        Failure::Mistakes(mistakes) => {
            let report = failure.report(false);
            class("ExperimentError")?.call1((plain(report.trim_end()), findings(py, mistakes)?))
        }
        Failure::User(text) => class("OptionError")?.call1((plain(text),)),
        Failure::Ours(text) => class("InternalError")?.call1((plain(text),)),
        Failure::BrokenPipe => class("InternalError")?.call1(("broken pipe",)),
    }
}

fn findings<'py>(py: Python<'py>, mistakes: &Mistakes) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let all = mistakes.findings().iter();
    all.map(|found| finding(py, found)).collect()
}

/// Warns of what is improbable about an experiment, a line each, in the caller of the function that
/// calls the extension.
pub(crate) fn warn<'a>(py: Python<'_>, lines: impl Iterator<Item = &'a str>) -> PyResult<()> {
    let class = py.import(ERRORS)?.getattr("ExperimentWarning")?;
    for line in lines {
        PyErr::warn(py, &class, &CString::new(plain(line).as_bytes())?, 2)?;
    }
    Ok(())
}

/// What, where, what was expected.
pub(crate) fn finding<'py>(py: Python<'py>, found: &Finding) -> PyResult<Bound<'py, PyDict>> {
    let reported = PyDict::new(py);
    reported.set_item("file", found.file())?;
    reported.set_item("line", found.line())?;
    reported.set_item("text", found.text())?;
    reported.set_item("message", found.to_string())?;
    reported.set_item("expected", found.label())?;
    reported.set_item("help", found.help().map(|help| help.to_string()))?;
    reported.set_item("report", failure::report(found, false).trim_end())?;
    Ok(reported)
}
