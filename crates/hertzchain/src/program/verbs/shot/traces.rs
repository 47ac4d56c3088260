//! Traces, figures and the moving picture of a shot.

use crate::csv::{Column, table, view};
use crate::options::{ShotOptions as Arguments, recorded};
use crate::program::{Failure, Folder, Style, pictures};
use crate::shot::{self, ShotResult};
use crate::table::{named, suffix};
use hertzchain_chain::observe::Trace;
use hertzchain_chain::{Chain, FarEnd, Sensor, Start};
use hertzchain_experiment::{Experiment, Units};
use hertzchain_figures::Animation;
use hertzchain_sim::{Plan, Shot, shoot};
use serde_json::{Value, json};

pub(super) const SHOT: &str = "shot.json";

pub(super) const ANIMATION: &str = "animation.html";

/// Samples of a shot, unless the chain is so long that memory decides.
const SAMPLES: usize = 3000;
const FEWEST_SAMPLES: usize = 200;

/// Most numbers in memory.
const MOST_NUMBERS: usize = 25_000_000;

/// Which bodies exist: the striker's place is empty in a chain without one,
/// and the far end moves only if it is a stop.
struct Bodies {
    first: usize,
    last: usize,
}

impl Bodies {
    fn of(chain: &Chain) -> Self {
        let beads = chain.beads.len();
        let open = matches!(chain.far, FarEnd::Free | FarEnd::Periodic { .. });
        Self {
            first: usize::from(matches!(chain.start, Start::Free)),
            last: if open { beads } else { beads + 1 },
        }
    }

    fn count(&self) -> usize {
        self.last + 1 - self.first
    }

    /// Positions and velocities of all, and the forces between them.
    fn sensors(&self) -> impl Iterator<Item = Sensor> {
        let (first, last) = (self.first, self.last);
        let positions = (first..=last).map(Sensor::Position);
        let forces = (first..last).map(Sensor::Contact);
        positions.chain((first..=last).map(Sensor::Velocity)).chain(forces)
    }
}

/// Runs the shot again with everything watched that is to be written.
pub(super) fn write(
    mut folder: Folder,
    arguments: &Arguments,
    experiment: &Experiment,
    shot: &ShotResult,
) -> Result<(), Failure> {
    let plan = &shot.plan;
    let bodies = Bodies::of(&plan.chain);
    let shown = experiment.sensors();
    let mut sensors = shown.clone();
    if arguments.npy || arguments.animate {
        sensors.extend(bodies.sensors());
    }
    let mut trace = sampled(plan, shot, sensors)?;
    // Budgets stand at the ends of steps; the last step may reach beyond the shot.
    trace.budgets.extend(shot.budget.clone());
    let title = title(experiment, shot);
    if arguments.out.is_some() {
        // With what the result follows from beside the experiment's text.
        let mut all = named(json!(shot), shot.units);
        all["version"] = env!("CARGO_PKG_VERSION").into();
        all["options"] = recorded(arguments);
        folder.write(SHOT, format!("{all:#}\n").as_bytes())?;
        folder.write("experiment.toml", experiment.text().as_bytes())?;
        let noise = shot.tolerance.unwrap_or(shot.accuracy_asked);
        let table = csv(&trace, &shown, experiment, noise);
        folder.write("traces.csv", table.as_bytes())?;
        let energy = energy_csv(&trace, experiment.units());
        folder.write("energy.csv", energy.as_bytes())?;
        folder.figure("signals", &pictures::signals(experiment, &trace, (&shown, &title)))?;
        folder.figure("energy", &pictures::energy(&trace.budgets, experiment.units(), &title))?;
    }
    let columns = &trace.columns[shown.len()..];
    if arguments.npy {
        npy(&mut folder, &trace, columns, &bodies, experiment.units())?;
    }
    if arguments.animate {
        let page = animation(experiment, plan, &trace, columns, &bodies).html();
        folder.write(ANIMATION, page.as_bytes())?;
    }
    folder.finish_and_report()
}

