//! The whole loop: campaign, recordings, times of flight; against the true values
//! of the same shots, and against the model's own curves. What docs/explanation/picking.md shows.
//!
//! `cargo run --release -p hertzchain --example whole_loop` fires on the chain of the
//! paper, laid compact and without a push before every shot; `… -- FOLDER` evaluates the recordings that
//! `hertzchain campaign --out FOLDER` has made.

mod evaluated;

use evaluated::{Evaluated, Speed, TIMES, agreement, by_speed, evaluate, run};
use hertzchain_measure::Options;
use hertzchain_measure::signal::{Coverage, Method, Shape, coverage, median};
use std::error::Error;
use std::path::{Path, PathBuf};

const PAPER: &str = include_str!("../../../../experiments/paper.toml");

/// One shot a speed on a chain just laid without gaps, recorded until the wave is back. Nothing
/// pushes it: friction would hold other loads on its contacts than equilibrium has.
const COMPACT: [(&str, &str); 7] = [
    ("force = \"0.24 N\"", "force = \"0 N\""),
    ("stiffness = \"100 N/m\"", "stiffness = \"0 N/m\""),
    ("incline = \"0.5 deg\"", "incline = \"0 deg\""),
    ("shots = 20", "shots = 1"),
    ("taps = 40", "taps = 0"),
    ("gap_scatter = \"5 um\"", "gap_scatter = \"0 um\""),
    ("record = \"0.1 s\"", "record = \"30 ms\""),
];
/// Seeds, that is shots a speed.
const SEEDS: u64 = 20;
/// Ends of the ranges of speed that coverage is reported for, in m/s.
const RANGES_M_S: [(f64, f64); 5] = [(0.0, 0.09), (0.0, 0.2), (0.2, 0.5), (0.5, 2.5), (0.0, 2.5)];

fn main() -> Result<(), Box<dyn Error>> {
    let own = std::env::temp_dir().join(format!("hertzchain-loop-{}", std::process::id()));
    let folders = match std::env::args().nth(1) {
        Some(folder) => vec![PathBuf::from(folder)],
        None => compact(&own)?,
    };
    let mut shots = Vec::new();
    for folder in &folders {
        shots.extend(evaluate(folder, &Options::default())?);
    }
    let mut cases: Vec<&str> = shots.iter().map(|shot| shot.case.as_str()).collect();
    cases.dedup();
    cases.sort_unstable();
    cases.dedup();
    against_truth(&shots, &cases);
    against_model(&shots, &cases);
    if own.exists() {
        std::fs::remove_dir_all(own)?;
        return Ok(());
    }
    by_other_methods(&folders, &cases)
}

fn compact(under: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut text = PAPER.to_owned();
    for (from, to) in COMPACT {
        assert!(text.contains(from), "the preset has no {from}");
        text = text.replace(from, to);
    }
    run(&text, 1..=SEEDS, under)
}

/// Bias, spread and coverage of measured times against those of the same shots.
fn against_truth(shots: &[Evaluated], cases: &[&str]) {
    println!("Measured less true times of the same shots\n");
    println!(
        "| time | case | m/s | shots | bias ± error, ns | spread, ns | stated, ns | within 1 σ, % | within 1.96 σ, % |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for (time, name) in TIMES.iter().enumerate() {
        for case in cases {
            for (from, to) in RANGES_M_S {
                let inside = |shot: &&Evaluated| {
                    shot.case == *case && (from..to).contains(&shot.programmed_m_s())
                };
                let own: Vec<&Evaluated> = shots.iter().filter(inside).collect();
                if let Some(row) = truth_row(&own, time) {
                    println!("| {name} | {case} | {from} to {to} | {row}");
                }
            }
        }
    }
}

fn truth_row(shots: &[&Evaluated], time: usize) -> Option<String> {
    let found: Vec<_> = shots.iter().filter_map(|shot| shot.error(time)).collect();
    let errors: Vec<f64> = found.iter().map(|e| 1e9 * e.value).collect();
    let stated: Vec<f64> = found.iter().map(|e| 1e9 * e.sigma).collect();
    let pulls: Vec<f64> = found.iter().map(|e| e.value / e.sigma).collect();
    let bias = median(&errors)?;
    let off: Vec<f64> = errors.iter().map(|e| (e - bias).abs()).collect();
    let spread = 1.4826 * median(&off)?;
    // Of a median: √(π/2) of that of a mean.
    let error = 1.25 * spread / (errors.len() as f64).sqrt();
    let covered = [1.0, 1.96].map(|factor| coverage(&pulls, factor).map(share));
    let [one, two] = covered.map(Option::unwrap_or_default);
    Some(format!(
        "{} | {bias:+.0} ± {error:.0} | {spread:.0} | {:.0} | {one} | {two} |",
        errors.len(),
        median(&stated)?
    ))
}

