//! Times of few digits beside samples: times of flight are as wrong as stated errors say.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

use hertzchain_measure::records::ReadOptions;
use hertzchain_measure::{Measurement, Options, measure};
use std::fs;
use std::path::{Path, PathBuf};

/// From the incident pulse to the wall's, and back, in s.
const FLIGHTS_S: [f64; 2] = [700.3e-6, 781.1e-6];

/// A recording whose times are printed to so many digits behind the point.
fn recording(test: &str, interval_s: f64, digits: usize) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("clock").join(test);
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{interval_s:e}-{digits}.csv"));
    let begun_s = 500e-6;
    let at_s = [begun_s, begun_s + FLIGHTS_S[0], begun_s + FLIGHTS_S[0] + FLIGHTS_S[1]];
    let volt = |time_s: f64| -> f64 {
        let bell = |at_s: f64| ((time_s - at_s) / 35e-6).cosh().powi(-4);
        bell(at_s[0]) + 1.6 * bell(at_s[1]) + 0.4 * bell(at_s[2])
    };
    let row = |i: u32| {
        let time_s = f64::from(i) * interval_s;
        // Rounding to 1e-5 V is the noise.
        format!("{:.digits$},{:.5}\n", time_s - 400e-6, volt(time_s))
    };
    let rows: String = (0..3000).map(row).collect();
    fs::write(&path, format!("Time (s),Volts\n{rows}")).unwrap();
    path
}

fn measured(path: &Path, rate_hz: Option<f64>) -> Measurement {
    let options = Options {
        reading: ReadOptions { rate_hz, ..ReadOptions::default() },
        ..Options::default()
    };
    measure(&[path.to_owned()], &options, &())
}

/// How far both times of flight are off, each with its stated error.
fn departures_s(measured: &Measurement) -> [(f64, f64); 2] {
    let flight = measured.shots[0].flight.as_ref().unwrap();
    let reflected = flight.reflected_s.unwrap();
    [(flight.incident_s, FLIGHTS_S[0]), (reflected, FLIGHTS_S[1])]
        .map(|(time, expected)| ((time.value - expected).abs(), time.sigma))
}

#[test]
fn rounded_times_bias_no_time_of_flight_beyond_its_error() {
    for interval_s in [1e-6, 1.0013e-6, 0.998e-6] {
        for digits in [5, 6, 8] {
            let found = measured(&recording("any-rate", interval_s, digits), None);
            for (off_s, sigma_s) in departures_s(&found) {
                // Twice the error: a uniform share of what digits leave open ends at 1.73.
                assert!(off_s < 2.0 * sigma_s, "{interval_s:e} {digits}: {off_s:e} {sigma_s:e}");
            }
        }
    }
}

#[test]
fn a_given_rate_leaves_nothing_of_rounded_times() {
    for digits in [5, 6] {
        let path = recording("given-rate", 1.0013e-6, digits);
        let loose = departures_s(&measured(&path, None));
        let found = measured(&path, Some(1.0013e-6_f64.recip()));
        assert_eq!(found.notes, []);
        for ((off_s, sigma_s), (_, loose_s)) in departures_s(&found).into_iter().zip(loose) {
            // Bells that are sampled finely are picked to 10 ns.
            assert!(off_s < 10e-9, "{off_s:e}");
            assert!(sigma_s < loose_s, "{sigma_s:e} {loose_s:e}");
        }
    }
}
