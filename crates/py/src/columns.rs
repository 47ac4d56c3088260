//! Many shots as columns of numbers.

use hertzchain_sim::{Shot, WarningSummary};
use numpy::{IntoPyArray, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// What a column is called and which number of a shot stands in it.
type Column = (&'static str, fn(&Shot) -> Option<f64>);

/// In the order in which they are reported.
const COLUMNS: [Column; 16] = [
    ("tof_incident_s", |shot| Some(shot.flight?.incident_s)),
    ("tof_reflected_s", |shot| shot.flight?.reflected_s),
    ("accuracy_reached", |shot| shot.accuracy_reached),
    ("sensor_peak_n", sensor_peak),
    ("wall_peak_n", |shot| Some(shot.wall()?.value)),
    ("returning_peak_n", |shot| Some(shot.passage.as_ref().ok()?.reflected?.value)),
    ("incident_width_s", |shot| shot.passage.as_ref().ok()?.incident_width_s),
    ("wall_width_s", |shot| shot.passage.as_ref().ok()?.wall_width_s),
    ("reflected_width_s", |shot| shot.passage.as_ref().ok()?.reflected_width_s),
    ("pulse_speed_beads_per_s", |shot| shot.pulse_speed_beads_s),
    ("striker_rebound_m_s", |shot| shot.rebound?.end_m_s),
    ("duration_s", |shot| Some(shot.duration_s)),
    ("competing_time_s", |shot| Some(shot.competing_arrival()?.time_s)),
    ("competing_peak_n", |shot| Some(shot.competing_arrival()?.value)),
    ("competing_reflected_time_s", |shot| Some(shot.competing_reflected()?.time_s)),
    ("competing_reflected_peak_n", |shot| Some(shot.competing_reflected()?.value)),
];

/// The incident pulse's, or the largest where none is seen to pass.
fn sensor_peak(shot: &Shot) -> Option<f64> {
    let passage = shot.passage.as_ref().ok();
    let largest = || shot.sensor_maxima.iter().map(|peak| peak.value).reduce(f64::max);
    passage.map(|seen| seen.incident.value).or_else(largest)
}

/// One number a shot and column; NaN where there is none.
#[derive(Debug, Default)]
pub(crate) struct Columns([Vec<f64>; COLUMNS.len()]);

impl Columns {
    /// One shot more; a row of NaN for none.
    pub(crate) fn push(&mut self, shot: Option<&Shot>) {
        for (values, (_, number)) in self.0.iter_mut().zip(COLUMNS) {
            values.push(shot.and_then(number).unwrap_or(f64::NAN));
        }
    }

    /// Arrays by name.
    pub(crate) fn arrays(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let all = PyDict::new(py);
        for (values, (name, _)) in self.0.into_iter().zip(COLUMNS) {
            all.set_item(name, values.into_pyarray(py))?;
        }
        Ok(all)
    }
}

/// Numbers and rows between two looks for signals: a few milliseconds.
const LOOK_EVERY: usize = 1 << 16;

/// Numbers of an array of any layout, in the order of a C array; broken off by a signal.
pub(crate) fn copied(py: Python<'_>, array: &PyReadonlyArrayDyn<'_, f64>) -> PyResult<Vec<f64>> {
    let array = array.as_array();
    let mut copy = Vec::with_capacity(array.len());
    for (at, number) in array.iter().enumerate() {
        if at % LOOK_EVERY == 0 {
            py.check_signals()?;
        }
        copy.push(*number);
    }
    Ok(copy)
}

/// Rows as a list; broken off by a signal.
pub(crate) fn list<'py, T: IntoPyObject<'py>>(
    py: Python<'py>,
    rows: impl IntoIterator<Item = T>,
) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for (at, row) in rows.into_iter().enumerate() {
        if at % LOOK_EVERY == 0 {
            py.check_signals()?;
        }
        list.append(row)?;
    }
    Ok(list)
}

/// The first shot with warnings, these, and how many shots have any.
pub(crate) fn summary(warnings: Option<WarningSummary>) -> Option<(usize, Vec<String>, usize)> {
    warnings.map(|first| (first.place, first.lines, first.shots))
}
