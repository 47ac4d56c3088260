//! Bias and spread of times of flight by every picking method, as tables in Markdown.
//!
//! `cargo run --release -p hertzchain-signal --example pick_table [SHOTS]`
//! prints what stands in docs/measuring.md.

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/common/dry.rs"]
mod dry;

use common::{Scene, normal};
use dry::Dry;
use hertzchain_signal::{
    Channels, Finding, Flight, Method, Shape, Template, cramer_rao_of_samples_s, pick, pulses,
};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Ratios of the passing pulse's height to the noise, in dB.
const RATIOS_DB: [u32; 5] = [20, 30, 40, 50, 60];
const INTERVALS_S: [f64; 2] = [1e-6, 2e-6];
/// From the record's start to the passing pulse's maximum.
const LEAD_S: f64 = 0.5e-3;
const DURATION_S: f64 = 2.6e-3;

/// A shot without noise, and when its maxima are after the passing one.
struct Source {
    name: &'static str,
    /// Signal at a time after the passing maximum, that maximum being 1 high.
    signal: Box<dyn Fn(f64) -> f64>,
    times_s: [f64; 3],
}

fn bells() -> Source {
    let scene = Scene::default();
    let pulses = [
        (0.0, 1.0, 46e-6),
        (760e-6, 1.6, 40e-6),
        (1560e-6, 0.47, 52e-6),
    ];
    Source {
        name: "Bells, cos⁶, unlike in width (46, 40 and 52 µs)",
        signal: Box::new(move |t| {
            let one = |(at, height, width): &(f64, f64, f64)| {
                height * scene.shape.value((t - at) / width)
            };
            pulses.iter().map(one).sum()
        }),
        times_s: pulses.map(|pulse| pulse.0),
    }
}

fn dry_shot() -> Source {
    let dry = Dry::load();
    let first = Dry::MAXIMA_S[0];
    Source {
        name: "A computed dry shot at 0.5 m/s (46, 40 and 52 µs, skewed)",
        signal: Box::new(move |t| dry.summed(t + first)),
        times_s: Dry::MAXIMA_S.map(|t| t - first),
    }
}

/// As the command line has them.
fn methods() -> [(&'static str, Method); 4] {
    [
        ("local", Method::default()),
        ("onset", Method::Onset { fraction: 0.5 }),
        ("correlation", Method::CrossCorrelation(Template::Passing)),
        (
            "shape",
            Method::MatchedShape {
                shape: Shape::cos_power(6.0),
                width: 2.0,
            },
        ),
    ]
}

/// Errors of incident and reflected times of flight in ns by one method.
#[derive(Default)]
struct Errors {
    incident: Vec<f64>,
    reflected: Vec<f64>,
}

impl Errors {
    fn take(&mut self, flight: &Flight, times_s: [f64; 3]) {
        let off = |found: f64, from: f64, to: f64| (found - (to - from)) * 1e9;
        let [passing, wall, returning] = times_s;
        self.incident
            .push(off(flight.incident_s.value, passing, wall));
        if let Some(reflected) = flight.reflected_s {
            self.reflected.push(off(reflected.value, wall, returning));
        }
    }
}

/// All methods on the same noisy shots.
fn run(source: &Source, interval_s: f64, noise: f64, shots: u64) -> [Errors; 4] {
    let mut errors: [Errors; 4] = Default::default();
    for shot in 0..shots {
        let mut rng = ChaCha8Rng::seed_from_u64(2026);
        rng.set_stream(shot);
        let part = (rng.next_u32() as f64) / (u32::MAX as f64);
        let lead_s = LEAD_S + part * interval_s;
        let sample = |i: usize| {
            let clean = (source.signal)(i as f64 * interval_s - lead_s);
            clean + noise * normal(&mut rng)
        };
        let count = (DURATION_S / interval_s) as usize;
        let samples: Vec<f64> = (0..count).map(sample).collect();
        let channels = Channels::Summed(&samples);
        let Ok(found) = pulses(channels, &Finding::default()) else {
            continue;
        };
        for ((_, method), errors) in methods().iter().zip(&mut errors) {
            if let Ok(picks) = pick(channels, interval_s, &found, method, [None; 2]) {
                errors.take(&picks.flight(), source.times_s);
            }
        }
    }
    errors
}

/// Mean and standard deviation in ns, and the share of shots that gave none.
fn cell(errors: &[f64], shots: u64) -> String {
    let n = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / n;
    let spread = errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let lost = 100.0 * (1.0 - n / shots as f64);
    let lost = match lost < 0.05 {
        true => String::new(),
        false => format!(" ({lost:.1} % lost)"),
    };
    format!("{mean:+.0} ± {:.0}{lost}", spread.sqrt())
}

/// Bound of incident and reflected time in ns.
fn bounds(source: &Source, interval_s: f64, noise: f64) -> [f64; 2] {
    let around = |at: f64| {
        let reach = (70e-6 / interval_s) as i32;
        let pulse: Vec<f64> = (-reach..=reach)
            .map(|i| (source.signal)(at + f64::from(i) * interval_s))
            .collect();
        cramer_rao_of_samples_s(&pulse, interval_s, noise) * 1e9
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
            let errors = run(source, interval_s, noise, shots);
            let bounds = bounds(source, interval_s, noise);
            let of = [
                errors.each_ref().map(|e| cell(&e.incident, shots)),
                errors.each_ref().map(|e| cell(&e.reflected, shots)),
            ];
            let rate = (1e-3 / interval_s).round();
            for ((rows, cells), bound) in rows.iter_mut().zip(of).zip(bounds) {
                let cells = cells.join(" | ");
                rows.push(format!(
                    "{rate} kS/s | {ratio_db} dB | {cells} | {bound:.0} |"
                ));
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
}