/// The experiment's title and the speed of the striker.
fn title(experiment: &Experiment, shot: &ShotResult) -> String {
    let speed = |speed| format!(", {}", Style::brief(shot.units).quantity(speed, "m/s"));
    format!("{}{}", experiment.title(), shot.speed_m_s.map_or(String::new(), speed))
}

fn sampled(plan: &Plan, shot: &Shot, sensors: Vec<Sensor>) -> Result<Trace, Failure> {
    let samples = (MOST_NUMBERS / sensors.len().max(1)).min(SAMPLES);
    if samples < FEWEST_SAMPLES {
        let text = "the chain is too long to write every bead; leave out --npy and --animate";
        return Err(Failure::User(text.into()));
    }
    let interval_s = shot.duration_s / samples as f64;
    let watched = plan.clone().watching(sensors, Some(interval_s));
    let trace = shoot(&watched)?.trace;
    trace.ok_or_else(|| Failure::Ours("a watched shot left no trace".into()))
}

/// What was sampled; what is smaller than the solver's error, a fraction
/// `noise` of the largest number of its unit, is 0.
fn csv(trace: &Trace, sensors: &[Sensor], experiment: &Experiment, noise: f64) -> String {
    let (units, wall) = (experiment.units(), pictures::wall(experiment));
    let column = |sensor: &Sensor| {
        let (name, unit) = pictures::name(*sensor, wall);
        format!("{}{}", name.replace(' ', "_"), suffix(unit, units))
    };
    let titles = std::iter::once(format!("time{}", suffix("s", units)));
    let floors = floors(trace, sensors, wall, noise);
    let line = |(row, time): (usize, &f64)| {
        let columns = trace.columns.iter().zip(&floors).map(move |(column, floor)| {
            let value = column.get(row).copied().unwrap_or(f64::NAN);
            if value.abs() < *floor { 0.0 } else { value }
        });
        std::iter::once(*time).chain(columns).map(Value::from)
    };
    let lines = trace.time_s.iter().enumerate().map(line);
    table(titles.chain(sensors.iter().map(column)), lines)
}

/// The smallest number that means anything, a column: the solver's error is
/// common to all bodies and contacts.
fn floors(trace: &Trace, sensors: &[Sensor], wall: Option<usize>, noise: f64) -> Vec<f64> {
    let unit = |sensor: &Sensor| pictures::name(*sensor, wall).1;
    let largest = |column: &Vec<f64>| column.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let of_unit = |sensor: &Sensor| {
        let alike = sensors.iter().zip(&trace.columns);
        let alike = alike.filter(|(other, _)| unit(other) == unit(sensor));
        alike.map(|(_, column)| largest(column)).fold(0.0, f64::max)
    };
    sensors.iter().map(|sensor| noise * of_unit(sensor)).collect()
}

fn energy_csv(trace: &Trace, units: Units) -> String {
    let first = trace.budgets.first();
    let laws = first.map_or(&[][..], |budget| &budget.dissipated).iter().map(|line| line.law);
    let unit = suffix("J", units);
    let part = |name: &str| (format!("{name}{unit}"), format!("/{name}_j"));
    let parts = ["start", "driven", "kinetic", "elastic"].map(part).into_iter();
    let laws = laws.map(|law| (format!("{law}{unit}"), format!("/dissipated_j/{law}")));
    let rest = ["clipped", "gravity", "preload", "stop", "residual"].map(part);
    let time = (format!("time{}", suffix("s", units)), "/time_s".to_owned());
    let columns: Vec<Column> = [time].into_iter().chain(parts).chain(laws).chain(rest).collect();
    view(&trace.budgets.iter().map(shot::energy).collect::<Vec<_>>(), &columns)
}

