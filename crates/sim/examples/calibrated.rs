//! Batches with calibrated error control: how right they are, and how much sooner they are there
//! than with error control per shot. The table of `docs/notes/2026-11-23-batches.md`.
//!
//! ```sh
//! cargo run --release -p hertzchain-sim --example calibrated              # 2,000 speeds of each chain
//! cargo run --release -p hertzchain-sim --example calibrated -- 10000 dry pump
//! ```
//!
//! Speeds are evenly spread in their logarithm, on one thread. Errors are against the same batch
//! at a hundredth of the accuracy, 1e-8 at least, with error control per shot.

use hertzchain_experiment::preset;
use hertzchain_sim::{Batch, BatchOptions, BatchResult, Column, ErrorControl, Shard, parse_speeds};
use std::error::Error;
use std::time::Instant;

const PRESETS: [&str; 6] = ["hertz", "hertz-viscoelastic", "dry", "pump", "motor", "gear"];

type Failure = Box<dyn Error + Send + Sync>;

fn main() -> Result<(), Failure> {
    let mut asked: Vec<String> = std::env::args().skip(1).collect();
    let count = match asked.first().and_then(|first| first.parse().ok()) {
        Some(count) => {
            asked.remove(0);
            count
        }
        None => 2000,
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    println!(
        "| preset | asked | largest error, of asked | above asked | above estimate | µs a shot | times as fast | error control |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let wanted = |name: &&&str| asked.is_empty() || asked.iter().any(|asked| asked == **name);
    for name in PRESETS.iter().filter(wanted) {
        for accuracy in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7] {
            println!("{}", pool.install(|| row(name, count, accuracy))?);
        }
    }
    Ok(())
}

fn row(name: &str, count: usize, accuracy: f64) -> Result<String, Failure> {
    let (found, time_us) = run(name, count, accuracy, ErrorControl::Calibrated)?;
    let (_, per_shot_us) = run(name, count, accuracy, ErrorControl::PerShot)?;
    let (exact, _) = run(name, count, (accuracy / 100.0).max(1e-8), ErrorControl::PerShot)?;
    let (mut worst, mut above, mut understated) = (0.0_f64, 0, 0);
    for place in 0..count {
        let error = [Column::Incident, Column::Reflected].map(|of| {
            let times = [&found, &exact].map(|it| it.rows.column(of)[place]);
            (times[0] / times[1] - 1.0).abs()
        });
        let error = error[0].max(error[1]);
        worst = worst.max(error / accuracy);
        above += usize::from(error > accuracy);
        understated += usize::from(error > found.rows.column(Column::Accuracy)[place]);
    }
    Ok(format!(
        "| {name} | {accuracy:.0e} | {worst:.2} | {above} | {understated} | {time_us:.1} | {:.1} | {} |",
        per_shot_us / time_us,
        found.error_control
    ))
}

/// The batch and its time a shot.
fn run(
    name: &str,
    count: usize,
    accuracy: f64,
    error_control: ErrorControl,
) -> Result<(BatchResult, f64), Failure> {
    let experiment = preset(name)?;
    let options = BatchOptions { accuracy, error_control, ..BatchOptions::of(&experiment) };
    let speeds = parse_speeds(&format!("log:0.075:1.23:{count}"))?;
    let batch = Batch::new(&experiment, speeds, options)?;
    let begun = Instant::now();
    let result = batch.run(Shard::WHOLE, &|| {});
    Ok((result, 1e6 * begun.elapsed().as_secs_f64() / count as f64))
}
