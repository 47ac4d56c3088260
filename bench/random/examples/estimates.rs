//! How often the accuracy that a shot states is below its error, over rows drawn at random.
//!
//! ```sh
//! cargo run --release -p hertzchain-random --example estimates -- 1000 --seed 11
//! cargo run --release -p hertzchain-random --example estimates -- 1 --from 301 --seed 11
//! cargo run --release -p hertzchain-random --example estimates -- 400 --seed 12 --family stops
//! ```
//!
//! Each row is shot at accuracies from 1e-3 to 1e-8, half a decade apart, as the verb `shot` does it,
//! and compared with runs of the same loop at the tightest tolerances: a maximum that all runs miss does
//! not show. The table of `docs/notes/2026-11-25-stated-accuracy.md`.
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

use draw::Family;
use hertzchain_experiment::Experiment;
use hertzchain_sim::{Control, InstructionSet, Plan, Shot, run_plans, shoot, shoot_estimated};
use std::error::Error;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// Accuracies of the reference, and of the run that shows how right it is.
const EXACT: [f64; 2] = [1e-12, 1e-11];
/// Errors below this are the reference's rounding.
const ROUNDING: f64 = 1e-12;

/// What is to be done.
struct Options {
    count: u64,
    seed: u64,
    from: u64,
    jobs: u64,
    beads: usize,
    family: Option<Family>,
    /// By the loop with equal steps, as a sweep of few speeds, instead.
    sweep: bool,
    /// Print the peaks of single runs at tolerances half a decade apart instead.
    runs: bool,
    /// Print the experiment files instead.
    files: bool,
}

impl Options {
    fn parsed(mut words: impl Iterator<Item = String>) -> Result<Self, Box<dyn Error>> {
        let mut options = Self {
            count: 100,
            seed: 11,
            from: 0,
            jobs: 2,
            beads: 25,
            family: None,
            sweep: false,
            runs: false,
            files: false,
        };
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or("an option lacks its value");
            match word.as_str() {
                "--seed" => options.seed = value()?.parse()?,
                "--from" => options.from = value()?.parse()?,
                "--jobs" => options.jobs = value()?.parse()?,
                "--beads" => options.beads = value()?.parse()?,
                "--family" => options.family = Family::named(&value()?),
                "--sweep" => options.sweep = true,
                "--runs" => options.runs = true,
                "--files" => options.files = true,
                count => options.count = count.parse()?,
            }
        }
        Ok(options)
    }
}

#[derive(Default)]
struct Tally {
    rows: u64,
    unresolved: u64,
    results: u64,
    /// The asked accuracy was reported as not reached.
    reported: u64,
    /// The stated one is below the error.
    above: u64,
    worst: f64,
    force_passes: f64,
}

/// Relative error of the times of flight of a shot beside another.
fn error(shot: &Shot, exact: &Shot) -> Option<f64> {
    match (shot.flight, exact.flight) {
        (Some(one), Some(two)) => Some(one.change(&two)),
        (None, None) => None,
        _ => Some(f64::INFINITY),
    }
}

/// Times and heights of the three peaks.
fn peaks(shot: &Shot) -> String {
    match &shot.passage {
        Ok(seen) => {
            let all = [Some(seen.incident), Some(seen.wall), seen.reflected];
            let text = |peak: &hertzchain_chain::observe::Maximum| {
                format!("{:.9e} s {:.9e} N", peak.time_s, peak.value)
            };
            let all = all.iter().map(|peak| peak.as_ref().map_or("none".to_owned(), text));
            all.collect::<Vec<_>>().join(", ")
        }
        Err(why) => why.to_string(),
    }
}

fn run(plan: &Plan, sweep: bool) -> Option<Shot> {
    match sweep {
        false => shoot_estimated(&plan.clone().with_budget()).ok(),
        true => {
            let plans = [plan.clone().for_flights()];
            let control = Control::PerShot { checked: false };
            run_plans(&plans, control, InstructionSet::default(), &|| {}).pop()?.ok()
        }
    }
}

