//! What lies under a return in a channel that sums both sensors, and that two channels are free of
//! it: the same shots of the paper's rig, recorded in one channel and in two.
//!
//! `cargo run --release -p hertzchain --example two_channels` prints, case by case, how far times of
//! flight are off in the median; what docs/explanation/picking.md shows.
#![allow(clippy::print_stdout, reason = "an example talks")]

#[path = "whole_loop/evaluated.rs"]
#[allow(dead_code, reason = "the whole loop uses more")]
mod evaluated;

use evaluated::{Evaluated, TIMES, evaluate, run};
use hertzchain_measure::Options;
use hertzchain_measure::signal::median;
use std::error::Error;
use std::path::Path;

const PAPER: &str = include_str!("../../../experiments/paper.toml");

/// Fast shots, in which the wall still feels the wave when it is back at the sensor bead.
const CHANGES: [(&str, &str); 4] = [
    ("slowest = \"0.075 m/s\"", "slowest = \"0.5 m/s\""),
    ("speed_count = 60", "speed_count = 4"),
    ("taps = 40", "taps = 5"),
    ("record = \"0.1 s\"", "record = \"30 ms\""),
];
const ONE: &str = "range = \"10 V\"";
const TWO: &str = "range = \"10 V\"\nchannels = \"separate\"";

fn main() -> Result<(), Box<dyn Error>> {
    let mut text = PAPER.to_owned();
    for (from, to) in CHANGES.iter().chain(&[(ONE, ONE)]) {
        assert!(text.contains(from), "the preset has no {from}");
        text = text.replace(from, to);
    }
    let under = std::env::temp_dir().join(format!("hertzchain-channels-{}", std::process::id()));
    let reported = print(&text, &under);
    std::fs::remove_dir_all(under)?;
    reported
}

fn print(text: &str, under: &Path) -> Result<(), Box<dyn Error>> {
    let one = shots(text, &under.join("one"))?;
    let two = shots(&text.replace(ONE, TWO), &under.join("two"))?;
    println!("| time | case | shots | one channel, ns | two channels, ns |\n|---|---|---|---|---|");
    for (time, name) in TIMES.iter().enumerate() {
        for case in ["dry", "pump", "gear", "motor"] {
            let off = |shots: &[Evaluated]| off_ns(shots, case, time);
            let (Some((count, one)), Some((_, two))) = (off(&one), off(&two)) else {
                continue;
            };
            println!("| {name} | {case} | {count} | {one} | {two} |");
        }
    }
    Ok(())
}

fn shots(text: &str, under: &Path) -> Result<Vec<Evaluated>, Box<dyn Error>> {
    let mut shots = Vec::new();
    for folder in run(text, 1..=1, under)? {
        shots.extend(evaluate(&folder, &Options::default())?);
    }
    Ok(shots)
}

/// How many shots, and the median of measured less true times, with its error.
fn off_ns(shots: &[Evaluated], case: &str, time: usize) -> Option<(usize, String)> {
    let own = shots.iter().filter(|shot| shot.case == case);
    let off: Vec<f64> = own.filter_map(|shot| Some(1e9 * shot.error(time)?.value)).collect();
    let middle = median(&off)?;
    let apart: Vec<f64> = off.iter().map(|one| (one - middle).abs()).collect();
    // Of a median: √(π/2) of that of a mean, the spread robust.
    let error = 1.25 * 1.4826 * median(&apart)? / (off.len() as f64).sqrt();
    Some((off.len(), format!("{middle:+.0} ± {error:.0}")))
}
