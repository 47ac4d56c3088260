//! One shot.

use crate::experiment::Experiment;
use crate::failure::{PyFailure, finding};
use crate::job::Job;
use crate::json;
use crate::law::{Force, Replacing};
use crate::options::parsed;
use hertzchain::failure::Failure;
use hertzchain::options::ShotOptions;
use hertzchain::shot::PreparedShot;
use hertzchain_chain::Sensor;
use hertzchain_chain::observe::Trace;
use hertzchain_chain::wave::Budget;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::json;

/// Sensors by kind and number, and the interval of their samples in s.
type Watched = (Vec<(String, usize)>, Option<f64>);

/// A sensor by its kind and the number of its bead or contact.
fn sensor(kind: &str, number: usize) -> Result<Sensor, Failure> {
    match kind {
        "bead" => Ok(Sensor::Bead(number)),
        "contact" => Ok(Sensor::Contact(number)),
        "position" => Ok(Sensor::Position(number)),
        "velocity" => Ok(Sensor::Velocity(number)),
        "bead_plus_wall" => Ok(Sensor::BeadPlusWall(number)),
        _ => Err(Failure::User(format!(
            "there is no sensor `{kind}`; expected bead, contact, position, velocity or bead_plus_wall"
        ))),
    }
}

/// The sensors asked for; the experiment's own where none is named.
fn sensors(experiment: &Experiment, asked: &[(String, usize)]) -> Result<Vec<Sensor>, Failure> {
    if asked.is_empty() {
        return Ok(experiment.inner.sensors());
    }
    let beads = experiment.inner.beads();
    let known = |sensor: &Sensor| match *sensor {
        Sensor::Bead(number) | Sensor::BeadPlusWall(number) => (1..=beads).contains(&number),
        Sensor::Contact(number) => number <= beads,
        // The striker is body 0, the wall comes after the last bead.
        Sensor::Position(number) | Sensor::Velocity(number) => number <= beads + 1,
    };
    let within = |(kind, number): &(String, usize)| {
        let found = sensor(kind, *number)?;
        known(&found).then_some(found).ok_or_else(|| {
            Failure::User(format!(
                "there is no {kind} {number} in a chain of {beads} beads, which are counted from 1"
            ))
        })
    };
    asked.iter().map(within).collect()
}

/// Kind and number of a sensor.
const fn name(sensor: Sensor) -> (&'static str, usize) {
    match sensor {
        Sensor::Bead(number) => ("bead", number),
        Sensor::Contact(number) => ("contact", number),
        Sensor::Position(number) => ("position", number),
        Sensor::Velocity(number) => ("velocity", number),
        Sensor::BeadPlusWall(number) => ("bead_plus_wall", number),
    }
}

/// A shot; `watch` are sensors by kind and number, with the interval of their samples in s.
#[pyfunction]
pub(crate) fn shot<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    options: &str,
    watch: Option<Watched>,
    forces: Vec<Bound<'py, Force>>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let options: ShotOptions = parsed("shot", options)?;
    let mut prepared = PreparedShot::new(&experiment.inner, &options).map_err(PyFailure::from)?;
    let job = Job::of_steps(progress);
    let replacing = Replacing::of(&forces, &job.stop);
    replacing.put_into(&mut prepared.plan.chain).map_err(PyFailure::from)?;
    prepared.plan.budget = replacing.have_energy();
    if let Some((asked, interval_s)) = watch {
        let sensors = sensors(experiment, &asked).map_err(PyFailure::from)?;
        prepared.plan = prepared.plan.watching(sensors, interval_s);
    }
    let computed = job.run(py, |_| prepared.run());
    replacing.raised(py)?;
    let shot = computed?;
    let reported = json::object(py, &json!(shot))?.cast_into::<PyDict>()?;
    let warnings: PyResult<Vec<_>> = shot.warnings.iter().map(|it| finding(py, it)).collect();
    reported.set_item("warnings", warnings?)?;
    reported.set_item("trace", shot.trace.as_ref().map(|it| trace(py, it)).transpose()?)?;
    reported.set_item("velocities_m_s", shot.velocity_m_s.clone().into_pyarray(py))?;
    Ok(reported)
}

/// A name, and the number of a budget.
type EnergyColumn = (&'static str, fn(&Budget) -> f64);

/// Columns of an energy budget along the way.
const ENERGY: [EnergyColumn; 10] = [
    ("time_s", |b| b.time_s),
    ("start_j", |b| b.start_j),
    ("driven_j", |b| b.driven_j),
    ("kinetic_j", |b| b.kinetic_j),
    ("elastic_j", |b| b.elastic_j),
    ("clipped_j", |b| b.clipped_j),
    ("gravity_j", |b| b.gravity_j),
    ("preload_j", |b| b.preload_j),
    ("stop_j", |b| b.stop_j),
    ("dissipated_j", |b| b.dissipated.iter().map(|line| line.energy_j).sum()),
];

/// Times, sensors, one array a sensor, and the energy along the way.
fn trace<'py>(py: Python<'py>, trace: &Trace) -> PyResult<Bound<'py, PyDict>> {
    let reported = PyDict::new(py);
    reported.set_item("time_s", trace.time_s.clone().into_pyarray(py))?;
    let names: Vec<_> = trace.sensors.iter().map(|sensor| name(*sensor)).collect();
    reported.set_item("sensors", names)?;
    let columns = trace.columns.iter().map(|it| it.clone().into_pyarray(py));
    reported.set_item("columns", columns.collect::<Vec<_>>())?;
    let energy = PyDict::new(py);
    for (name, number) in ENERGY {
        let column: Vec<f64> = trace.budgets.iter().map(number).collect();
        energy.set_item(name, column.into_pyarray(py))?;
    }
    reported.set_item("energy", energy)?;
    Ok(reported)
}
