//! Why times of flight on a tapped chain are not those of the model's compact one.
//!
//! The preset's rig with one thing changed at a time. Strikers have exactly the
//! programmed speed and times are those of the true peaks, so nothing of measuring is in
//! the differences from what `sweep` says of the same file. Beside them stands what the model
//! says of the mean load that the contacts behind the sensor bead really have.
#![allow(clippy::print_stdout, reason = "an example talks")]

use crate::rig::instruments::true_speed_m_s;
use crate::rig::recorder::Window;
use crate::rig::shot::{Bench, shoot};
use crate::rig::{Plan, Purpose, RandomStream, Series};
use hertzchain_chain::System;
use hertzchain_experiment::Experiment;
use rayon::prelude::*;
use std::error::Error;
use std::fmt::Write as _;

type Outcome<T> = Result<T, Box<dyn Error + Send + Sync>>;

/// What is changed, and how: paths of the experiment file in SI.
type Change = (&'static str, &'static [(&'static str, f64)]);

const CHANGES: [Change; 10] = [
    ("as the preset", &[]),
    ("no gaps as laid", &[("campaign.laying.gap_scatter", 0.0)]),
    ("radii spread by 0.02 %", &[("campaign.laying.radius_spread", 2e-4)]),
    ("no taps", &[("campaign.taps", 0.0)]),
    ("no slope", &[("track.incline", 0.0)]),
    ("stop a thousand times as heavy", &[("far_end.mass", 4500.0)]),
    ("push 0.96 N", &[("near_end.force", 0.96), ("near_end.stiffness", 400.0)]),
    ("friction 0.2", &[("track.friction", 0.2)]),
    ("friction 0.0125", &[("track.friction", 0.0125)]),
    ("friction 0.001", &[("track.friction", 1e-3)]),
];

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

#[test]
#[ignore = "prints a table in some minutes: cargo test --release -p hertzchain-sim departures -- --ignored --nocapture"]
fn departures_of_tapped_rows_from_the_model() -> Outcome<()> {
    let paper = hertzchain_experiment::preset("paper")?;
    let plans = CHANGES.iter().map(|(_, change)| {
        let plan = paper.set(&ALWAYS)?.set(change)?;
        Ok(Plan::new(&plan, None)?)
    });
    let plans: Vec<Plan> = plans.collect::<Outcome<_>>()?;
    let due = plans.iter().flat_map(|plan| {
        let series = plan.series.iter();
        series.map(move |series| (plan, series))
    });
    let due: Vec<(&Plan, &Series)> = due.collect();
    let done = due.par_iter().with_max_len(1);
    let done = done.map(|(plan, series)| departures(plan, series, SHOTS));
    let mut done = done.collect::<Outcome<Vec<Departures>>>()?.into_iter();
    println!("| rig | case | m/s | load | incident, µs | by load | reflected, µs | by load |");
    println!("|---|---|---|---|---|---|---|---|");
    let mut rigs = Vec::new();
    for ((name, _), plan) in CHANGES.iter().zip(&plans) {
        let mut rig = Vec::new();
        for (series, found) in plan.series.iter().zip(&mut done) {
            let case = &plan.case(series).name;
            let name = format!("{name} | {case} | {:.3}", series.programmed_m_s);
            println!("| {name} | {}", found.cells());
            rig.push((name, found));
        }
        rigs.push((*name, rig));
    }
    tell_largest(&rigs);
    tell_loads(&rigs);
    Ok(())
}

/// Series of a rig by name.
type OfRig = (&'static str, Vec<(String, Departures)>);

/// The largest mean departures on each rig.
fn tell_largest(rigs: &[OfRig]) {
    println!("\nLargest mean departure of incident and reflected times, µs:");
    for (name, series) in rigs {
        let largest = [0, 1].map(|time: usize| {
            let all = series.iter().map(|(_, found)| found.reported(time).0.abs());
            1e6 * all.fold(0.0, f64::max)
        });
        println!("  {name}: {:.2}, {:.2}", largest[0], largest[1]);
    }
}

/// Added to standard errors of so few shots, which chance can make very small, in s.
const AT_LEAST_S: f64 = 0.02e-6;

/// In how many series the model with the mean load determines the incident departure, and the others.
fn tell_loads(rigs: &[OfRig]) {
    let series: Vec<&(String, Departures)> = rigs.iter().flat_map(|(_, rig)| rig).collect();
    let missed = series.iter().filter(|(_, found)| {
        let (mean_s, error_s) = found.reported(0);
        (mean_s - found.by_load_s[0]).abs() > 3.0 * (error_s + AT_LEAST_S)
    });
    let missed: Vec<_> = missed.collect();
    println!(
        "\nThe mean load determines the incident departure within three standard errors, {:.0} ns added \
         to each, in {} of {} series; in the others (departure, by load, µs):",
        1e9 * AT_LEAST_S,
        series.len() - missed.len(),
        series.len()
    );
    for (name, found) in missed {
        let [departure, by_load] = [found.reported(0).0, found.by_load_s[0]].map(|s| 1e6 * s);
        println!("  {name}: {departure:+.2}, {by_load:+.2}");
    }
}

/// Of one series.
struct Departures {
    /// Load of contacts from the sensor bead on over that in equilibrium, less 1.
    load: Vec<f64>,
    /// Incident and reflected times less the model's, in s.
    times_s: [Vec<f64>; 2],
    /// The same by the model with the mean load.
    by_load_s: [f64; 2],
}

fn departures(plan: &Plan, series: &Series, shots: usize) -> Outcome<Departures> {
    let case = plan.case(series);
    let experiment = &case.experiment;
    let campaign = experiment.campaign();
    let (sensor, speed_m_s) = (experiment.sensor_bead(), series.programmed_m_s);
    let mut random = RandomStream::new(plan.seed, series.number, Purpose::Assembly);
    let mut bench = Bench::assemble(experiment, &mut random)?;
    let model_s = model_s(experiment, speed_m_s)?;
    let mut found = Departures {
        load: Vec::new(),
        times_s: [Vec::new(), Vec::new()],
        by_load_s: [f64::NAN; 2],
    };
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
        found.load.push(held_n / equal_n - 1.0);
        let mut trace = Window::new(&campaign.recorder, 0.0, &mut random).trace();
        let shot = shoot(&mut bench, sensor, speed_m_s, &mut trace)?;
        found.times_s[0].push(shot.incident_s - model_s[0]);
        found.times_s[1].push(shot.reflected_s - model_s[1]);
    }
    let whole = &plan.experiment;
    let pushed = whole.set(&[(PUSH, whole.get(PUSH)? + more_n)])?;
    let pushed = pushed.case(&case.name).ok_or("the case is gone")??;
    let pushed_s = self::model_s(&pushed, speed_m_s)?;
    found.by_load_s = [0, 1].map(|time: usize| pushed_s[time] - model_s[time]);
    Ok(found)
}

/// Mean force in N of the contacts at rest from the sensor bead to the wall.
fn load_n(system: &System, sensor: usize) -> f64 {
    let contacts = sensor..=system.beads();
    let count = contacts.clone().count() as f64;
    let forces = contacts.map(|contact| system.static_contact(contact).force_n);
    forces.sum::<f64>() / count
}

/// Incident and reflected time of flight in s of the compact chain.
fn model_s(experiment: &Experiment, speed_m_s: f64) -> Outcome<[f64; 2]> {
    let (plan, _) = crate::Plan::from_experiment(experiment, Some(speed_m_s))?;
    let shot = crate::shoot(&plan.for_flights().with_accuracy(1e-8))?;
    let flight = shot.flight.ok_or("the wave does not reach the wall")?;
    Ok([flight.incident_s, flight.reflected_s.unwrap_or(f64::NAN)])
}

impl Departures {
    /// Mean and standard error in s of a time's departures.
    fn reported(&self, time: usize) -> (f64, f64) {
        moments(&self.times_s[time])
    }

    fn cells(&self) -> String {
        let mut cells = format!("{} % |", mean(&self.load, 1e2, 1));
        for (times_s, by_load_s) in self.times_s.iter().zip(self.by_load_s) {
            let _ = write!(cells, " {} | {:+.2} |", mean(times_s, 1e6, 2), 1e6 * by_load_s);
        }
        cells
    }
}

/// Mean and standard error.
fn moments(of: &[f64]) -> (f64, f64) {
    let count = of.len() as f64;
    let mean = of.iter().sum::<f64>() / count;
    let squares: f64 = of.iter().map(|x| (x - mean).powi(2)).sum();
    (mean, (squares / (count * (count - 1.0))).sqrt())
}

/// Mean and standard error in a unit.
fn mean(of: &[f64], unit: f64, digits: usize) -> String {
    let (mean, error) = moments(of);
    format!("{:+.digits$} ± {:.digits$}", unit * mean, unit * error)
}
