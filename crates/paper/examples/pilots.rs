//! Shots with calibrated error control: how right they are, and how much faster
//! than with error control per shot. The table of `docs/explanation/numerics.md`.
//!
//! ```sh
//! cargo run --release -p hertzchain-study --example pilots          # of all presets
//! cargo run --release -p hertzchain-study --example pilots -- dry
//! ```
//!
//! A thousand speeds of each of the paper's chains, evenly spread in their
//! logarithm, on one thread. Errors are against shots with error control per shot at a
//! twentieth of the accuracy.

use hertzchain_experiment::preset;
use hertzchain_paper::reproduce::CASES;
use hertzchain_sim::{Calibration, Control, InstructionSet, Plan, Shot, run_plans};
use std::error::Error;
use std::time::{Duration, Instant};

const SPEEDS: usize = 1000;

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    println!(
        "| preset | asked | calibrated setting | calibration error | largest error, of asked | beyond asked | µs a shot | times as fast |"
    );
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let wanted = |name: &&&str| asked.is_empty() || asked.iter().any(|asked| asked == **name);
    for name in CASES.iter().filter(wanted) {
        for accuracy in [1e-3, 1e-4, 1e-5, 1e-6] {
            println!("{}", pool.install(|| row(name, accuracy))?);
        }
    }
    Ok(())
}

fn row(name: &str, accuracy: f64) -> Result<String, Box<dyn Error + Send + Sync>> {
    let set = InstructionSet::default();
    let (plans, exact) = (plans(name, accuracy)?, plans(name, accuracy / 20.0)?);
    let sample: Vec<Plan> = Calibration::places(plans.len())
        .map(|place| plans[place].clone())
        .collect();
    let (tuned, choosing) = timed(|| Calibration::new(&sample, set));
    let Some(tuned) = tuned else {
        return Ok(format!("| {name} | {accuracy:.0e} | none | | | | | |"));
    };
    let run = |plans: &[Plan], control| timed(|| run_plans(plans, control, set, &|| {}));
    let (shots, alone) = run(&plans, Control::Calibrated(&tuned));
    let (_, compared) = run(&plans, Control::PerShot { checked: false });
    let (exact, _) = run(&exact, Control::PerShot { checked: true });
    let errors = shots.iter().zip(&exact).filter_map(|(shot, exact)| {
        let flight = |shot: &Shot| shot.flight;
        Some(flight(shot.as_ref().ok()?)?.change(&flight(exact.as_ref().ok()?)?))
    });
    let errors: Vec<f64> = errors.map(|error| error / accuracy).collect();
    let beyond = errors.iter().filter(|&&error| error > 1.0).count();
    let worst = errors.iter().copied().fold(0.0, f64::max);
    let each_us = |time: Duration| 1e6 * time.as_secs_f64() / SPEEDS as f64;
    Ok(format!(
        "| {name} | {accuracy:.0e} | {tuned} | {:.1e} | {worst:.2} | {beyond} of {} | {:.1} + {:.1} | {:.1} |",
        tuned.reached,
        errors.len(),
        each_us(alone),
        each_us(choosing),
        compared.as_secs_f64() / alone.as_secs_f64()
    ))
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let begun = Instant::now();
    (work(), begun.elapsed())
}

fn plans(name: &str, accuracy: f64) -> Result<Vec<Plan>, Box<dyn Error + Send + Sync>> {
    let experiment = preset(name)?;
    let speed = |i: usize| 0.075 * (1.23_f64 / 0.075).powf(i as f64 / (SPEEDS - 1) as f64);
    (0..SPEEDS)
        .map(|i| {
            let (plan, _) = Plan::from_experiment(&experiment, Some(speed(i)))?;
            Ok(plan.for_flights().with_accuracy(accuracy))
        })
        .collect()
}
