//! How often batches are less right than was asked and than they state, over presets and rows drawn at random.
//!
//! ```sh
//! cargo run --release -p hertzchain-random --example batches -- 100 --speeds 50   # rows 0 to 99 of seed 1
//! cargo run --release -p hertzchain-random --example batches -- --preset pump --speeds 2000
//! ```
//!
//! `--preset FILE.toml` takes an experiment of one's own, and `--damping 14` varies its cubic coefficient (20 to 80 kg s/m²)
//! and viscosity (10 to 30 kPa s) in so many steps each. Speeds of a row are from a third to three times its own, of a
//! preset from 0.075 to 1.23 m/s, evenly spread in their logarithm. A batch of them, as `sweep` makes it (of it every K-th
//! shot with `--every K`), is compared with shots by the adaptive loop at a hundredth of the accuracy asked, and where these
//! contradict it with others at 1e-10. Accuracies are 1e-3 to 1e-7, by turns.
#![allow(
    clippy::print_stdout,
    dead_code,
    reason = "an example prints; modules of the bench are shared"
)]

#[path = "../src/draw.rs"]
mod draw;
#[path = "../src/physics.rs"]
mod physics;
#[path = "../src/row.rs"]
mod row;

use hertzchain_experiment::{Experiment, preset};
use hertzchain_sim::{
    Batch, BatchOptions, Column, Control, InstructionSet, Plan, Shard, parse_speeds, run_plans,
};
use std::collections::BTreeMap;
use std::error::Error;
use std::time::Instant;

type Failure = Box<dyn Error + Send + Sync>;

const ACCURACIES: [f64; 5] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7];
/// Accuracy of shots that decide where two runs contradict.
const EXACT: f64 = 1e-10;
/// A row is left out whose first shots take longer than this in s.
const PATIENCE_S: f64 = 0.2;

#[derive(Default)]
struct Tally {
    batches: u64,
    shots: u64,
    not_reached: u64,
    above_asked: u64,
    above_stated: u64,
    far_above: u64,
    worst: f64,
    /// Shots a second of the last batch, on all threads.
    rate_per_s: f64,
}

/// Incident and reflected time of flight in s, NaN where there is none.
type Times = [f64; 2];

fn error(one: Times, other: Times) -> f64 {
    let change = |of: usize| match (one[of].is_nan(), other[of].is_nan()) {
        (true, true) => 0.0,
        (false, false) => (one[of] / other[of] - 1.0).abs(),
        _ => f64::INFINITY,
    };
    change(0).max(change(1))
}

/// A speed in m/s, and the cubic coefficient and viscosity where they vary.
type Inputs = (f64, Option<[f64; 2]>);

/// Paths of what a map of damping varies, with the least and the largest value.
const DAMPING: [(&str, f64, f64); 2] =
    [("damping_cubic.coefficient", 20.0, 80.0), ("materials.aisi316.shear_viscosity", 1e4, 3e4)];

/// All speeds with all pairs of dampings.
fn inputs(speeds: &[f64], steps: usize) -> Vec<Inputs> {
    if steps == 0 {
        return speeds.iter().map(|speed| (*speed, None)).collect();
    }
    let value = |of: usize, at: usize| {
        let (_, least, most) = DAMPING[of];
        least + (most - least) * at as f64 / (steps - 1) as f64
    };
    let pairs = (0..steps * steps).map(|at| [value(0, at / steps), value(1, at % steps)]);
    pairs.flat_map(|pair| speeds.iter().map(move |speed| (*speed, Some(pair)))).collect()
}

fn with_damping(experiment: &Experiment, damping: Option<[f64; 2]>) -> Result<Experiment, Failure> {
    let Some([one, two]) = damping else { return Ok(experiment.clone()) };
    Ok(experiment.set(&[(DAMPING[0].0, one), (DAMPING[1].0, two)])?)
}

fn batch(experiment: &Experiment, inputs: &[Inputs], accuracy: f64) -> Result<Batch, Failure> {
    let options = BatchOptions { accuracy, ..BatchOptions::of(experiment) };
    let speeds = inputs.iter().map(|(speed, _)| *speed).collect();
    let mut batch = Batch::new(experiment, speeds, options)?;
    for (of, (path, ..)) in DAMPING.iter().enumerate() {
        let values: Vec<f64> = inputs.iter().filter_map(|(_, it)| Some(it.as_ref()?[of])).collect();
        if !values.is_empty() {
            batch = batch.with_number(path, values)?;
        }
    }
    Ok(batch)
}

/// Times by the adaptive loop.
fn adaptive(
    experiment: &Experiment,
    inputs: &[Inputs],
    accuracy: f64,
) -> Result<Vec<Times>, Failure> {
    let plan = |(speed, damping): &Inputs| -> Result<_, Failure> {
        Ok(Plan::from_experiment(&with_damping(experiment, *damping)?, Some(*speed))?)
    };
    let plans: Result<Vec<_>, _> = inputs.iter().map(plan).collect();
    let plans: Vec<Plan> =
        plans?.into_iter().map(|(plan, _)| plan.with_accuracy(accuracy).for_flights()).collect();
    let control = Control::PerShot { checked: true };
    let shots = run_plans(&plans, control, InstructionSet::default(), &|| {});
    let times = |shot: Result<hertzchain_sim::Shot, _>| {
        let flight = shot.ok().and_then(|shot| shot.flight);
        flight.map_or([f64::NAN; 2], |of| [of.incident_s, of.reflected_s.unwrap_or(f64::NAN)])
    };
    Ok(shots.into_iter().map(times).collect())
}

