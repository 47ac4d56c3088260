//! How often the accuracy that shots and sweeps state is below their error, over many rows drawn at random.
//!
//! ```sh
//! cargo run --release -p hertzchain-random --example estimates -- 1000 --seed 11
//! cargo run --release -p hertzchain-random --example estimates -- 1 --from 301 --seed 11 --every 1
//! cargo run --release -p hertzchain-random --example estimates -- 400 --seed 12 --family stops
//! ```
//!
//! Each row is run as the verbs `shot` and `sweep` do it at 1e-6, and at another accuracy by turns, and compared
//! with a tighter run of the same loop; where the error may be above half of what is stated, with runs at the
//! tightest tolerances; where it may be still, and in every twentieth row, with the independent integration.
#![allow(
    clippy::print_stdout,
    dead_code,
    reason = "an example prints; modules of the bench are shared"
)]

#[path = "../src/arrival.rs"]
mod arrival;
#[path = "../src/draw.rs"]
mod draw;
#[path = "../src/motion.rs"]
mod motion;
#[path = "../src/physics.rs"]
mod physics;
#[path = "../src/reference.rs"]
mod reference;
#[path = "../src/row.rs"]
mod row;

use draw::Family;
use hertzchain_experiment::Experiment;
use hertzchain_sim::{
    Control, Flight, InstructionSet, Plan, Shot, Stop, pool, run_plans, shoot, shoot_estimated,
};
use reference::Reference;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::error::Error;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Accuracy of the run that all are compared with, over the one asked, and at most.
const NEAR: (f64, f64) = (1e-2, 1e-8);
/// Accuracies of the reference, and of the run that shows how right it is.
const EXACT: [f64; 2] = [1e-12, 1e-11];
/// Errors below this are the reference's rounding.
const ROUNDING: f64 = 1e-12;
/// Errors over the stated one from which on they are computed more tightly.
const SUSPECT: f64 = 0.5;
/// Accuracies by turns, beside 1e-6.
const TURNS: [f64; 5] = [1e-3, 1e-4, 1e-5, 1e-7, 1e-8];
/// A row that takes longer is stopped and counted.
const PATIENCE: Duration = Duration::from_secs(2);

/// What is to be done.
struct Options {
    count: u64,
    seed: u64,
    from: u64,
    jobs: u64,
    beads: usize,
    family: Option<Family>,
    /// Every so many rows are compared with the independent integration.
    every: u64,
    /// No row is begun after this time in s.
    seconds: u64,
    /// Only by `shot` at 1e-6.
    shots: bool,
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
            beads: 100,
            family: None,
            every: 20,
            seconds: u64::MAX,
            shots: false,
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
                "--every" => options.every = value()?.parse()?,
                "--seconds" => options.seconds = value()?.parse()?,
                "--family" => options.family = Family::named(&value()?),
                "--shots" => options.shots = true,
                "--runs" => options.runs = true,
                "--files" => options.files = true,
                count => options.count = count.parse()?,
            }
        }
        Ok(options)
    }
}

/// Of one way of asking.
#[derive(Default)]
struct Tally {
    runs: u64,
    /// Refused, or stopped because it takes too long.
    silent: u64,
    unresolved: u64,
    /// The asked accuracy was reported as not reached.
    reported: u64,
    /// Runs whose error is above half of the stated one, above it, and above three times it.
    suspect: u64,
    above: u64,
    far_above: u64,
    worst: f64,
    /// Compared with the independent integration.
    independent: u64,
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

/// One way of asking.
#[derive(Clone, Copy)]
struct Ask {
    sweep: bool,
    accuracy: f64,
}

impl Ask {
    fn name(self) -> String {
        format!("{} {:.0e}", if self.sweep { "sweep" } else { "shot" }, self.accuracy)
    }

