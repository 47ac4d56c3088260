//! Bias and spread of times of flight by every picking method, and what their stated errors cover,
//! as tables in Markdown.
//!
//! `cargo run --release -p hertzchain-measure --example pick_table [SHOTS]`
//! prints what stands in docs/explanation/picking.md.

#[path = "../tests/signal/common/mod.rs"]
mod common;
#[path = "../tests/signal/common/dry.rs"]
mod dry;
#[path = "../tests/signal/common/source.rs"]
mod source;

use hertzchain_measure::signal;
use hertzchain_measure::signal::{
    Channels, Estimate, Flight, QualityFlag, SignalOptions, coverage, measure, median,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use source::{Source, bells, dry_shot, methods};

/// Ratios of the incident pulse's height to the noise, in dB.
const RATIOS_DB: [u32; 5] = [20, 30, 40, 50, 60];
/// The same, of the tables of stated errors.
const COVERED_DB: [u32; 5] = [14, 20, 26, 40, 60];
const INTERVALS_S: [f64; 2] = [1e-6, 2e-6];

/// Incident and reflected times of flight less the true ones by one method, in ns, with their
/// stated errors, and whether the shot counts in means.
#[derive(Default)]
struct Errors([Vec<(Estimate, bool)>; 2]);

impl Errors {
    fn take(&mut self, flight: &Flight, times_s: [f64; 3], counts: bool) {
        let [passing, wall, returning] = times_s;
        let off = |found: Estimate, true_s: f64| Estimate {
            value: (found.value - true_s) * 1e9,
            sigma: found.sigma * 1e9,
        };
        let incident = off(flight.incident_s, wall - passing);
        let reflected = flight.reflected_s.map(|t| off(t, returning - wall));
        self.0[0].push((incident, counts));
        self.0[1].extend(reflected.map(|t| (t, counts)));
    }
}

/// All methods on the same noisy shots.
fn run(source: &Source, interval_s: f64, ratio_db: u32, shots: u64) -> [Errors; 4] {
    let noise = 10_f64.powf(-f64::from(ratio_db) / 20.0);
    let mut errors: [Errors; 4] = Default::default();
    for shot in 0..shots {
        let mut rng = ChaCha8Rng::seed_from_u64(2026);
        rng.set_stream(shot);
        let samples = source.recorded(interval_s, noise, &mut rng);
        let channels = Channels::Summed(&samples);
        for ((_, method), errors) in methods().iter().zip(&mut errors) {
            let options = SignalOptions { method: method.clone(), ..SignalOptions::default() };
            let Ok(shot) = measure(channels, interval_s, &options) else {
                continue;
            };
            let counts = !shot.found.flags.iter().any(QualityFlag::is_grave);
            if let Ok(flight) = shot.flight {
                errors.take(&flight, source.times_s, counts);
            }
        }
    }
    errors
}

/// Per cent of the shots that count within 1.96 stated errors of a centre.
fn covered(errors: &[(Estimate, bool)], centre: impl Fn(&[f64]) -> f64) -> f64 {
    let counted = errors.iter().filter(|(_, counts)| *counts);
    let counted: Vec<Estimate> = counted.map(|(error, _)| *error).collect();
    let values: Vec<f64> = counted.iter().map(|error| error.value).collect();
    let centre = centre(&values);
    let pulls: Vec<f64> =
        counted.iter().map(|error| (error.value - centre) / error.sigma).collect();
    coverage(&pulls, 1.96).map_or(f64::NAN, |found| 100.0 * found.share)
}

/// What stated errors cover: of the first method of true times, of others of their own medians,
/// as their bias is in no stated error.
fn coverages(source: &Source, shots: u64) {
    println!("\n**{}**\n", source.name);
    let names = methods().map(|(name, _)| name).join(" | ");
    println!("| rate | SNR | {names} |\n|---|---|---|---|---|---|");
    for interval_s in INTERVALS_S {
        for ratio_db in COVERED_DB {
            let errors = run(source, interval_s, ratio_db, shots);
            let cells = errors.iter().enumerate().map(|(method, errors)| {
                let centre = |values: &[f64]| match method {
                    0 => 0.0,
                    _ => median(values).unwrap_or(0.0),
                };
                let [incident, reflected] = errors.0.each_ref().map(|e| covered(e, centre));
                format!("{incident:.1}, {reflected:.1}")
            });
            let cells: Vec<String> = cells.collect();
            let rate = (1e-3 / interval_s).round();
            println!("| {rate} kS/s | {ratio_db} dB | {} |", cells.join(" | "));
        }
    }
}

/// Mean and standard deviation in ns, and the share of shots that gave none.
fn cell(errors: &[(Estimate, bool)], shots: u64) -> String {
    let n = errors.len() as f64;
    let values = || errors.iter().map(|(error, _)| error.value);
    let mean = values().sum::<f64>() / n;
    let spread = values().map(|e| (e - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let lost = 100.0 * (1.0 - n / shots as f64);
    let lost = match lost < 0.05 {
        true => String::new(),
        false => format!(" ({lost:.1} % lost)"),
    };
    format!("{mean:+.0} ± {:.0}{lost}", spread.sqrt())
}

/// Cramér–Rao bound of incident and reflected time in ns: noise/√(Σ s'²) of each pulse.
fn bounds(source: &Source, interval_s: f64, noise: f64) -> [f64; 2] {
    let around = |at: f64| {
        let reach = (70e-6 / interval_s) as i32;
        let pulse: Vec<f64> =
            (-reach..=reach).map(|i| (source.signal)(at + f64::from(i) * interval_s)).collect();
        let slopes = pulse.windows(3).map(|w| 0.5 * (w[2] - w[0]) / interval_s);
        1e9 * noise / slopes.map(|s| s * s).sum::<f64>().sqrt()
    };
    let [passing, wall, returning] = source.times_s.map(around);
    [passing.hypot(wall), wall.hypot(returning)]
}

fn table(source: &Source, shots: u64) {
    println!("\n**{}**\n", source.name);
    let names = methods().map(|(name, _)| name).join(" | ");
    println!("| | rate | SNR | {names} | bound |");
    println!("|---|---|---|---|---|---|---|---|");
    let mut rows = [const { Vec::new() }; 2];
    for interval_s in INTERVALS_S {
        for ratio_db in RATIOS_DB {
            let noise = 10_f64.powf(-f64::from(ratio_db) / 20.0);
            let errors = run(source, interval_s, ratio_db, shots);
            let bounds = bounds(source, interval_s, noise);
            let of = [
                errors.each_ref().map(|e| cell(&e.0[0], shots)),
                errors.each_ref().map(|e| cell(&e.0[1], shots)),
            ];
            let rate = (1e-3 / interval_s).round();
            for ((rows, cells), bound) in rows.iter_mut().zip(of).zip(bounds) {
                let cells = cells.join(" | ");
                rows.push(format!("{rate} kS/s | {ratio_db} dB | {cells} | {bound:.0} |"));
            }
        }
    }
    for (name, rows) in ["incident", "reflected"].iter().zip(rows) {
        rows.iter().for_each(|row| println!("| {name} | {row}"));
    }
}

fn main() {
    let shots = std::env::args().nth(1).and_then(|text| text.parse().ok());
    let shots = shots.unwrap_or(2000);
    println!(
        "Bias ± spread in ns over {shots} shots each, and the Cramér–Rao bound of the spread."
    );
    for source in [bells(), dry_shot()] {
        table(&source, shots);
    }
    println!(
        "\nShare of shots, in %, within 1.96 stated errors, incident and reflected; 95.0 would be right."
    );
    for source in [bells(), dry_shot()] {
        coverages(&source, shots);
    }
}
