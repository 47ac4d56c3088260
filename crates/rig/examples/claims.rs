//! The paper's claims about taps, gaps and rebounds, on the virtual rig, over
//! what the paper does not tell: `cargo run --release --example claims -p hertzchain-rig`.
//!
//! Prints Markdown: a row for each claim and rig, with what was computed and
//! whether it holds. All strikers of a series have the same speed here, so that
//! spreads are the chain's own; the first shots, which without taps meet the
//! chain as it was laid, do not count.
#![allow(clippy::print_stdout, reason = "an example talks")]

use hertzchain_experiment::Experiment;
use hertzchain_rig::{Fired, Plan, run};
use std::error::Error;

const PAPER: &str = include_str!("../../../experiments/paper.toml");

/// A slow and a strong shot, in m/s.
const SPEEDS: [f64; 2] = [0.2, 1.0];

/// Shots that are left out: they tell of the laying.
const FIRST: usize = 3;

/// What the paper leaves open: a name and what changes in the file.
const RIGS: &[(&str, &[(&str, &str)])] = &[
    ("as the preset", &[]),
    ("friction 0.01", &[("friction = 0.05", "friction = 0.01")]),
    ("friction 0.2", &[("friction = 0.05", "friction = 0.2")]),
    (
        "no push, level track",
        &[
            ("force = \"0.24 N\"", "force = \"0 N\""),
            ("stiffness = \"100 N/m\"", "stiffness = \"0 N/m\""),
            ("incline = \"0.5 deg\"", "incline = \"0 deg\""),
        ],
    ),
    (
        "no push, 0.5°",
        &[
            ("force = \"0.24 N\"", "force = \"0 N\""),
            ("stiffness = \"100 N/m\"", "stiffness = \"0 N/m\""),
        ],
    ),
    (
        "push 0.1 N, friction 0.2",
        &[
            ("force = \"0.24 N\"", "force = \"0.1 N\""),
            ("friction = 0.05", "friction = 0.2"),
        ],
    ),
    (
        "push 0.02 N",
        &[("force = \"0.24 N\"", "force = \"0.02 N\"")],
    ),
    (
        "gaps 100 µm as laid",
        &[("gap_scatter = \"5 um\"", "gap_scatter = \"100 um\"")],
    ),
    (
        "radii ± 0.2 %",
        &[("radius_spread = 0", "radius_spread = 0.002")],
    ),
];

/// One series of equal shots.
struct Measured {
    speed_m_s: f64,
    shots: Vec<Fired>,
}

impl Measured {
    /// Mean and standard deviation of what shots have.
    fn spread(&self, of: impl Fn(&Fired) -> f64) -> (f64, f64) {
        let values: Vec<f64> = self
            .shots
            .iter()
            .map(of)
            .filter(|v| v.is_finite())
            .collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let square: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
        (mean, (square / (count - 1.0)).sqrt())
    }

    fn incident_s(&self) -> (f64, f64) {
        self.spread(|fired| fired.shot.incident_s)
    }

    fn reflected_s(&self) -> (f64, f64) {
        self.spread(|fired| fired.shot.reflected_s)
    }

    /// Rebound over the speed of the shot.
    fn rebound(&self) -> (f64, f64) {
        self.spread(|fired| fired.shot.rebound_m_s / self.speed_m_s)
    }

    /// Mean sum and largest of all gaps after shots, in m.
    fn gaps_after_m(&self) -> (f64, f64) {
        let all = self.shots.iter().flat_map(|fired| &fired.shot.gaps_after_m);
        let largest_m = all.clone().copied().fold(0.0, f64::max);
        (all.sum::<f64>() / self.shots.len() as f64, largest_m)
    }

