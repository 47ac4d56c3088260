//! Which oil the gauge says it is, over many trials of the virtual rig: a table of
//! `docs/explanation/inference.md`.
//!
//! ```sh
//! cargo run --release -p hertzchain --example oils -- 10  # trials
//! ```
//!
//! A trial is a campaign with the paper's oils and a fourth that is in no table (the motor
//! oil with its Young modulus 5 % up): dry and wet chains of 40 beads, laid compact before
//! every shot, 8 speeds, 20 shots a speed. Every shot is integrated at its own speed, goes
//! through amplifier, noise and converter into a recording, and is read and picked from there
//! as any other; the gauge has the means. Each trial has seeds of its own.

#[path = "../whole_loop/evaluated.rs"]
#[allow(dead_code, reason = "another example uses more")]
mod evaluated;

use hertzchain_experiment::Experiment;
use hertzchain_infer::gauge::{Chains, Gauge, known_oils};
use hertzchain_infer::{Data, Observable, Selection};
use hertzchain_measure::{Grouping, Options, measure, speeds_csv};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};

const PAPER: &str = include_str!("../../../../experiments/paper.toml");

/// One shot a speed on a chain just laid without gaps, pushed by nothing, so that its loads
/// are known; recorded until the wave is back.
const COMPACT: [(&str, &str); 8] = [
    ("force = \"0.24 N\"", "force = \"0 N\""),
    ("stiffness = \"100 N/m\"", "stiffness = \"0 N/m\""),
    ("incline = \"0.5 deg\"", "incline = \"0 deg\""),
    ("shots = 20", "shots = 1"),
    ("taps = 40", "taps = 0"),
    ("gap_scatter = \"5 um\"", "gap_scatter = \"0 um\""),
    ("record = \"0.1 s\"", "record = \"30 ms\""),
    ("speed_count = 60", "speed_count = 8"),
];

/// The oil that no table has, as a case after the others.
const UNKNOWN: &str = r#"
[materials.unknown-oil]
young_modulus = "202.65 GPa"
poisson_ratio = { prefactor = 0.360, exponent = -0.165 }
shear_viscosity = { prefactor = "66177.1 Pa s", exponent = -0.206 }
"#;

const LIQUIDS: [&str; 4] = ["motor", "gear", "pump", "unknown"];

/// Shots a speed, each of a campaign of its own.
const SHOTS: u64 = 20;

/// What is used, and what the gauge said how often of each liquid.
type Said = [BTreeMap<String, u64>; LIQUIDS.len()];

fn main() -> Result<(), Box<dyn Error>> {
    let trials: u64 = std::env::args().nth(1).map_or(Ok(10), |text| text.parse())?;
    let text = rig();
    let mut said: [Said; 2] = Default::default();
    let own = std::env::temp_dir().join(format!("hertzchain-oils-{}", std::process::id()));
    for trial in 0..trials {
        let table = measured(&text, trial, &own)?;
        std::fs::remove_dir_all(&own)?;
        run_gauge(&text, &table, &mut said)?;
        eprintln!("trial {} of {trials}", trial + 1);
    }
    for (said, used) in said.iter().zip(["both times", "incident times alone"]) {
        println!("\n{used}, {trials} trials");
        for (liquid, said) in LIQUIDS.iter().zip(said) {
            println!("| {liquid} | {said:?} |");
        }
    }
    Ok(())
}

/// The paper's campaign, compact, with one liquid more.
fn rig() -> String {
    let text = COMPACT.iter().fold(PAPER.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "the preset has no {from}");
        text.replace(from, to)
    });
    let begin = "[[campaign.cases]]\n";
    let last = text.rsplit(begin).next().unwrap_or_default();
    let unknown = last.replace("motor", "unknown");
    format!("{text}\n{begin}{unknown}{UNKNOWN}")
}

/// What `measure` makes of a trial's recordings: its table of speeds.
fn measured(text: &str, trial: u64, under: &Path) -> Result<String, Box<dyn Error>> {
    let seeds = trial * SHOTS + 1..=(trial + 1) * SHOTS;
    let mut files: Vec<PathBuf> = Vec::new();
    for folder in evaluated::run(text, seeds, under)? {
        for entry in std::fs::read_dir(folder)? {
            files.push(entry?.path());
        }
    }
    files.retain(|file| file.extension().is_some_and(|ending| ending == "h5"));
    files.sort();
    let mut measured = measure(&files, &Options::default(), &());
    Ok(speeds_csv(&measured.curves(&Grouping::default())))
}

/// Holds every liquid against the oils, by both times and by incident times alone.
fn run_gauge(text: &str, table: &str, said: &mut [Said; 2]) -> Result<(), Box<dyn Error>> {
    let rig = Experiment::from_text("campaign.toml", text)?;
    let chain = |case: &str| rig.case(case).ok_or("the rig has no such case");
    let (dry, wet) = (chain("dry")??, chain("pump")??);
    let free = ["aisi316.eta".to_owned(), "dry.B".to_owned()];
    let both = [Observable::Incident, Observable::Reflected];
    for (said, used) in said.iter_mut().zip([&both[..], &both[..1]]) {
        let data = |case: &str| {
            let selection = Selection {
                case: Some(case.to_owned()),
                observables: used.to_vec(),
                ..Selection::default()
            };
            Data::parse("speeds.csv", table, &selection)
        };
        for (liquid, said) in LIQUIDS.iter().zip(said) {
            let chains = Chains {
                film: &[],
                dry: &dry,
                wet: &wet,
                free: &free,
                own: &[],
                systematic: &[],
                accuracy: 1e-5,
            };
            let gauge = Gauge::new(&chains, data("dry")?, data(liquid)?)?;
            let verdict = gauge.verdict(&known_oils()?)?;
            let names: Vec<&str> = verdict.allowed().map(|found| found.oil.as_str()).collect();
            let names = match names.is_empty() {
                true => "none of these".to_owned(),
                false => names.join(" or "),
            };
            *said.entry(names).or_default() += 1;
        }
    }
    Ok(())
}
