//! A split return of which noise leaves open which fragment is the largest.

use crate::signal::{Channels, Flight, PulseKind, QualityFlag, SignalOptions, measure};
use crate::tests::common::Scene;

/// Time of the later fragment in s, and how long before it the other comes.
const LATER_S: f64 = 2.280_789e-3;
const APART_S: f64 = 66e-6;
const WALL_S: f64 = 1.500_457e-3;
/// Height of the largest fragment, the incident pulse having 1.
const LARGEST: f64 = 0.1;
const WIDTH_S: f64 = 40e-6;
/// A return of 24 dB; the first look leaves it as it is, since the wall's pulse is clear.
const NOISE: f64 = 0.006;

/// A shot of which the earlier fragment is lower by this much.
fn shot(lower: f64, seed: u64) -> (Flight, Vec<QualityFlag>) {
    let scene = |heights: [f64; 3], back_s: f64, noise: f64| Scene {
        pulses: [
            (0.800_123e-3, heights[0], 60e-6),
            (WALL_S, heights[1], 52e-6),
            (back_s, heights[2], WIDTH_S),
        ],
        noise,
        seed,
        ..Scene::default()
    };
    let whole = scene([1.0, 1.6, LARGEST], LATER_S, NOISE).summed();
    let earlier = scene([0.0, 0.0, LARGEST - lower], LATER_S - APART_S, 0.0).summed();
    let samples: Vec<f64> = whole.iter().zip(earlier).map(|(a, b)| a + b).collect();
    let measured = measure(Channels::Summed(&samples), 1e-6, &SignalOptions::default()).unwrap();
    (measured.flight.unwrap(), measured.found.flags)
}

const SEEDS: u64 = 300;

/// Single samples would choose the wrong one of the two in a tenth of the shots: fits to some
/// thirty of them determine the heights four deviations apart.
#[test]
fn fragments_are_told_apart_by_all_their_samples() {
    let wrong = (0..SEEDS).filter(|seed| {
        let reflected_s = shot(0.015, *seed).0.reflected_s.unwrap();
        (reflected_s.value - (LATER_S - WALL_S)).abs() > 0.5 * APART_S
    });
    // Four deviations: once in 30,000; three of 300 would be none of these.
    assert!(wrong.count() < 3);
}

/// Heights a deviation apart: a sixth of the shots takes the wrong fragment, and all errors say
/// so. In the root mean square errors are as stated but for a fifth: a shot cannot know that the
/// heights of all others are as near.
#[test]
fn a_return_of_fragments_alike_says_so_and_states_how_far_it_may_be_off() {
    let (mut errors, mut stated, mut wrong) = (0.0, 0.0, 0);
    for seed in 0..SEEDS {
        let (flight, doubts) = shot(0.002, seed);
        let reflected_s = flight.reflected_s.unwrap();
        let error_s = reflected_s.value - (LATER_S - WALL_S);
        errors += error_s.powi(2);
        stated += reflected_s.sigma.powi(2);
        if error_s.abs() > 0.5 * APART_S {
            wrong += 1;
            assert!(
                doubts.contains(&QualityFlag::AmbiguousMaximum(PulseKind::Reflected)),
                "{seed}: {doubts:?}"
            );
        }
        // The incident time has no part in it.
        assert!(flight.incident_s.sigma < 2e-6, "{flight:?}");
    }
    assert!((SEEDS / 8..SEEDS / 4).contains(&wrong), "{wrong}");
    let scale = (errors / stated).sqrt();
    assert!((0.8..1.4).contains(&scale), "{scale}");
}

/// Fragments that noise determines apart, and a return in one piece, are in no doubt of this kind.
#[test]
fn fragments_apart_are_no_rivals() {
    for lower in [0.04, LARGEST] {
        for seed in 0..20 {
            let (flight, doubts) = shot(lower, seed);
            assert!(
                !doubts.contains(&QualityFlag::AmbiguousMaximum(PulseKind::Reflected)),
                "{doubts:?}"
            );
            assert!(flight.reflected_s.unwrap().sigma < 4e-6, "{flight:?}");
        }
    }
}

