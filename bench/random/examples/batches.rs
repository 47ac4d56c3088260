//! How often batches are less right than was asked and than they state, over presets and rows drawn at random.
//!
//! ```sh
//! cargo run --release -p hertzchain-random --example batches -- 100 --speeds 50   # rows 0 to 99 of seed 1
//! cargo run --release -p hertzchain-random --example batches -- --preset pump --speeds 2000
//! ```
//!
//! Speeds of a row are from a third to three times its own, of a preset from 0.075 to 1.23 m/s, evenly spread in
//! their logarithm. A batch of them, as `sweep` makes it, is compared with shots by the adaptive loop at a hundredth
//! of the accuracy asked, and where these contradict it with others at 1e-10. Accuracies are 1e-3 to 1e-7, by turns.
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

/// Times by the adaptive loop at the speeds.
fn adaptive(experiment: &Experiment, speeds: &[f64], accuracy: f64) -> Result<Vec<Times>, Failure> {
    let plan = |speed: &f64| Plan::from_experiment(experiment, Some(*speed));
    let plans: Result<Vec<_>, _> = speeds.iter().map(plan).collect();
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
    (experiment, speeds): (&Experiment, &str),
    accuracy: f64,
    tally: &mut Tally,
) -> Result<(), Failure> {
    let speeds = parse_speeds(speeds)?;
    let options = BatchOptions { accuracy, ..BatchOptions::of(experiment) };
    let result = Batch::new(experiment, speeds.clone(), options)?.run(Shard::WHOLE, &|| {});
    let column = |of| result.rows.column(of);
    let near = adaptive(experiment, &speeds, 0.01 * accuracy)?;
    tally.batches += 1;
    for (place, near) in near.into_iter().enumerate() {
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
            let exact = adaptive(experiment, &speeds[place..=place], EXACT)?;
            error_made = error(found, exact[0]);
        }
        tally.worst = tally.worst.max(error_made / accuracy);
        tally.above_stated += u64::from(error_made > allowed);
        tally.above_asked += u64::from(error_made > accuracy);
        tally.far_above += u64::from(error_made > 3.0 * accuracy);
        if error_made > allowed {
            println!(
                "{name}, {} m/s at {accuracy:.0e}: {error_made:.2e}, stated {stated:.2e}, {found:?}; {}",
                speeds[place], result.error_control
            );
        }
    }
    Ok(())
}

fn main() -> Result<(), Failure> {
    let (mut count, mut from, mut seed, mut speeds) = (0_u64, 0_u64, 1_u64, 50_usize);
    let (mut presets, mut seconds, mut beads) = (Vec::new(), u64::MAX, 40_usize);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or("an option lacks its value");
        match word.as_str() {
            "--from" => from = value()?.parse()?,
            "--seed" => seed = value()?.parse()?,
            "--speeds" => speeds = value()?.parse()?,
            "--beads" => beads = value()?.parse()?,
            "--seconds" => seconds = value()?.parse()?,
            "--preset" => presets.push(value()?),
            number => count = number.parse()?,
        }
    }
    let begun = Instant::now();
    let mut tallies = BTreeMap::<String, Tally>::new();
    for name in presets {
        let experiment = preset(&name)?;
        for accuracy in ACCURACIES {
            let tally = tallies.entry(format!("{name} {accuracy:.0e}")).or_default();
            compare(&name, (&experiment, &format!("log:0.075:1.23:{speeds}")), accuracy, tally)?;
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
        if adaptive(&experiment, &own, 1e-8).is_err() || first.elapsed().as_secs_f64() > PATIENCE_S
        {
            continue;
        }
        let accuracy = ACCURACIES[(at % 5) as usize];
        let range = format!("log:{}:{}:{speeds}", own[0] / 3.0, own[0] * 3.0);
        let tally = tallies.entry(format!("rows {accuracy:.0e}")).or_default();
        let name = format!("row {at} of seed {seed}");
        if let Err(why) = compare(&name, (&experiment, &range), accuracy, tally) {
            println!("{name}: {why}");
        }
    }
    println!(
        "way\tbatches\tshots\tnot reached\tabove stated\tabove asked\tabove 3\tworst over asked"
    );
    for (name, of) in tallies {
        println!(
            "{name}\t{}\t{}\t{}\t{}\t{}\t{}\t{:.2}",
            of.batches,
            of.shots,
            of.not_reached,
            of.above_stated,
            of.above_asked,
            of.far_above,
            of.worst
        );
    }
    Ok(())
}