/// A line a tolerance: the row, the tolerance, and times and heights of the three peaks.
fn print_runs(at: u64, plan: &Plan) {
    let mut text = String::new();
    for half_decades in 5..=25 {
        let accuracy = 10_f64.powf(-0.5 * f64::from(half_decades));
        let Ok(shot) = shoot(&plan.clone().for_flights().with_accuracy(accuracy)) else { continue };
        text += &format!("{at}\t{:e}\t{}\t", shot.tolerance.unwrap_or(0.0), shot.work.force_passes);
        text += &match &shot.passage {
            Ok(seen) => {
                let peaks = [Some(seen.incident), Some(seen.wall), seen.reflected];
                let cells = peaks.map(|peak| {
                    peak.map_or("nan,nan".to_owned(), |it| {
                        format!("{:.16e},{:.16e}", it.time_s, it.value)
                    })
                });
                cells.join(",")
            }
            Err(_) => String::new(),
        };
        text += "\n";
    }
    print!("{text}");
}

fn row(options: &Options, at: u64) -> Option<Tally> {
    let drawn = draw::row(options.seed, at, options.family);
    if drawn.beads.len() > options.beads {
        return None;
    }
    if options.files {
        println!("{}", drawn.toml());
        return None;
    }
    let experiment = Experiment::from_text("row.toml", &drawn.toml()).ok()?;
    let plan = Plan::from_experiment(&experiment, None).ok()?.0;
    if options.runs {
        print_runs(at, &plan);
        return None;
    }
    let exact = EXACT.map(|accuracy| shoot(&plan.clone().for_flights().with_accuracy(accuracy)));
    let [Ok(exact), Ok(looser)] = exact else { return None };
    let mut tally = Tally { rows: 1, ..Tally::default() };
    let own = error(&looser, &exact)?;
    for half_decades in 6..=16 {
        let accuracy = 10_f64.powf(-0.5 * f64::from(half_decades));
        let Some(shot) = run(&plan.clone().with_accuracy(accuracy), options.sweep) else {
            continue;
        };
        let (Some(error), Some(stated)) = (error(&shot, &exact), shot.accuracy_reached) else {
            continue;
        };
        if own > 0.1 * accuracy {
            tally.unresolved += 1;
            continue;
        }
        tally.results += 1;
        tally.force_passes += shot.work.force_passes as f64;
        tally.reported += u64::from(stated > accuracy);
        let over = (error - 3.0 * own - ROUNDING) / stated;
        tally.worst = tally.worst.max(over);
        if over > 1.0 {
            tally.above += 1;
            println!(
                "row {at}, {accuracy:.1e}: error {error:.3e}, stated {stated:.3e}, {over:.2} times; tolerance {:?}, \
                 {}, laws {:?}\n  {}\n  {}",
                shot.tolerance,
                shot.solver,
                drawn.sections,
                peaks(&shot),
                peaks(&exact)
            );
        }
    }
    Some(tally)
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parsed(std::env::args().skip(1))?;
    let next = AtomicU64::new(options.from);
    let whole = Mutex::new(Tally::default());
    let work = || {
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            if at >= options.from + options.count {
                break;
            }
            let Some(of_row) = row(&options, at) else { continue };
            let Ok(mut whole) = whole.lock() else { break };
            whole.rows += of_row.rows;
            whole.unresolved += of_row.unresolved;
            whole.results += of_row.results;
            whole.reported += of_row.reported;
            whole.above += of_row.above;
            whole.worst = whole.worst.max(of_row.worst);
            whole.force_passes += of_row.force_passes;
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..options.jobs {
            scope.spawn(work);
        }
    });
    let whole = whole.into_inner()?;
    println!(
        "{} rows, {} results ({} unresolved): {} above what is stated, worst {:.2} times; {} reported as not reached; \
         {:.3e} force passes",
        whole.rows,
        whole.results,
        whole.unresolved,
        whole.above,
        whole.worst,
        whole.reported,
        whole.force_passes
    );
    Ok(())
}
