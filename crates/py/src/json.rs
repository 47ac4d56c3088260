//! JSON as Python's own objects, number by number.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde_json::{Number, Value};

/// Dicts, lists, strings, numbers, None; no digit is lost on the way. Broken off by a signal.
pub(crate) fn object<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Value::Null => Ok(py.None().into_bound(py)),
        Value::Bool(flag) => Ok(flag.into_pyobject(py)?.to_owned().into_any()),
        Value::Number(value) => number(py, value),
        Value::String(text) => Ok(text.into_pyobject(py)?.into_any()),
        Value::Array(values) => {
            let one = |value| py.check_signals().and_then(|()| object(py, value));
            let all: PyResult<Vec<_>> = values.iter().map(one).collect();
            Ok(PyList::new(py, all?)?.into_any())
        }
        Value::Object(fields) => {
            let all = PyDict::new(py);
            for (key, value) in fields {
                all.set_item(key, object(py, value)?)?;
            }
            Ok(all.into_any())
        }
    }
}

fn number<'py>(py: Python<'py>, value: &Number) -> PyResult<Bound<'py, PyAny>> {
    match (value.as_u64(), value.as_i64()) {
        (Some(whole), _) => Ok(whole.into_pyobject(py)?.into_any()),
        (None, Some(whole)) => Ok(whole.into_pyobject(py)?.into_any()),
        (None, None) => {
            let real = value.as_f64().unwrap_or(f64::NAN);
            Ok(real.into_pyobject(py)?.into_any())
        }
    }
}
