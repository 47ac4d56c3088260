//! Why times of flight on a tapped chain are not those of the model's compact one: friction holds loads
//! on the contacts. Strikers have exactly the programmed speed and times are those of the true peaks, so
//! nothing of measuring is in the differences from what `sweep` says of the same file.

use crate::rig::instruments::true_speed_m_s;
use crate::rig::recorder::Window;
use crate::rig::shot::{Bench, shoot};
use crate::rig::{Plan, Purpose, RandomStream, Series};
use hertzchain_chain::System;
use hertzchain_experiment::Experiment;
use std::error::Error;

type Outcome<T> = Result<T, Box<dyn Error + Send + Sync>>;

/// As the preset, but for what only costs time here.
const ALWAYS: [(&str, f64); 4] = [
    ("campaign.taps", 10.0),
    ("campaign.speed_count", 4.0),
    ("campaign.recorder.record", 1e-4),
    ("campaign.recorder.before", 0.0),
];

/// Force on bead 1, which every contact bears.
const PUSH: &str = "near_end.force";

/// Shots of a series.
const SHOTS: usize = 5;

/// Added to standard errors of so few shots, which chance can make very small, in s.
const AT_LEAST_S: f64 = 0.02e-6;

#[test]
fn times_of_tapped_rows_depart_from_the_model_by_the_load_that_friction_holds() -> Outcome<()> {
    let paper = hertzchain_experiment::preset("paper")?.set(&ALWAYS)?;
    let departures = |friction: Option<f64>| {
        let change = friction.map(|friction| ("track.friction", friction));
        let plan = Plan::new(&paper.set(change.as_slice())?, None)?;
        let slow = |series: &&Series| {
            plan.case(series).name == "gear" && (0.15..0.25).contains(&series.programmed_m_s)
        };
        let series = plan.series.iter().find(slow).ok_or("no such series")?;
        let found = departures(&plan, series, SHOTS)?;
        let (mean_s, error_s) = moments(&found.times_s);
        // The model with the mean load has the same departure.
        let unlike_s = (mean_s - found.by_load_s).abs();
        assert!(unlike_s < 3.0 * (error_s + AT_LEAST_S), "{mean_s:e}, by load {}", found.by_load_s);
        Outcome::Ok(mean_s.abs())
    };
    let (as_preset_s, slippery_s) = (departures(None)?, departures(Some(1e-3))?);
    assert!(as_preset_s > 1e-6 && slippery_s < 0.13e-6, "{as_preset_s:e} s, {slippery_s:e} s");
    Ok(())
}

/// Incident times of one series less the model's, in s.
struct Departures {
    times_s: Vec<f64>,
    /// The same by the model with the mean load.
    by_load_s: f64,
}

fn departures(plan: &Plan, series: &Series, shots: usize) -> Outcome<Departures> {
    let case = plan.case(series);
    let experiment = &case.experiment;
    let campaign = experiment.campaign();
    let (sensor, speed_m_s) = (experiment.sensor_bead(), series.programmed_m_s);
    let mut random = RandomStream::new(plan.seed, series.number, Purpose::Assembly);
    let mut bench = Bench::assemble(experiment, &mut random)?;
    let model_s = model_s(experiment, speed_m_s)?;
    let mut times_s = Vec::new();
    let (mut more_n, mut random) =
        (0.0, RandomStream::new(plan.seed, series.number, Purpose::Shot(0)));
    for _ in 0..shots {
        for _ in 0..campaign.taps {
            let tap_m_s = true_speed_m_s(&campaign.actuator, campaign.tap_speed_m_s, &mut random);
            bench.tap(tap_m_s)?;
        }
        let (equilibrium, held) = bench.systems(speed_m_s)?;
        let [equal_n, held_n] = [&equilibrium, &held].map(|system| load_n(system, sensor));
        more_n += (held_n - equal_n) / shots as f64;
        let mut trace = Window::new(&campaign.recorder, 0.0, &mut random).trace();
        let shot = shoot(&mut bench, sensor, speed_m_s, &mut trace)?;
        times_s.push(shot.incident_s - model_s);
    }
    let whole = &plan.experiment;
    let pushed = whole.set(&[(PUSH, whole.get(PUSH)? + more_n)])?;
    let pushed = pushed.case(&case.name).ok_or("the case is gone")??;
    Ok(Departures { times_s, by_load_s: self::model_s(&pushed, speed_m_s)? - model_s })
}

/// Mean force in N of the contacts at rest from the sensor bead to the wall.
fn load_n(system: &System, sensor: usize) -> f64 {
    let contacts = sensor..=system.beads();
    let count = contacts.clone().count() as f64;
    let forces = contacts.map(|contact| system.static_contact(contact).force_n);
    forces.sum::<f64>() / count
}

/// Incident time of flight in s of the compact chain.
fn model_s(experiment: &Experiment, speed_m_s: f64) -> Outcome<f64> {
    let (plan, _) = crate::Plan::from_experiment(experiment, Some(speed_m_s))?;
    let shot = crate::shoot(&plan.for_flights().with_accuracy(1e-8))?;
    Ok(shot.flight.ok_or("the wave does not reach the wall")?.incident_s)
}

/// Mean and standard error.
fn moments(of: &[f64]) -> (f64, f64) {
    let count = of.len() as f64;
    let mean = of.iter().sum::<f64>() / count;
    let squares: f64 = of.iter().map(|x| (x - mean).powi(2)).sum();
    (mean, (squares / (count * (count - 1.0))).sqrt())
}
