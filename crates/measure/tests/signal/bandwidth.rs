//! Maxima as they were before an amplifier's low-pass.

use crate::MeasureError;
use crate::signal::{Bandwidth, Channels, SignalOptions, measure};
use crate::tests::dry::Dry;
use std::f64::consts::{SQRT_2, TAU};

/// A computed shot behind a low-pass, by Euler's method in steps of 10 ns.
fn recorded(low_pass: Bandwidth) -> Vec<f64> {
    let (dry, step_s) = (Dry::load(), 1e-8);
    let ratio = TAU * low_pass.corner_hz * step_s;
    let (mut value, mut rate) = (0.0, 0.0);
    let mut samples = Vec::new();
    for step in 0..320_000 {
        let input = dry.summed(f64::from(step) * step_s - 0.5e-3);
        match low_pass.order {
            1 => value += ratio * (input - value),
            _ => {
                rate += ratio * (input - value - SQRT_2 * rate);
                value += ratio * rate;
            }
        }
        if step % 100 == 0 {
            samples.push(value);
        }
    }
    samples
}

fn times_s(samples: &[f64], bandwidth: Option<Bandwidth>) -> [f64; 2] {
    let measuring = SignalOptions { bandwidth, ..SignalOptions::default() };
    let shot = measure(Channels::Summed(samples), 1e-6, &measuring).unwrap();
    let flight = shot.flight.unwrap();
    [flight.incident_s.value, flight.reflected_s.unwrap().value]
}

#[test]
fn a_low_pass_is_taken_out_of_maxima_where_its_corner_is_given() {
    let [passing, wall, back] = Dry::MAXIMA_S;
    let true_s = [wall - passing, back - wall];
    for order in [1, 2] {
        let low_pass = Bandwidth { corner_hz: 50e3, order };
        let samples = recorded(low_pass);
        let off = |bandwidth| {
            let times_s = times_s(&samples, bandwidth);
            [0, 1].map(|time| (times_s[time] - true_s[time]).abs())
        };
        let (left, whole) = (off(None), off(Some(low_pass)));
        // The fit itself is off by some 10 ns, and Euler's steps by as much.
        assert!(whole[0] < 25e-9 && whole[1] < 40e-9, "{order}: {whole:?}");
        assert!(left[0] > 60e-9, "{order}: {left:?}");
    }
}

#[test]
fn a_low_pass_of_another_order_is_refused() {
    let samples = recorded(Bandwidth { corner_hz: 50e3, order: 1 });
    let measuring = SignalOptions {
        bandwidth: Some(Bandwidth { corner_hz: 50e3, order: 3 }),
        ..SignalOptions::default()
    };
    let shot = measure(Channels::Summed(&samples), 1e-6, &measuring).unwrap();
    assert!(matches!(shot.flight, Err(MeasureError::Option(..))));
}

#[test]
fn a_corner_that_no_pulse_as_short_passes_is_refused_with_the_least() {
    let samples = recorded(Bandwidth { corner_hz: 50e3, order: 2 });
    for (corner_hz, order) in [(180.0, 2), (180.0, 1)] {
        let bandwidth = Some(Bandwidth { corner_hz, order });
        let measuring = SignalOptions { bandwidth, ..SignalOptions::default() };
        let shot = measure(Channels::Summed(&samples), 1e-6, &measuring).unwrap();
        let Err(MeasureError::LowCorner(_, least_hz)) = shot.flight else { panic!("{shot:?}") };
        assert!((1e3..1e4).contains(&least_hz), "{least_hz}");
    }
}
