//! One shot.

use crate::experiment::Experiment;
use crate::failure::{Failed, finding};
use crate::job::Job;
use crate::json;
use crate::law::{Force, Replacing};
use hertzchain::failure::Failure;
use hertzchain::options::Given;
use hertzchain::options::{SimulationOptions as How, parsed};
use hertzchain::{input, json as results};
use hertzchain_chain::Sensor;
use hertzchain_chain::observe::Trace;
use hertzchain_sim::{Plan, Shot, shoot_checked, shoot_estimated};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

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
    let bodies = experiment.inner.beads() + 1;
    let within = |(kind, number): &(String, usize)| match *number <= bodies {
        true => sensor(kind, *number),
        false => Err(Failure::User(format!(
            "there is no {kind} {number} in a chain of {} beads",
            bodies - 1
        ))),
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

/// A shot at a speed as it would be written on the command line; `watch` are sensors
/// by kind and number, with the interval of their samples in s.
#[pyfunction]
#[pyo3(signature = (experiment, speed, options, watch, forces, progress))]
pub(crate) fn shot<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    speed: Option<String>,
    options: Vec<String>,
    watch: Option<Watched>,
    forces: Vec<Bound<'py, Force>>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let inner = &experiment.inner;
    let how: How = parsed("shot", &options).map_err(Failed::from)?;
    let given = speed.map(|text| Given::speed(&text)).transpose();
    let given = given.map_err(|error| Failed::from(Failure::User(error.to_string())))?;
    let speed_m_s = input::speed(given.as_ref(), inner).map_err(Failed::from)?;
    let planned = planned(experiment, given.as_ref(), speed_m_s, &how);
    let (mut plan, warnings) = planned.map_err(Failed::from)?;
    let job = Job::of_steps(progress);
    let replacing = Replacing::of(&forces, &job.stop);
    replacing.put_into(&mut plan.chain).map_err(Failed::from)?;
    plan.budget = replacing.have_energy();
    if let Some((asked, interval_s)) = watch {
        let sensors = sensors(experiment, &asked).map_err(Failed::from)?;
        plan = plan.watching(sensors, interval_s);
    }
    let computed = job.run(py, |_| {
        let shot = match how.check {
            true => shoot_checked(&plan),
            false => shoot_estimated(&plan),
        };
        shot.map_err(|error| Failure::of_shot(inner, &how, error))
    });
    replacing.raised(py)?;
    let shot = computed?;
    let found = results::shot_of(inner, speed_m_s, &plan, &shot);
    let reported = json::object(py, &found)?.cast_into::<PyDict>()?;
    let warnings: PyResult<Vec<_>> = warnings.iter().map(|odd| finding(py, odd)).collect();
    reported.set_item("warnings", warnings?)?;
    reported.set_item("trace", shot.trace.as_ref().map(|it| trace(py, it)).transpose()?)?;
    reported.set_item("velocities_m_s", velocities(py, &shot))?;
    Ok(reported)
}

type Planned = Result<(Plan, Vec<hertzchain_experiment::Warning>), Failure>;

fn planned(
    experiment: &Experiment,
    given: Option<&Given>,
    speed_m_s: Option<f64>,
    how: &How,
) -> Planned {
    let inner = &experiment.inner;
    input::check_times(how, inner)?;
    let planned = Plan::from_experiment(inner, speed_m_s);
    let (mut plan, warnings) = input::at_speed(given, planned)?;
    input::adjust(how, &mut plan);
    input::check_effort(how, &plan, inner.units())?;
    Ok((plan, warnings))
}

fn velocities<'py>(py: Python<'py>, shot: &Shot) -> Bound<'py, PyArray1<f64>> {
    shot.velocity_m_s.clone().into_pyarray(py)
}

/// Times, sensors, one array a sensor, and the energy along the way.
fn trace<'py>(py: Python<'py>, trace: &Trace) -> PyResult<Bound<'py, PyDict>> {
    let reported = PyDict::new(py);
    reported.set_item("time_s", trace.time_s.clone().into_pyarray(py))?;
    let names: Vec<_> = trace.sensors.iter().map(|sensor| name(*sensor)).collect();
    reported.set_item("sensors", names)?;
    let columns = trace.columns.iter().map(|it| it.clone().into_pyarray(py));
    reported.set_item("columns", columns.collect::<Vec<_>>())?;
    let energy = PyDict::new(py);
    let budgets = || trace.budgets.iter();
    let put = |name: &str, values: Vec<f64>| energy.set_item(name, values.into_pyarray(py));
    put("time_s", budgets().map(|b| b.time_s).collect())?;
    put("start_j", budgets().map(|b| b.start_j).collect())?;
    put("driven_j", budgets().map(|b| b.driven_j).collect())?;
    put("kinetic_j", budgets().map(|b| b.kinetic_j).collect())?;
    put("elastic_j", budgets().map(|b| b.elastic_j).collect())?;
    put("clipped_j", budgets().map(|b| b.clipped_j).collect())?;
    put("gravity_j", budgets().map(|b| b.gravity_j).collect())?;
    put("preload_j", budgets().map(|b| b.preload_j).collect())?;
    put("stop_j", budgets().map(|b| b.stop_j).collect())?;
    let lost = budgets().map(|b| b.dissipated.iter().map(|line| line.energy_j).sum());
    put("dissipated_j", lost.collect())?;
    reported.set_item("energy", energy)?;
    Ok(reported)
}
