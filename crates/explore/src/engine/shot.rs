//! One shot with everything that the page draws of it.

use super::{Array, Mistake, Refusal, effort, outline};
use hertzchain_chain::observe::{Maximum, Trace};
use hertzchain_chain::wave::Budget;
use hertzchain_chain::{Chain, FarEnd, Sensor, Start, System};
use hertzchain_experiment::Experiment;
use hertzchain_sim::{Plan, Shot, StudyError, shoot, shoot_estimated};
use serde::Serialize;
use serde_json::{Value as Json, json};

/// Most samples of a signal, and most numbers of a motion: some ten megabytes of JSON.
const MOST_SAMPLES: usize = 4000;
const MOST_NUMBERS: usize = 2_000_000;

/// A body as it is drawn.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Body {
    /// `striker`, `driven`, `bead`, `half-bead` or `plane`.
    kind: &'static str,
    /// Its number: 0 for the striker, 1 for the first bead.
    number: usize,
    /// Radius in m.
    radius_m: f64,
    /// Mass in kg; null where it does not move.
    mass_kg: Option<f64>,
    /// Where its centre rests, in m.
    rest_m: f64,
    /// Whether it is the sensor bead.
    sensor: bool,
    /// Whether its contact with the next body is wet.
    wet: bool,
}

/// Returns one shot at the experiment's own speed.
pub(super) fn shot(text: &str, samples: usize, draft: bool) -> Result<Json, Refusal> {
    let experiment = outline::experiment(text)?;
    let refused = |mistakes| Refusal::of_text(text, &mistakes);
    let (plan, warnings) = Plan::from_experiment(&experiment, None).map_err(refused)?;
    let plan = if draft { plan } else { plan.with_budget() };
    effort::check_time(&plan, 1)?;
    let failed = |error| match &error {
        StudyError::Solve(why) => refused(experiment.unsolved(why)),
        StudyError::NotConverged(why) => refused(experiment.unreached(why)),
        _ => Refusal::of_study(text, error),
    };
    let shot = if draft { shoot(&plan) } else { shoot_estimated(&plan) };
    let shot = shot.map_err(failed)?;
    let system = plan.chain.system().map_err(Refusal::words)?;
    let bodies = bodies(&experiment, &plan.chain, &system);
    let trace = match samples {
        0 => None,
        asked => Some(sampled(&plan, &shot, &bodies, asked).map_err(failed)?),
    };
    let mut all = numbers(&experiment, &plan, &shot);
    all["warnings"] = json!(Mistake::all(text, &warnings));
    all["energy"] = json!(trace.as_ref().and_then(|(trace, _)| energy(trace, &shot)));
    all["motion"] = json!(trace.map(|(trace, step_s)| motion(&trace, step_s, &plan, &bodies)));
    all["bodies"] = json!(bodies);
    Ok(all)
}

/// The numbers of a shot, nothing that is drawn.
fn numbers(experiment: &Experiment, plan: &Plan, shot: &Shot) -> Json {
    let seen = shot.passage.as_ref().ok();
    let missing = shot.passage.as_ref().err().map(|error| match plan.chain.far {
        FarEnd::Free | FarEnd::Periodic { .. } => "the chain has no wall".to_owned(),
        _ => error.to_string(),
    });
    let rebound = shot.rebound.as_ref();
    json!({
        "speed_m_s": experiment.speed_m_s(),
        "tof_incident_s": shot.flight.map(|flight| flight.incident_s),
        "tof_reflected_s": shot.flight.and_then(|flight| flight.reflected_s),
        "accuracy_reached": shot.accuracy_reached,
        "missing": missing,
        "incident": seen.map(|seen| peak(&seen.incident, seen.incident_width_s)),
        "wall": shot.wall().map(|wall| peak(&wall, seen.and_then(|seen| seen.wall_width_s))),
        "reflected": seen
            .and_then(|seen| Some(peak(seen.reflected.as_ref()?, seen.reflected_width_s))),
        "pulse_speed_beads_s": shot.pulse_speed_beads_s,
        "rebound_first_m_s": rebound.and_then(|rebound| Some(rebound.first?.1)),
        "rebound_end_m_s": rebound.and_then(|rebound| rebound.end_m_s),
        "velocity_m_s": shot.velocity_m_s,
        "duration_s": shot.duration_s,
        "solver": shot.solver,
        "force_passes": shot.work.force_passes,
        "notes": shot.notes,
    })
}

/// A maximum of a signal, with its full width at half maximum.
fn peak(of: &Maximum, width_s: Option<f64>) -> Json {
    json!({ "time_s": of.time_s, "value_n": of.value, "width_s": width_s })
}

