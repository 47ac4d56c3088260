//! Shots of one speed determine together which fragment of their returns is the largest.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

use hertzchain_measure::signal::{Channels, Flight, Shape, SignalOptions, measure};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

const WALL_S: f64 = 1.5e-3;
const LATER_S: f64 = 2.28e-3;
const APART_S: f64 = 66e-6;
const NOISE: f64 = 0.006;

/// Standard normal to the twelfth of a uniform's variance.
fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let uniform = |rng: &mut ChaCha8Rng| f64::from(rng.next_u32()) / f64::from(u32::MAX);
    (0..12).map(|_| uniform(rng)).sum::<f64>() - 6.0
}

/// A shot of which the later fragment is higher by this much.
fn shot(later_higher: f64, seed: u64) -> Flight {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let fragments = [(-APART_S, 0.1 - 0.5 * later_higher), (0.0, 0.1 + 0.5 * later_higher)];
    measured(fragments, |_| 0.0, NOISE, &mut rng)
}

/// A shot whose return has fragments at these times after [`LATER_S`], and something else.
fn measured(
    fragments: [(f64, f64); 2],
    other: impl Fn(f64) -> f64,
    noise: f64,
    rng: &mut ChaCha8Rng,
) -> Flight {
    let bell = Shape::cos_power(6.0);
    let [first, second] = fragments.map(|(after_s, height)| (LATER_S + after_s, height, 40e-6));
    let pulses = [(0.8e-3, 1.0, 60e-6), (WALL_S, 1.6, 52e-6), first, second];
    let sample = |i: u32| {
        let t = f64::from(i) * 1e-6;
        let clean = pulses.iter().map(|(at, h, w)| h * bell.value((t - at) / w));
        clean.sum::<f64>() + other(t) + noise * normal(rng)
    };
    let samples: Vec<f64> = (0..4000).map(sample).collect();
    let measured = measure(Channels::Summed(&samples), 1e-6, &SignalOptions::default()).unwrap();
    measured.flight.unwrap()
}

fn twenty(later_higher: f64, first: u64) -> Vec<Flight> {
    (first..first + 20).map(|seed| shot(later_higher, seed)).collect()
}

/// As they enter the mean; no shot is left out for its passing or wall's pulse.
fn resolve_ambiguous(flights: &[Flight]) -> Vec<Flight> {
    let all = hertzchain_measure::resolve_ambiguous(&flights.iter().collect::<Vec<_>>());
    all.into_iter().map(Option::unwrap).collect()
}

fn is_later(flight: &Flight) -> bool {
    let reflected_s = flight.reflected_s.unwrap().value;
    (reflected_s - (LATER_S - WALL_S)).abs() < 0.5 * APART_S
}

/// A difference of one and a half standard errors of a shot is seven of twenty shots' mean.
#[test]
fn one_fragment_is_chosen_for_all_shots_of_a_speed() {
    let mut wrong = 0;
    for first in [0, 20, 40] {
        for (later_higher, later) in [(0.006, true), (-0.006, false)] {
            let own = twenty(later_higher, first);
            wrong += own.iter().filter(|flight| is_later(flight) != later).count();
            let all = resolve_ambiguous(&own);
            for flight in &all {
                assert!(is_later(flight) == later, "{flight:?}");
                // No error of a wrong choice is left.
                assert!(flight.reflected_s.unwrap().sigma < 4e-6, "{flight:?}");
            }
        }
    }
    // The shots by themselves were wrong now and then.
    assert!(wrong > 0);
}

/// No user can determine which of two equal fragments is the largest: hardly a time is left. By chance
/// twenty shots determine a difference that is none once in 370 times.
#[test]
fn returns_of_equal_fragments_have_no_time() {
    for first in [100, 120, 140] {
        let own = twenty(0.0, first);
        assert!(own.iter().all(|flight| flight.reflected_s.is_some()));
        let all = resolve_ambiguous(&own);
        let timed = all.iter().filter(|flight| flight.reflected_s.is_some());
        assert!(timed.count() <= 2);
        for (own, resolved) in own.iter().zip(&all) {
            assert_eq!(own.incident_s, resolved.incident_s);
        }
    }
}

/// Chains that differ have their own largest fragments, and keep them.
#[test]
fn shots_that_differ_keep_their_own_fragments() {
    let own: Vec<Flight> =
        (0..20).map(|seed| shot(if seed % 2 == 0 { 0.02 } else { -0.02 }, 200 + seed)).collect();
    let all = resolve_ambiguous(&own);
    for (seed, flight) in all.iter().enumerate() {
        if flight.reflected_s.is_some() {
            assert_eq!(is_later(flight), seed % 2 == 0, "{seed}");
        }
    }
    let timed = all.iter().filter(|flight| flight.reflected_s.is_some());
    assert!(timed.count() >= 15);
}

/// Of a later fragment that a plateau follows, the width holds the earlier one, too.
#[test]
fn fragments_with_a_valley_between_them_compete_however_wide_the_return() {
    for seed in 300..320 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let plateau = |t: f64| {
            let rise = ((t - LATER_S) / 20e-6).clamp(-20.0, 20.0).exp();
            let fall = ((t - LATER_S - 350e-6) / 20e-6).clamp(-20.0, 20.0).exp();
            0.05 * rise / (1.0 + rise) / (1.0 + fall)
        };
        let fragments = [(-90e-6, 0.081), (0.0, 0.056)];
        let flight = measured(fragments, plateau, 0.002, &mut rng);
        assert!(flight.picks.competing[2].is_some(), "{seed}");
    }
}

/// The wall's force falls under two fragments that are equal: how much lower the later one is says
/// nothing, in one shot or in twenty.
#[test]
fn what_lies_under_a_return_leaves_it_ambiguous() {
    let own: Vec<Flight> = (400..420)
        .map(|seed| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let fall =
                |t: f64| if t > WALL_S { 0.06 * (-(t - WALL_S) / 300e-6).exp() } else { 0.0 };
            measured([(-APART_S, 0.2), (0.0, 0.2)], fall, 2e-4, &mut rng)
        })
        .collect();
    let all = resolve_ambiguous(&own);
    assert!(all.iter().all(|flight| flight.reflected_s.is_none()));
}