    fn gaps_before_m(&self) -> f64 {
        self.spread(|fired| fired.shot.gaps_before_m.iter().sum()).0
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("| rig | claim | computed | verdict |\n|---|---|---|---|");
    for (rig, changes) in RIGS {
        let [tapped_slow, tapped] = measured(changes, 40)?;
        let [_, loose] = measured(changes, 0)?;
        for (claim, computed, holds) in claims(&tapped_slow, &tapped, &loose) {
            let verdict = if holds { "holds" } else { "fails" };
            println!("| {rig} | {claim} | {computed} | {verdict} |");
        }
    }
    Ok(())
}

/// Both speeds with this many taps.
fn measured(changes: &[(&str, &str)], taps: usize) -> Result<[Measured; 2], Box<dyn Error>> {
    let mut text = PAPER.replace("spread = \"3 mm/s\"", "spread = \"0 m/s\"");
    let taps = format!("taps = {taps}");
    let fixed = [
        ("taps = 40", taps.as_str()),
        ("slowest = \"0.075 m/s\"\n", ""),
        ("fastest = \"1.23 m/s\"\n", ""),
        ("speed_count = 60", "speeds = [\"0.2 m/s\", \"1 m/s\"]"),
        ("shots = 20", "shots = 15"),
        ("record = \"0.1 s\"", "record = \"10 ms\""),
    ];
    for (from, to) in fixed.iter().chain(changes) {
        text = text.replace(from, to);
    }
    let plan = Plan::new(&Experiment::from_text("paper.toml", &text)?, None)?;
    let series = |at: usize| -> Result<Measured, Box<dyn Error>> {
        let mut shots = Vec::new();
        run(&plan, &plan.series[at], &mut |fired| {
            shots.extend((fired.number as usize >= FIRST).then_some(fired));
            Ok(())
        })?;
        let speed_m_s = SPEEDS[at];
        Ok(Measured { speed_m_s, shots })
    };
    Ok([series(0)?, series(1)?])
}

/// Claims with what was computed and whether it bears them out.
fn claims(
    slow: &Measured,
    tapped: &Measured,
    loose: &Measured,
) -> Vec<(&'static str, String, bool)> {
    let (tof, tof_loose) = (tapped.incident_s(), loose.incident_s());
    let back = tapped.reflected_s();
    let (rebound, rebound_loose) = (tapped.rebound(), loose.rebound());
    let (sum_m, largest_m) = loose.gaps_after_m();
    let ns = |s: f64| 1e9 * s;
    let um = |m: f64| 1e6 * m;
    vec![
        (
            "without taps, equal speeds give visibly different rebounds (spread above 1 % of the speed)",
            format!(
                "{:.2} % (with taps {:.2} %)",
                100.0 * rebound_loose.1,
                100.0 * rebound.1
            ),
            rebound_loose.1 > 0.01,
        ),
        (
            "taps shrink the spread of the incident ToF at least by half",
            format!("from {:.1} to {:.1} ns", ns(tof_loose.1), ns(tof.1)),
            tof.1 < 0.5 * tof_loose.1,
        ),
        (
            "the reflected ToF is longer than the incident",
            format!("{:.2} and {:.2} µs", 1e6 * back.0, 1e6 * tof.0),
            back.0 > tof.0,
        ),
        (
            "the reflected ToF spreads more than the incident, with taps",
            format!("{:.1} and {:.1} ns", ns(back.1), ns(tof.1)),
            back.1 > tof.1,
        ),
        (
            "gaps are left after strong shots (1 m/s)",
            format!(
                "{:.2} µm in all, the largest {:.2} µm",
                um(sum_m),
                um(largest_m)
            ),
            sum_m > 0.0,
        ),
        (
            "taps close the chain (fewer than 1 µm of gaps before a shot)",
            format!(
                "{:.3} µm (without taps {:.2} µm)",
                um(tapped.gaps_before_m()),
                um(loose.gaps_before_m())
            ),
            tapped.gaps_before_m() < 1e-6,
        ),
        (
            "no rebound of the striker at 0.2 m/s (below 1 % of the speed), but at 1 m/s",
            format!(
                "{:.1} % and {:.1} % of the speed",
                100.0 * slow.rebound().0,
                100.0 * rebound.0
            ),
            slow.rebound().0.abs() < 0.01 && rebound.0.abs() > 0.01,
        ),
    ]
}
