//! Campaign, recordings, times of flight, and back to the model that made them.

#[path = "../examples/whole_loop/judged.rs"]
#[allow(dead_code, reason = "the example tells more")]
mod judged;

use hertzchain_measure::Options;
use hertzchain_signal::{ChiSquare, Estimate, Measuring, chi_square};
use judged::{Curve, Judged, TIMES, agreement, by_speed, judge, run};
use std::fs;

/// The paper's rig with one dry chain, four speeds and short records, changed as told.
fn dry(changes: &[(&str, &str)]) -> String {
    let paper = include_str!("../../../experiments/paper.toml");
    let (dry, _) = paper
        .split_once("[[campaign.cases]]\nname = \"pump\"")
        .unwrap();
    let always = [
        ("speed_count = 60", "speed_count = 4"),
        ("record = \"0.1 s\"", "record = \"30 ms\""),
    ];
    let all = always.iter().chain(changes);
    all.fold(dry.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

/// Laid compact before its only shot. Nothing pushes it: friction would hold other loads
/// on its contacts than the model's equilibrium has.
const COMPACT: [(&str, &str); 6] = [
    ("force = \"0.24 N\"", "force = \"0 N\""),
    ("stiffness = \"100 N/m\"", "stiffness = \"0 N/m\""),
    ("incline = \"0.5 deg\"", "incline = \"0 deg\""),
    ("shots = 20", "shots = 1"),
    ("taps = 40", "taps = 0"),
    ("gap_scatter = \"5 um\"", "gap_scatter = \"0 um\""),
];

/// Recordings of a campaign, one a seed, as they are measured.
fn judged(name: &str, text: &str, seeds: u64, options: &[Options]) -> Vec<Vec<Judged>> {
    let under = std::env::temp_dir().join(format!("hertzchain-{name}-{}", std::process::id()));
    let folders = run(text, seeds, &under).unwrap();
    let each = |options: &Options| -> Vec<Judged> {
        let folders = folders.iter();
        folders
            .flat_map(|folder| judge(folder, options).unwrap())
            .collect()
    };
    let all = options.iter().map(each);
    let all = all.collect();
    fs::remove_dir_all(&under).unwrap();
    all
}

/// Chance gives less once in a thousand seeds; those here are fixed.
const LEAST: f64 = 1e-3;

/// Chi-squares of both times against one of the model's curves at all four speeds.
fn against(shots: &[Judged], curve: Curve) -> [ChiSquare; 2] {
    [0, 1].map(|time| {
        let all: Vec<&Judged> = shots.iter().collect();
        let rows = by_speed(&all, time, curve);
        assert_eq!(rows.len(), 4);
        agreement(&rows).unwrap()
    })
}

/// Both times agree with the model's at every speed.
fn agree_with_the_model(shots: &[Judged], curve: Curve) {
    for (judged, name) in against(shots, curve).iter().zip(TIMES) {
        assert!(judged.probability > LEAST, "{name}: {judged:?}");
    }
}

#[test]
fn measured_times_of_a_compact_chain_are_the_models_at_every_speed() {
    let shots = judged("compact", &dry(&COMPACT), 6, &[Options::default()]).remove(0);
    assert_eq!(shots.len(), 24);
    agree_with_the_model(&shots, judged::COMPACT);
    for (time, name) in TIMES.iter().enumerate() {
        let judged = against_truth(&shots, time);
        assert!(judged.probability > LEAST, "{name}: {judged:?}");
        // Errors stated ten times too large would give next to nothing.
        assert!(
            judged.value > 0.2 * judged.freedom as f64,
            "{name}: {judged:?}"
        );
    }
}

/// With push, slope, stop, gaps as laid and taps: what keeps the preset's times from the
/// model's is friction alone, which holds loads that equilibrium has not.
#[test]
fn measured_times_of_a_tapped_chain_that_friction_hardly_holds_are_the_models() {
    let changes = [
        ("friction = 0.05", "friction = 0.001"),
        ("shots = 20", "shots = 6"),
        ("taps = 40", "taps = 3"),
    ];
    let shots = judged("tapped", &dry(&changes), 1, &[Options::default()]).remove(0);
    assert_eq!(shots.len(), 24);
    agree_with_the_model(&shots, judged::COMPACT);
}

/// Friction that could hold nearly three times the push, and taps that close the chain: the
/// model of the chain in equilibrium is missed, the model with the loads that were held is not.
#[test]
fn measured_times_of_a_tapped_chain_are_the_models_with_the_loads_that_friction_holds() {
    let changes = [
        ("friction = 0.05", "friction = 0.2"),
        ("shots = 20", "shots = 6"),
        ("taps = 40", "taps = 12"),
    ];
    let shots = judged("held", &dry(&changes), 1, &[Options::default()]).remove(0);
    agree_with_the_model(&shots, judged::HELD);
    for (judged, name) in against(&shots, judged::COMPACT).iter().zip(TIMES) {
        assert!(judged.probability < LEAST, "{name}: {judged:?}");
    }
}

/// Times of flight by stated errors, against the true ones of the same shots.
fn against_truth(shots: &[Judged], time: usize) -> ChiSquare {
    let errors: Vec<Estimate> = shots.iter().filter_map(|shot| shot.error(time)).collect();
    assert_eq!(errors.len(), shots.len());
    chi_square(&errors, &vec![0.0; errors.len()], 0).unwrap()
}

/// Corner of the amplifier's high-pass in Hz: within a pulse of 50 µs it loses a quarter.
const STRONG_HZ: f64 = 1000.0;

#[test]
fn a_strong_high_pass_moves_times_of_flight_and_its_corner_given_puts_them_back() {
    let mut changes = COMPACT.to_vec();
    changes.push(("high_pass = \"0.5 Hz\"", "high_pass = \"1 kHz\""));
    let told = Options {
        measuring: Measuring {
            high_pass_s: Some((std::f64::consts::TAU * STRONG_HZ).recip()),
            ..Measuring::default()
        },
        ..Options::default()
    };
    let both = judged("droop", &dry(&changes), 4, &[Options::default(), told]);
    for (time, name) in TIMES.iter().enumerate() {
        let [untold, told] = [0, 1].map(|at: usize| against_truth(&both[at], time));
        assert!(told.probability > LEAST, "{name}: {told:?}");
        assert!(untold.probability < LEAST, "{name}: {untold:?}");
    }
}
