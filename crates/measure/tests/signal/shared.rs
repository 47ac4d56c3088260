//! What moves all alike shots alike: what lies under pulses, and what is open of their shapes.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

use crate::signal::{
    Channels, Estimate, Flight, PulseKind, QualityFlag, SignalOptions, Systematic, mean_systematic,
    measure, without_systematic,
};
use crate::tests::common::{Scene, normal};
use crate::tests::dry::Dry;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn under(superposition_s: f64) -> Systematic {
    Systematic { superposition_s, ..Systematic::default() }
}

#[test]
fn what_moves_all_shots_alike_stays_in_a_mean_and_noise_does_not() {
    let pair = |a, b| [under(a), under(b)];
    assert_eq!(mean_systematic(&[pair(3.0, 4.0), pair(3.0, 4.0)]), 5.0);
    assert_eq!(mean_systematic(&[pair(1.0, 2.0), pair(-1.0, 2.0)]), 2.0);
    assert_eq!(mean_systematic(&[]), 0.0);
    assert_eq!(without_systematic(5.0, pair(3.0, 0.0)), 4.0);
    assert_eq!(without_systematic(1.0, pair(3.0, 0.0)), 0.0);
    let open = Systematic { superposition_s: -3.0, shape_s: 4.0, height: 0.0 };
    assert_eq!(mean_systematic(&[[open, under(0.0)], [open, under(0.0)]]), 5.0);
    assert_eq!(without_systematic(13.0, [open, under(0.0)]), 12.0);
}

fn of(samples: &[f64]) -> Flight {
    let shot = measure(Channels::Summed(samples), 1e-6, &SignalOptions::default());
    shot.unwrap().flight.unwrap()
}

/// A scene with something added, by the time in s.
fn with(added: impl Fn(f64) -> f64) -> Flight {
    let mut samples = Scene::default().summed();
    for (i, volt) in samples.iter_mut().enumerate() {
        *volt += added(i as f64 * 1e-6);
    }
    of(&samples)
}

/// Times of the wall's and of the reflected pulse of that scene in s.
const WALL_S: f64 = 1.500_457e-3;
const BACK_S: f64 = 2.280_789e-3;

/// How far in s the return was moved, and how far it may have been.
fn moved(flight: &Flight) -> (f64, f64) {
    let back = flight.picks.reflected.unwrap();
    (back.time_s - BACK_S, back.systematic.superposition_s)
}

#[test]
fn what_is_left_of_a_trail_of_the_wall_under_a_return_is_in_its_error() {
    for time_s in [100e-6, 200e-6, 400e-6] {
        let trail = |t: f64| match t > WALL_S {
            true => 0.3 * (-(t - WALL_S) / time_s).exp(),
            false => 0.0,
        };
        let (by, may) = moved(&with(trail));
        // A share of the largest fall is taken out, as of computed rows; trails fall by another.
        assert!(may < 0.0 && by.abs() < 1.96 * may.abs(), "{time_s}: {by:e} {may:e}");
    }
}

#[test]
fn a_fragment_before_a_return_is_not_taken_for_what_lies_under_it() {
    let fragment = |t: f64| 0.2 * ((t - BACK_S + 110e-6) / 28e-6).cosh().powi(-4);
    let (_, may) = moved(&with(fragment));
    // The fragment's flank is 0.02 high at the return's foot: 2 µs if it went on beneath. What may rise
    // between pulses so far apart is 1e-8.
    assert!(may.abs() < 1.5e-8, "{may:e}");
}

#[test]
fn a_force_of_the_wall_that_comes_back_before_a_return_is_in_its_error() {
    let hump = |t: f64| 0.015 * (-((t - BACK_S + 50e-6) / 120e-6).powi(2)).exp();
    let (by, may) = moved(&with(hump));
    // How it goes on beneath the return is not known: a share of it, by its last means.
    assert!(may.abs() > 2e-8 && by.abs() < 6.0 * may.abs(), "{by:e} {may:e}");
}

#[test]
fn a_wall_that_has_let_go_moves_nothing_and_nothing_is_stated() {
    // From its pulse's end on the wall's force is less by the push, and no more changes.
    let let_go = |t: f64| -0.02 * (1.0 + ((t - WALL_S - 250e-6) / 40e-6).tanh());
    let (by, may) = moved(&with(let_go));
    assert!(by.abs() < 1e-8, "{by:e}");
    // What may rise between pulses so far apart.
    assert!(may.abs() < 1.5e-8, "{may:e}");
}