/// The bodies in a row, gaps and all, from left to right.
fn bodies(experiment: &Experiment, chain: &Chain, system: &System) -> Vec<Body> {
    let wet = |contact: usize| {
        let sections = experiment.sections().iter().filter(|section| section.wet);
        let mut ranges = sections.map(|section| section.from..=section.last(chain.beads.len()));
        ranges.any(|range| range.contains(&contact))
    };
    let body = |kind, number, radius_m, mass_kg| Body {
        kind,
        number,
        radius_m,
        mass_kg,
        rest_m: 0.0,
        sensor: kind == "bead" && number == experiment.sensor_bead(),
        wet: wet(number),
    };
    let first = match &chain.start {
        Start::Striker { bead, .. } => Some(body("striker", 0, bead.radius_m, Some(bead.mass_kg))),
        Start::Driven { bead, .. } => Some(body("driven", 0, bead.radius_m, None)),
        Start::Free => None,
    };
    let beads = chain.beads.iter().enumerate();
    let beads = beads.map(|(at, bead)| body("bead", at + 1, bead.radius_m, Some(bead.mass_kg)));
    let (end, last) = (chain.beads.len() + 1, chain.beads.last().map_or(1.0, |bead| bead.radius_m));
    let far = match &chain.far {
        FarEnd::HalfBead { radius_m, .. } => Some(body("half-bead", end, *radius_m, None)),
        FarEnd::Stop { radius_m, mass_kg, .. } => {
            Some(body("half-bead", end, *radius_m, Some(*mass_kg)))
        }
        FarEnd::Plane { .. } => Some(body("plane", end, last, None)),
        FarEnd::PlaneStop { mass_kg, .. } => Some(body("plane", end, last, Some(*mass_kg))),
        FarEnd::Periodic { .. } | FarEnd::Free => None,
    };
    let mut all: Vec<Body> = first.into_iter().chain(beads).chain(far).collect();
    place(&mut all, system);
    all
}

/// Puts each body beside the one before; a plane's face touches the last bead.
fn place(bodies: &mut [Body], system: &System) {
    let mut edge_m = 0.0;
    for body in bodies {
        if body.number > 0 {
            edge_m -= system.static_contact(body.number - 1).overlap_m.min(0.0);
        }
        let plane = body.kind == "plane";
        body.rest_m = edge_m + if plane { 0.0 } else { body.radius_m };
        edge_m = body.rest_m + if plane { 0.0 } else { body.radius_m };
    }
}

/// The shot again, with everything watched that is drawn; and the time between samples in s.
fn sampled(
    plan: &Plan,
    shot: &Shot,
    bodies: &[Body],
    asked: usize,
) -> Result<(Trace, f64), StudyError> {
    let samples = asked.min(MOST_SAMPLES).min(MOST_NUMBERS / (2 * bodies.len().max(1)));
    let interval_s = shot.duration_s / samples.max(2) as f64;
    // Without a wall there is no contact N: the column stays unused.
    let wall = match has_wall(plan) {
        true => Sensor::Contact(plan.chain.beads.len()),
        false => Sensor::Bead(plan.sensor_bead),
    };
    let signals = [Sensor::Bead(plan.sensor_bead), wall];
    let positions = bodies.iter().map(|body| Sensor::Position(body.number));
    let forces = contacts(bodies).map(Sensor::Contact);
    let sensors = signals.into_iter().chain(positions).chain(forces).collect();
    let trace = shoot(&plan.clone().watching(sensors, Some(interval_s)))?.trace;
    let trace = trace.ok_or_else(|| StudyError::Refused("the shot left no trace".to_owned()))?;
    Ok((trace, interval_s))
}

fn has_wall(plan: &Plan) -> bool {
    !matches!(plan.chain.far, FarEnd::Free | FarEnd::Periodic { .. })
}

/// Contacts between the bodies that are drawn.
fn contacts(bodies: &[Body]) -> impl Iterator<Item = usize> {
    let last = bodies.last().map_or(0, |body| body.number);
    bodies.first().map_or(0, |body| body.number)..last
}

/// Signals in N, none of a wall where there is none; displacements in m, body after body; dynamic
/// forces in N, contact after contact. The first sample is at 0.
fn motion(trace: &Trace, interval_s: f64, plan: &Plan, bodies: &[Body]) -> Json {
    let (signals, rest) = trace.columns.split_at(2);
    let (positions, forces) = rest.split_at(bodies.len());
    json!({
        "interval_s": interval_s,
        "samples": trace.time_s.len(),
        "sensor_n": Array::of(&signals[0]),
        "wall_n": Array::of(signals[1].iter().filter(|_| has_wall(plan))),
        "displacement_m": Array::of(positions.iter().flatten()),
        "force_n": Array::of(forces.iter().flatten()),
    })
}

/// Energy over time in J: curves by name, each that is ever more than a millionth of the whole, which
/// together are what was put in; and what is missing at the end, over that.
fn energy(trace: &Trace, shot: &Shot) -> Option<Json> {
    let last = shot.budget.as_ref()?;
    let budgets: Vec<&Budget> = trace.budgets.iter().chain([last]).collect();
    let part = |name: &'static str, of: &dyn Fn(&Budget) -> f64| {
        (name, budgets.iter().map(|budget| of(budget)).collect::<Vec<f64>>())
    };
    let lost = (0..last.dissipated.len()).map(|at| {
        let of = move |budget: &Budget| budget.dissipated.get(at).map_or(0.0, |line| line.energy_j);
        part(last.dissipated[at].law, &of)
    });
    let held = [part("kinetic", &|b| b.kinetic_j), part("elastic", &|b| b.elastic_j)];
    let rest = [
        part("clipped", &|b| b.clipped_j),
        part("gravity", &|b| b.gravity_j),
        part("preload", &|b| b.preload_j),
        part("stop", &|b| b.stop_j),
    ];
    let matters = |curve: &[f64]| curve.iter().any(|energy| energy.abs() > 1e-6 * last.input_j);
    let all = held.into_iter().chain(lost).chain(rest).filter(|(_, curve)| matters(curve));
    let parts = all.map(|(name, curve)| (name, Array::of(&curve))).collect::<Vec<_>>();
    Some(json!({
        "time_s": Array(budgets.iter().map(|budget| budget.time_s as f32).collect()),
        "input_j": last.input_j,
        "parts": parts,
        "relative_residual": last.relative_residual(),
    }))
}