fn compare(
    name: &str,
    experiment: &Experiment,
    (inputs, every): (&[Inputs], usize),
    accuracy: f64,
    tally: &mut Tally,
) -> Result<(), Failure> {
    let begun = Instant::now();
    let result = batch(experiment, inputs, accuracy)?.run(Shard::WHOLE, &|| {});
    tally.rate_per_s = inputs.len() as f64 / begun.elapsed().as_secs_f64();
    let column = |of| result.rows.column(of);
    let places: Vec<usize> = (0..inputs.len()).step_by(every).collect();
    let compared: Vec<Inputs> = places.iter().map(|&place| inputs[place]).collect();
    let near = adaptive(experiment, &compared, 0.01 * accuracy)?;
    tally.batches += 1;
    for (place, near) in places.into_iter().zip(near) {
        let found = [Column::Incident, Column::Reflected].map(|of| column(of)[place]);
        let stated = column(Column::Accuracy)[place];
        tally.shots += 1;
        if stated > accuracy {
            tally.not_reached += 1;
            continue;
        }
        let allowed = if stated > 0.0 { stated.min(accuracy) } else { accuracy };
        let mut error_made = error(found, near);
        if error_made > allowed {
            let exact = adaptive(experiment, &inputs[place..=place], EXACT)?;
            error_made = error(found, exact[0]);
        }
        tally.worst = tally.worst.max(error_made / accuracy);
        tally.above_stated += u64::from(error_made > allowed);
        tally.above_asked += u64::from(error_made > accuracy);
        tally.far_above += u64::from(error_made > 3.0 * accuracy);
        if error_made > allowed {
            println!(
                "{name}, {:?} at {accuracy:.0e}: {error_made:.2e}, stated {stated:.2e}, {found:?}; {}",
                inputs[place], result.error_control
            );
        }
    }
    Ok(())
}

fn main() -> Result<(), Failure> {
    let (mut count, mut from, mut seed, mut speeds) = (0_u64, 0_u64, 1_u64, 50_usize);
    let (mut presets, mut seconds, mut beads, mut every) = (Vec::new(), u64::MAX, 40_usize, 1);
    let mut damping = 0_usize;
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or("an option lacks its value");
        match word.as_str() {
            "--from" => from = value()?.parse()?,
            "--seed" => seed = value()?.parse()?,
            "--speeds" => speeds = value()?.parse()?,
            "--damping" => damping = value()?.parse()?,
            "--every" => every = value()?.parse()?,
            "--beads" => beads = value()?.parse()?,
            "--seconds" => seconds = value()?.parse()?,
            "--preset" => presets.push(value()?),
            number => count = number.parse()?,
        }
    }
    let begun = Instant::now();
    let mut tallies = BTreeMap::<String, Tally>::new();
    for name in presets {
        let experiment = match name.ends_with(".toml") {
            true => Experiment::from_text(&name, &std::fs::read_to_string(&name)?)?,
            false => preset(&name)?,
        };
        let speeds = parse_speeds(&format!("log:0.075:1.23:{speeds}"))?;
        let inputs = inputs(&speeds, damping);
        for accuracy in ACCURACIES {
            let tally = tallies.entry(format!("{name} {accuracy:.0e}")).or_default();
            compare(&name, &experiment, (&inputs, every), accuracy, tally)?;
        }
    }
    for at in (from..from + count).take_while(|_| begun.elapsed().as_secs() < seconds) {
        let drawn = draw::row(seed, at, None);
        if drawn.beads.len() > beads {
            continue;
        }
        let Ok(experiment) = Experiment::from_text("row.toml", &drawn.toml()) else { continue };
        let first = Instant::now();
        let own = [drawn.speed_m_s];
        if adaptive(&experiment, &[(own[0], None)], 1e-8).is_err()
            || first.elapsed().as_secs_f64() > PATIENCE_S
        {
            continue;
        }
        let accuracy = ACCURACIES[(at % 5) as usize];
        let range = parse_speeds(&format!("log:{}:{}:{speeds}", own[0] / 3.0, own[0] * 3.0))?;
        let tally = tallies.entry(format!("rows {accuracy:.0e}")).or_default();
        let name = format!("row {at} of seed {seed}");
        let inputs = inputs(&range, 0);
        if let Err(why) = compare(&name, &experiment, (&inputs, every), accuracy, tally) {
            println!("{name}: {why}");
        }
    }
    println!(
        "way\tbatches\tshots\tnot reached\tabove stated\tabove asked\tabove 3\tworst over asked\tshots/s"
    );
    for (name, of) in tallies {
        println!(
            "{name}\t{}\t{}\t{}\t{}\t{}\t{}\t{:.2}\t{:.0}",
            of.batches,
            of.shots,
            of.not_reached,
            of.above_stated,
            of.above_asked,
            of.far_above,
            of.worst,
            of.rate_per_s
        );
    }
    Ok(())
}