/// Errors of the incident time of noisy dry shots: all alike, their places between samples not.
fn noisy_dry(shots: u64) -> (Vec<Estimate>, Vec<[Systematic; 2]>) {
    let dry = Dry::load();
    let truth_s = Dry::MAXIMA_S[1] - Dry::MAXIMA_S[0];
    let shot = |seed: u64| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let begun_s = 400e-6 + 1e-8 * (37 * seed % 100) as f64;
        let sample = |i: usize| dry.summed(i as f64 * 1e-6 - begun_s) + 0.003 * normal(&mut rng);
        let samples: Vec<f64> = (0..2600).map(sample).collect();
        let flight = of(&samples);
        let error = Estimate { value: flight.incident_s.value - truth_s, ..flight.incident_s };
        (error, flight.systematic()[0])
    };
    (0..shots).map(shot).unzip()
}

#[test]
fn a_mean_of_skewed_pulses_is_as_far_off_as_what_is_open_of_their_shape_allows() {
    let (errors, moved) = noisy_dry(400);
    let count = errors.len() as f64;
    let mean = errors.iter().map(|error| error.value).sum::<f64>() / count;
    let squares = errors.iter().zip(&moved);
    let squares = squares.map(|(error, moved)| without_systematic(error.sigma, *moved).powi(2));
    let alone_s = squares.sum::<f64>().sqrt() / count;
    let shared_s = mean_systematic(&moved);
    assert!(mean.abs() < 1.96 * alone_s.hypot(shared_s), "{mean:e} {shared_s:e}");
    // A mean that is no better than a shot would say nothing.
    let one_s = errors.iter().map(|error| error.sigma).sum::<f64>() / count;
    assert!(shared_s < 0.5 * one_s, "{shared_s:e} {one_s:e}");
}

/// Error of the incident time where the wall's pulse falls so many times as slowly as it rises and
/// something passes beneath its rise, and whether that is reported.
fn beneath_a_fall(ratio: f64) -> (f64, bool) {
    let mut samples = Scene::default().summed();
    let (top, fall) = (1500, ratio * 26.0 / 2.0_f64.sqrt().acosh());
    for (i, volt) in samples.iter_mut().enumerate().skip(top).take(400) {
        *volt = 1.6 / ((i - top) as f64 / fall).cosh().powi(2);
    }
    for (i, volt) in samples.iter_mut().enumerate() {
        *volt -= 0.016 * (-((i as f64 - 1450.0) / 50.0).powi(2)).exp();
    }
    let shot = measure(Channels::Summed(&samples), 1e-6, &SignalOptions::default()).unwrap();
    let reported = shot.found.flags.contains(&QualityFlag::Asymmetric(PulseKind::Wall));
    (shot.flight.unwrap().incident_s.sigma, reported)
}

#[test]
fn errors_of_pulses_that_trail_do_not_leap_where_it_is_told() {
    // From where one bell no longer follows both halves, and its window is narrower, on.
    let ratios = (0..12).map(|k| 1.4 + 0.1 * f64::from(k));
    let all: Vec<(f64, bool)> = ratios.map(beneath_a_fall).collect();
    assert!(!all[0].1 && all[11].1, "{all:?}");
    for pair in all.windows(2) {
        // The threshold alone made it leap by 2.6.
        let leap = pair[1].0 / pair[0].0;
        assert!((0.8..1.4).contains(&leap), "{all:?}");
    }
    assert!(all[11].0 > 2.0 * all[0].0, "{all:?}");
}

#[test]
fn ratios_of_a_summed_channel_are_without_what_lies_under_pulses_and_their_errors_hold_the_rest() {
    let dry = Dry::load();
    // Of both contacts, from the wall's pulse on: force that is left there, or the static one gone.
    for level in [0.02_f64, -0.02] {
        let sample = |i: usize| {
            let t = i as f64 * 1e-6 - 500e-6;
            let after = 0.5 * (1.0 + ((t - Dry::MAXIMA_S[1] - 200e-6) / 40e-6).tanh());
            let [sensor, wall] = dry.separate(t);
            [sensor + level.min(0.0) * after, wall + level * after]
        };
        let (sensor, wall): (Vec<f64>, Vec<f64>) =
            (0..2900).map(sample).map(|[a, b]| (a, b)).unzip();
        let sum: Vec<f64> = sensor.iter().zip(&wall).map(|(a, b)| a + b).collect();
        let both = Channels::Separate { sensor: &sensor, wall: &wall };
        let apart = measure(both, 1e-6, &SignalOptions::default()).unwrap().flight.unwrap();
        let truth = apart.reflected_over_incident.unwrap().value;
        let found = of(&sum).reflected_over_incident.unwrap();
        let off = (found.value - truth).abs();
        assert!(off < 0.6 * level.abs(), "{level}: {found:?} {truth}");
        assert!(off < 1.96 * found.sigma && found.sigma < 0.02, "{level}: {found:?} {truth}");
        assert_eq!(apart.picks.reflected.unwrap().systematic.height, 0.0);
    }
}