/// How far the other methods are off at the speed where that is most: medians of a speed's shots.
fn by_other_methods(folders: &[PathBuf], cases: &[&str]) -> Result<(), Box<dyn Error>> {
    println!("\nLargest median of a speed's errors by other methods, µs, incident and reflected\n");
    for (name, method) in others() {
        let mut options = Options::default();
        options.measuring.method = method;
        let mut shots = Vec::new();
        for folder in folders {
            shots.extend(evaluate(folder, &options)?);
        }
        for case in cases {
            let own: Vec<&Evaluated> = shots.iter().filter(|shot| shot.case == *case).collect();
            let [incident, reflected] = [0, 1].map(|time| 1e6 * largest_s(&own, time));
            println!("  {name}, {case}: {incident:+.1}, {reflected:+.1}");
        }
    }
    Ok(())
}

fn others() -> [(&'static str, Method); 3] {
    let shape = Shape::cos_power(6.0);
    [
        ("onset at 50 %", Method::Onset { fraction: 0.5 }),
        ("correlation", Method::CrossCorrelation),
        ("matched shape", Method::MatchedShape { shape, width: 2.0 }),
    ]
}

fn largest_s(shots: &[&Evaluated], time: usize) -> f64 {
    let mut speeds: Vec<f64> = shots.iter().map(|shot| shot.programmed_m_s()).collect();
    speeds.sort_by(f64::total_cmp);
    speeds.dedup();
    let of_speed = |speed: &f64| {
        let own = shots.iter().filter(|shot| shot.programmed_m_s() == *speed);
        let errors: Vec<f64> = own.filter_map(|shot| Some(shot.error(time)?.value)).collect();
        median(&errors)
    };
    let off = speeds.iter().filter_map(of_speed);
    off.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(f64::NAN)
}

/// A share with its binomial error, in percent.
fn share(of: Coverage) -> String {
    let error = (of.share * (1.0 - of.share) / of.count as f64).sqrt();
    format!("{:.1} ± {:.1}", 100.0 * of.share, 100.0 * error)
}

/// Means a speed against the model's curve, and against the shots' own times.
fn against_model(shots: &[Evaluated], cases: &[&str]) {
    let curves = [
        ("the model's of the chain in equilibrium", evaluated::COMPACT),
        ("the model's of the chain with each shot's own gaps and loads", evaluated::HELD),
        ("the recorded shots' own, taken to the measured speed", evaluated::OWN),
    ];
    for (what, curve) in curves {
        println!("\nMeasured times less {what}, means a speed\n");
        for (time, name) in TIMES.iter().enumerate() {
            for case in cases {
                let own: Vec<&Evaluated> = shots.iter().filter(|shot| shot.case == *case).collect();
                let rows = by_speed(&own, time, curve);
                let pulls: Vec<f64> = own.iter().map(|shot| shot.pull(time, curve)).collect();
                let within =
                    |factor| coverage(&pulls, factor).map_or(f64::NAN, |found| 100.0 * found.share);
                println!(
                    "{name}, {case}: {}; single shots within 1 and 1.96: {:.1} and {:.1} %",
                    reported(&rows),
                    within(1.0),
                    within(1.96)
                );
                println!("{}", rows.iter().map(speed_row).collect::<String>());
            }
        }
    }
}

/// Chi-square of all speeds, also without what the shots of a speed share, the largest departure in
/// stated errors, and how many speeds are within these.
fn reported(rows: &[Speed]) -> String {
    let evaluated = agreement(rows).map_or(String::new(), |c| {
        format!("chi-square {:.1} of {}, p = {:.2}", c.value, c.freedom, c.probability)
    });
    let pulls = rows.iter().map(|row| row.departure_s);
    let pulls: Vec<f64> = pulls.map(|of| (of.value / of.sigma).abs()).collect();
    let largest = pulls.iter().copied().fold(0.0, f64::max);
    let within = coverage(&pulls, 1.96).map_or(0, |found| found.inside);
    let alone = rows.iter().map(|row| {
        let own = row.departure_s.sigma.powi(2) - row.shared_s.powi(2);
        row.departure_s.value.powi(2) / own
    });
    format!(
        "{evaluated}, without what shots share {:.0}; at most {largest:.1} errors, {within} within 1.96",
        alone.sum::<f64>()
    )
}

fn speed_row(row: &Speed) -> String {
    let departure = row.departure_s;
    format!(
        "  {:.4} m/s, {:3} shots: {:+8.0} ± {:.0} ns stated, {:.0} of it shared, {:+.1} σ\n",
        row.speed_m_s,
        row.count,
        1e9 * departure.value,
        1e9 * departure.sigma,
        1e9 * row.shared_s,
        departure.value / departure.sigma
    )
}