/// Two fragments alike but for a tenth, with a valley of 0.7 of their height, on a plateau behind them:
/// the half height lies beyond both, 70 samples before the maximum and more behind.
#[test]
fn a_fragment_ends_at_the_valley_to_the_next() {
    let fragment = |t: f64, at_s: f64| ((t - LATER_S - at_s) / 31e-6).cosh().powi(-4);
    let plateau = |t: f64| 0.6 / (1.0 + (-(t - LATER_S - 60e-6) / 12e-6).exp());
    let pulses = [(0.8e-3, 1.0, 60e-6), (WALL_S, 1.6, 52e-6), (LATER_S, 0.0, 40e-6)];
    let mut samples = Scene { pulses, noise: 0.002, ..Scene::default() }.summed();
    for (i, volt) in samples.iter_mut().enumerate() {
        let t = i as f64 * 1e-6;
        *volt += 0.2 * (0.9 * fragment(t, -47e-6) + fragment(t, 0.0) + plateau(t));
    }
    let measured = measure(Channels::Summed(&samples), 1e-6, &SignalOptions::default()).unwrap();
    let (rise, _) = measured.found.reflected.unwrap().sides_samples;
    assert!((18.0..28.0).contains(&rise), "{rise}");
}

/// What all shots of a speed determine changes the return and nothing else.
#[test]
fn a_rival_told_to_be_the_higher_is_the_return() {
    let flight = (0..SEEDS)
        .map(|seed| shot(0.002, seed).0.with_interval_error(1e-5))
        .find(|flight| flight.picks.competing[2].is_some())
        .unwrap();
    let alternative = flight.picks.competing[2].unwrap();
    let mut lower = alternative.lower;
    lower.value = -30.0 * lower.sigma;
    let other = flight.with_height_difference(PulseKind::Reflected, lower);
    let moved_s = other.reflected_s.unwrap().value - flight.reflected_s.unwrap().value;
    assert!((moved_s.abs() - APART_S).abs() < 0.1 * APART_S, "{moved_s}");
    assert_eq!(other.incident_s, flight.incident_s);
    // By all evidence there is no doubt any more.
    assert!(other.reflected_s.unwrap().sigma < flight.reflected_s.unwrap().sigma);
    let back = other.with_height_difference(PulseKind::Reflected, lower);
    assert_eq!(back.reflected_s.unwrap().value, flight.reflected_s.unwrap().value);
}

/// At many samples a width, and in steps of a digitiser, noise makes many maxima on one top.
#[test]
fn maxima_on_one_top_are_no_fragments_of_it() {
    let scene = Scene { interval_s: 1e-7, samples: 40_000, noise: 3e-3, ..Scene::default() };
    let step = 4.0 / 256.0;
    for seed in 0..8 {
        let clean = Scene { seed, ..scene.clone() }.summed();
        let steps: Vec<f64> = clean.iter().map(|x| (x / step).round() * step).collect();
        // Differences of neighbours: noise that falls off towards low frequencies.
        let blue: Vec<f64> = clean.windows(2).map(|pair| 2.0 * pair[1] - pair[0]).collect();
        for samples in [steps, blue] {
            let shot =
                measure(Channels::Summed(&samples), 1e-7, &SignalOptions::default()).unwrap();
            let doubts = shot.found.flags;
            let alike = doubts.iter().any(|d| {
                matches!(d, QualityFlag::AmbiguousMaximum(_) | QualityFlag::Saturation(_))
            });
            assert!(!alike, "{seed}: {doubts:?}");
        }
    }
}

/// Fragments of 5 dB, as those of pump oil at 0.08 m/s: noise fills the valley between them, and neither
/// stands out of the other's flank.
#[test]
fn fragments_without_a_valley_between_them_compete() {
    let (later_s, earlier_s) = (2.855e-3, 2.765e-3);
    let pull = |seed: u64| {
        let pulses = [(0.8e-3, 1.0, 70e-6), (1.709e-3, 0.57, 80e-6), (later_s, 0.107, 70e-6)];
        let whole = Scene { pulses, noise: 0.056, seed, ..Scene::default() }.summed();
        let pulses = [(0.8e-3, 0.0, 70e-6), (1.709e-3, 0.0, 80e-6), (earlier_s, 0.084, 70e-6)];
        let earlier = Scene { pulses, noise: 0.0, seed, ..Scene::default() }.summed();
        let samples: Vec<f64> = whole.iter().zip(earlier).map(|(a, b)| a + b).collect();
        let measured = measure(Channels::Summed(&samples), 1e-6, &SignalOptions::default());
        let reflected_s = measured.unwrap().flight.unwrap().reflected_s?;
        Some((reflected_s.value - (later_s - 1.709e-3)) / reflected_s.sigma)
    };
    let pulls: Vec<f64> = (0..SEEDS).filter_map(pull).collect();
    let scale = (pulls.iter().map(|pull| pull * pull).sum::<f64>() / pulls.len() as f64).sqrt();
    // Where only maxima with a valley competed it was 1.64.
    assert!(pulls.len() > 250 && scale < 1.25, "{} {scale}", pulls.len());
}