    fn run(self, plan: &Plan) -> Option<Shot> {
        let plan = plan.clone().with_accuracy(self.accuracy);
        match self.sweep {
            false => shoot_estimated(&plan.with_budget()).ok(),
            true => {
                let control = Control::PerShot { checked: false };
                let set = InstructionSet::default();
                let plans = [plan.for_flights()];
                let one = pool(1).ok()?;
                one.install(|| run_plans(&plans, control, set, &|| {})).pop()?.ok()
            }
        }
    }
}

/// Relative error of times of flight beside others; `None` where neither has any.
fn error(one: Option<Flight>, other: Option<Flight>) -> Option<f64> {
    match (one, other) {
        (Some(one), Some(two)) => Some(one.change(&two)),
        (None, None) => None,
        _ => Some(f64::INFINITY),
    }
}

/// Times of flight by the independent integration, and how right they are.
fn independent(row: &row::Row) -> Option<(Option<Flight>, f64)> {
    let mut reference = Reference::tight(row);
    reference.cover(0.0).ok()?;
    let arrival = reference.signals().arrival()?;
    let wall = arrival.wall;
    let flight_s = |incident: motion::Maximum| wall.time_s - incident.time_s;
    let flight = arrival.incident.map(|incident| Flight {
        incident_s: flight_s(incident),
        reflected_s: arrival.reflected.map(|back| back.time_s - wall.time_s),
    });
    let shortest_s = flight.map_or(wall.time_s, |flight| {
        flight.reflected_s.map_or(flight.incident_s, |back_s| back_s.min(flight.incident_s))
    });
    let peaks = [arrival.incident, arrival.reflected].into_iter().flatten();
    let unsure_s = peaks.map(|peak| reference.error_s(0, &peak));
    let unsure_s = unsure_s.fold(reference.error_s(1, &wall), f64::max);
    Some((flight, unsure_s / shortest_s))
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

thread_local! {
    static BEGUN: Cell<Instant> = Cell::new(Instant::now());
}

fn too_long() -> bool {
    BEGUN.with(|begun| begun.get().elapsed() > PATIENCE)
}

/// Runs until it has taken too long.
fn patiently<T>(work: impl FnOnce() -> Option<T>) -> Option<T> {
    BEGUN.with(|begun| begun.set(Instant::now()));
    let ask = |stop: &Stop| {
        if too_long() {
            stop.ask();
        }
    };
    Stop::watched(ask).adopt();
    let result = work();
    (!too_long()).then_some(result).flatten()
}

/// Times of flight of single runs at accuracies.
fn flights<const N: usize>(plan: &Plan, accuracies: [f64; N]) -> Option<[Option<Flight>; N]> {
    let run =
        |accuracy| patiently(|| shoot(&plan.clone().for_flights().with_accuracy(accuracy)).ok());
    let shots: Option<Vec<Shot>> = accuracies.into_iter().map(run).collect();
    let flights: Vec<Option<Flight>> = shots?.iter().map(|shot| shot.flight).collect();
    flights.try_into().ok()
}

/// Of a run its error over what it states, and whether that was looked at by the independent integration.
fn excess(
    options: &Options,
    (at, drawn): (u64, &row::Row),
    plan: &Plan,
    shot: &Shot,
    near: &mut Vec<(f64, Option<Flight>)>,
) -> Option<(f64, bool)> {
    let stated = shot.accuracy_reached?;
    let over = |flight: Option<Flight>, own: f64| {
        let error = error(shot.flight, flight).unwrap_or(0.0);
        ((error - 3.0 * own - ROUNDING) / stated).max(0.0)
    };
    let accuracy = (NEAR.0 * shot.accuracy_asked).min(NEAR.1);
    let flight = match near.iter().find(|(of, _)| *of == accuracy) {
        Some((_, flight)) => *flight,
        None => {
            let [flight] = flights(plan, [accuracy])?;
            near.push((accuracy, flight));
            flight
        }
    };
    let mut most = over(flight, 0.0);
    if most > SUSPECT {
        let [exact, looser] = flights(plan, EXACT)?;
        let own = error(looser, exact).unwrap_or(0.0);
        if own > 0.3 * stated {
            return None;
        }
        most = over(exact, own);
    }
    if most > SUSPECT || at % options.every == 0 {
        let (flight, own) = independent(drawn)?;
        if own > 0.3 * stated {
            return None;
        }
        return Some((over(flight, own), true));
    }
    Some((most, false))
}

fn row(options: &Options, at: u64) -> Option<BTreeMap<String, Tally>> {
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
    let turn = TURNS[(at / 2 % 5) as usize];
    let other = match at % 2 {
        0 => (false, turn),
        _ => (true, turn.max(1e-7)),
    };
    let mut tallies = BTreeMap::<String, Tally>::new();
    let mut near = Vec::new();
    let asks = [(false, 1e-6), (true, 1e-6), other];
    for (sweep, accuracy) in asks.into_iter().take(if options.shots { 1 } else { 3 }) {
        let ask = Ask { sweep, accuracy };
        let tally = tallies.entry(ask.name()).or_default();
        let Some(shot) = patiently(|| ask.run(&plan)) else {
            tally.silent += 1;
            break;
        };
        tally.runs += 1;
        tally.reported += u64::from(shot.accuracy_reached > Some(accuracy));
        let Some((over, independent)) = excess(options, (at, &drawn), &plan, &shot, &mut near)
        else {
            tally.unresolved += 1;
            continue;
        };
        tally.independent += u64::from(independent);
        tally.worst = tally.worst.max(over);
        tally.suspect += u64::from(over > SUSPECT);
        tally.above += u64::from(over > 1.0);
        tally.far_above += u64::from(over > 3.0);
        if over > SUSPECT {
            let (peaks, laws) = (peaks(&shot), &drawn.sections);
            println!(
                "row {at} of seed {}, {}: {over:.2} times {:.2e}; tolerance {:?}, {}; {laws:?}; {peaks}",
                options.seed,
                ask.name(),
                shot.accuracy_reached.unwrap_or(0.0),
                shot.tolerance,
                shot.solver,
            );
        }
    }
    Some(tallies)
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parsed(std::env::args().skip(1))?;
    let (next, begun) = (AtomicU64::new(options.from), Instant::now());
    let whole = Mutex::new(BTreeMap::<String, Tally>::new());
    let work = || {
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            if at >= options.from + options.count || begun.elapsed().as_secs() >= options.seconds {
                break;
            }
            let Some(of_row) = row(&options, at) else { continue };
            let Ok(mut whole) = whole.lock() else { break };
            for (name, tally) in of_row {
                let sum = whole.entry(name).or_default();
                sum.runs += tally.runs;
                sum.silent += tally.silent;
                sum.unresolved += tally.unresolved;
                sum.reported += tally.reported;
                sum.suspect += tally.suspect;
                sum.above += tally.above;
                sum.far_above += tally.far_above;
                sum.independent += tally.independent;
                sum.worst = sum.worst.max(tally.worst);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..options.jobs {
            scope.spawn(work);
        }
    });
    let rows = next.into_inner() - options.from - options.jobs;
    println!("{rows} rows from {} of seed {}", options.from, options.seed);
    println!(
        "way\truns\tsilent\tunresolved\tindependent\tnot reached\tabove 0.5\tabove 1\tabove 3\tworst"
    );
    for (name, tally) in whole.into_inner()? {
        let Tally {
            runs,
            silent,
            unresolved,
            independent,
            reported,
            suspect,
            above,
            far_above,
            worst,
        } = tally;
        println!(
            "{name}\t{runs}\t{silent}\t{unresolved}\t{independent}\t{reported}\t{suspect}\t{above}\t{far_above}\t{worst:.2}"
        );
    }
    Ok(())
}
