//! Sines before a shot: harmonics of the mains and the ripple of a supply.

use crate::signal::{Channels, Flight, QualityFlag, SignalOptions, coverage, measure};
use crate::tests::common::normal;
use crate::tests::dry::Dry;
use crate::tests::source::dry_shot;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

const INTERVAL_S: f64 = 1e-6;

/// 15 shots of 60 dB with so many quiet samples before them, and shares of sines of frequencies in Hz
/// under them; with the mains' frequency, if it is given.
fn flights(lead: usize, sines: &[(f64, f64)], mains_hz: Option<f64>) -> Vec<Flight> {
    let (source, noise) = (dry_shot(), 1e-3);
    let shot = |number: u64| {
        let mut rng = ChaCha8Rng::seed_from_u64(number);
        let mut samples: Vec<f64> = (0..lead).map(|_| noise * normal(&mut rng)).collect();
        samples.extend(source.recorded(INTERVAL_S, noise, &mut rng));
        for (at, sample) in samples.iter_mut().enumerate() {
            let sine = |(share, hz): &(f64, f64)| {
                share * (TAU * (hz * at as f64 * INTERVAL_S + hz * number as f64 / 7.3)).sin()
            };
            *sample += sines.iter().map(sine).sum::<f64>();
        }
        let options = SignalOptions { mains_hz, ..SignalOptions::default() };
        let measured = measure(Channels::Summed(&samples), INTERVAL_S, &options).unwrap();
        assert_eq!(measured.found.flags.contains(&QualityFlag::Drift), !sines.is_empty());
        measured.flight.unwrap()
    };
    (0..15).map(shot).collect()
}

fn widest_s(flights: &[Flight]) -> f64 {
    flights.iter().map(|flight| flight.incident_s.sigma).fold(0.0, f64::max)
}

/// Root mean square of made over stated errors of both times.
fn scales(flights: &[Flight]) -> [f64; 2] {
    let [passing, wall, back] = Dry::MAXIMA_S;
    let incident = flights.iter().map(|flight| (flight.incident_s, wall - passing));
    let reflected = flights.iter().map(|flight| (flight.reflected_s.unwrap(), back - wall));
    let scale = |pulls: Vec<f64>| coverage(&pulls, 1.96).unwrap().scale;
    let pull = |(time, true_s): (crate::signal::Estimate, f64)| (time.value - true_s) / time.sigma;
    [scale(incident.map(pull).collect()), scale(reflected.map(pull).collect())]
}

#[test]
fn harmonics_above_500_hz_and_ripple_widen_no_error_where_the_record_shows_them() {
    let quiet_s = widest_s(&flights(30_000, &[], None));
    for sines in [
        &[(0.05, 50.0), (0.01, 150.0), (0.01, 650.0)][..],
        &[(0.01, 2130.0)],
        &[(0.2, 49.9), (0.02, 649.0), (0.01, 1310.0)],
    ] {
        let found = flights(30_000, sines, None);
        // Taken for noise, a sine of 1 % and 650 Hz widens them thirtyfold.
        assert!(widest_s(&found) < 1.5 * quiet_s, "{sines:?}: {} {quiet_s}", widest_s(&found));
        for scale in scales(&found) {
            // The root mean square of 15 deviates is 1 ± 0.18.
            assert!((0.4..1.5).contains(&scale), "{sines:?}: {scale}");
        }
    }
}

#[test]
fn records_that_show_less_than_a_period_are_left_as_they_are() {
    let found = flights(8000, &[(0.2, 50.0), (0.01, 650.0)], None);
    for scale in scales(&found) {
        assert!(scale < 1.5, "{scale}");
    }
}

/// A free sine of less than a period and the slow baseline are one to a fit; of a known frequency they
/// are not.
#[test]
fn sines_held_at_multiples_of_the_mains_need_no_period_of_it() {
    let quiet_s = widest_s(&flights(8000, &[], None));
    for (lead, sines) in [
        (8000, [(0.05, 50.0), (0.01, 650.0)]),
        (14_000, [(0.2, 50.0), (0.02, 350.0)]),
        // Mains may be off by 0.4 %.
        (8000, [(0.05, 50.2), (0.01, 652.6)]),
    ] {
        let found = flights(lead, &sines, Some(50.0));
        // Free, a sine of 1 % and 650 Hz widens them thirtyfold.
        assert!(widest_s(&found) < 1.5 * quiet_s, "{sines:?}: {} {quiet_s}", widest_s(&found));
        for scale in scales(&found) {
            // The root mean square of 15 deviates is 1 ± 0.18.
            assert!((0.4..1.5).contains(&scale), "{sines:?}: {scale}");
        }
    }
}

#[test]
fn ripple_that_is_no_multiple_of_the_mains_is_subtracted_as_without_them() {
    let sines = [(0.05, 50.0), (0.01, 2137.0)];
    let (with, without) = (flights(30_000, &sines, Some(50.0)), flights(30_000, &sines, None));
    assert_eq!(with, without);
}

#[test]
fn mains_of_an_impossible_frequency_are_refused() {
    for hz in [0.5, 5e3, f64::NAN] {
        let options = SignalOptions { mains_hz: Some(hz), ..SignalOptions::default() };
        let error = measure(Channels::Summed(&[0.0; 100]), INTERVAL_S, &options).unwrap_err();
        assert!(error.to_string().contains("mains"), "{error}");
    }
}