fn npy(
    folder: &mut Folder,
    trace: &Trace,
    columns: &[Vec<f64>],
    bodies: &Bodies,
    units: Units,
) -> Result<(), Failure> {
    let file = |name: &str, unit| format!("{name}{}.npy", suffix(unit, units));
    let count = bodies.count();
    let (positions, rest) = columns.split_at(count.min(columns.len()));
    let (velocities, forces) = rest.split_at(count.min(rest.len()));
    let times = std::slice::from_ref(&trace.time_s);
    folder.write(&file("time", "s"), &array(times, false))?;
    folder.write(&file("position", "m"), &array(positions, true))?;
    folder.write(&file("velocity", "m/s"), &array(velocities, true))?;
    folder.write(&file("force", "N"), &array(forces, true))
}

/// Columns as a NumPy array [body][sample], or one column as [sample]: a header of a multiple of 64
/// bytes, then doubles.
fn array(columns: &[Vec<f64>], two_dimensional: bool) -> Vec<u8> {
    let samples = columns.first().map_or(0, Vec::len);
    let shape = match two_dimensional {
        true => format!("{}, {samples}", columns.len()),
        false => format!("{samples},"),
    };
    let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}");
    let length = (10 + header.len() + 1).next_multiple_of(64) - 10;
    header += &" ".repeat(length - header.len() - 1);
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((length as u16).to_le_bytes());
    bytes.extend(header.bytes().chain(*b"\n"));
    bytes.extend(columns.iter().flatten().flat_map(|value| value.to_le_bytes()));
    bytes
}

fn animation(
    experiment: &Experiment,
    plan: &Plan,
    trace: &Trace,
    columns: &[Vec<f64>],
    bodies: &Bodies,
) -> Animation {
    let radii: Vec<f64> = (bodies.first..=bodies.last).map(|b| radius(&plan.chain, b)).collect();
    let count = bodies.count();
    let mut place = 0.0;
    let mut before = radii.first().copied().unwrap_or(0.0);
    let mut positions = Vec::new();
    for (column, radius) in columns.iter().zip(&radii) {
        place += before + radius;
        before = *radius;
        positions.push(column.iter().map(|x| place + x).collect());
    }
    let forces = columns.get(2 * count..).unwrap_or_default();
    let near = match plan.chain.start {
        Start::Striker { .. } => Some((0, "striker")),
        Start::Driven { .. } => Some((0, "driven end")),
        Start::Free => None,
    };
    let wall = pictures::wall(experiment).map(|_| (count - 1, "wall"));
    let sensor = Some((plan.sensor_bead - bodies.first, "sensor bead"));
    let named = [sensor, near, wall].into_iter().flatten();
    let clock = pictures::TimeAxis::of(&trace.time_s, experiment.units());
    let wet = experiment.sections().iter().find(|section| section.wet);
    let last = plan.chain.beads.len();
    Animation {
        title: experiment.title().into(),
        marks: named.map(|(bead, name)| (bead, name.into())).collect(),
        wet_contacts: wet.map(|section| {
            (section.from.saturating_sub(bodies.first), section.last(last) - bodies.first)
        }),
        time_unit: (clock.scale, clock.unit.into()),
        force_unit: if clock.unit.is_empty() { "" } else { "N" }.into(),
        first_contact: bodies.first,
        ..Animation::new(&trace.time_s, &positions, forces, &radii)
    }
}

/// Radius of a body in m; a plane is drawn as the last bead.
fn radius(chain: &Chain, body: usize) -> f64 {
    let last = chain.beads.last().map_or(1.0, |bead| bead.radius_m);
    match (body, &chain.start, &chain.far) {
        (0, Start::Striker { bead, .. } | Start::Driven { bead, .. }, _) => bead.radius_m,
        (0, Start::Free, _) => last,
        (body, _, _) if body <= chain.beads.len() => chain.beads[body - 1].radius_m,
        (_, _, FarEnd::HalfBead { radius_m, .. } | FarEnd::Stop { radius_m, .. }) => *radius_m,
        _ => last,
    }
}
