//! Maxima as they were before an amplifier's low-pass.

use crate::MeasureError;
use crate::signal::{Bandwidth, Channels, Flight, SignalOptions, measure};
use crate::tests::dry::Dry;
use std::f64::consts::TAU;

/// Order and kind, and denominators: of each factor the coefficients of s and s², s over the corner.
const FILTERS: [(usize, bool, [[f64; 2]; 2]); 7] = [
    (1, false, [[1.0, 0.0], [0.0; 2]]),
    (2, false, [[std::f64::consts::SQRT_2, 1.0], [0.0; 2]]),
    (3, false, [[1.0, 0.0], [1.0, 1.0]]),
    (4, false, [[1.847_759_065, 1.0], [0.765_366_865, 1.0]]),
    (2, true, [[1.361_654_129, 0.618_033_989], [0.0; 2]]),
    (3, true, [[0.756_043_168, 0.0], [0.999_629_201, 0.477_191_359]]),
    (4, true, [[1.339_663_700, 0.488_904_151], [0.774_253_975, 0.388_990_734]]),
];

/// A computed shot, each channel behind a low-pass, by Euler's method in steps of 10 ns, at 1 MHz.
fn recorded(corner_hz: f64, factors: [[f64; 2]; 2]) -> [Vec<f64>; 2] {
    let (dry, step_s) = (Dry::load(), 1e-8);
    let ratio = TAU * corner_hz * step_s;
    [0, 1].map(|channel| {
        let mut states = [[0.0_f64; 2]; 2];
        let mut samples = Vec::new();
        for step in 0..320_000 {
            let mut input = dry.separate(f64::from(step) * step_s - 0.5e-3)[channel];
            for ([first, second], [value, rate]) in factors.iter().zip(&mut states) {
                match (*first, *second) {
                    (0.0, _) => continue,
                    (first, 0.0) => *value += ratio / first * (input - *value),
                    (first, second) => {
                        *rate += ratio / second * (input - *value - first * *rate);
                        *value += ratio * *rate;
                    }
                }
                input = *value;
            }
            if step % 100 == 0 {
                samples.push(input);
            }
        }
        samples
    })
}

fn flight(
    [sensor, wall]: &[Vec<f64>; 2],
    bandwidth: Option<Bandwidth>,
) -> Result<Flight, MeasureError> {
    let measuring = SignalOptions { bandwidth, ..SignalOptions::default() };
    measure(Channels::Separate { sensor, wall }, 1e-6, &measuring).unwrap().flight
}

#[test]
fn low_passes_of_all_orders_and_kinds_are_taken_out_of_times_and_heights() {
    let [passing, wall, back] = Dry::MAXIMA_S;
    let true_s = [wall - passing, back - wall];
    let whole = flight(&recorded(5e6, FILTERS[0].2), None).unwrap();
    let ratios = |of: &Flight| [of.wall_over_incident, of.reflected_over_incident.unwrap()];
    for (order, bessel, factors) in FILTERS {
        let corner_hz = 50e3;
        let samples = recorded(corner_hz, factors);
        let off = |bandwidth| {
            let found = flight(&samples, bandwidth).unwrap();
            let times_s = [found.incident_s, found.reflected_s.unwrap()];
            let times = [0, 1].map(|time| (times_s[time].value - true_s[time]).abs());
            let heights =
                [0, 1].map(|of| (ratios(&found)[of].value / ratios(&whole)[of].value - 1.0).abs());
            (times, heights)
        };
        let (left, now) = (off(None), off(Some(Bandwidth { corner_hz, order, bessel })));
        // The fit itself is off by some 10 ns, and Euler's steps by as much.
        assert!(now.0[0] < 25e-9 && now.0[1] < 40e-9, "{order} {bessel}: {now:?}");
        assert!(left.0[0] > 60e-9, "{order} {bessel}: {left:?}");
        assert!(now.1[0] < 1e-4 && now.1[1] < 1e-4, "{order} {bessel}: {now:?}");
        assert!(left.1[0] > 1e-3, "{order} {bessel}: {left:?}");
    }
}

#[test]
fn a_low_pass_of_another_order_is_refused() {
    let samples = recorded(50e3, FILTERS[0].2);
    let five = Bandwidth { corner_hz: 50e3, order: 5, bessel: false };
    assert!(matches!(flight(&samples, Some(five)), Err(MeasureError::Option(..))));
}

#[test]
fn a_corner_that_no_pulse_as_short_passes_is_refused_with_the_least() {
    let samples = recorded(50e3, FILTERS[1].2);
    for order in [1, 2] {
        let low = flight(&samples, Some(Bandwidth { corner_hz: 180.0, order, bessel: false }));
        let Err(MeasureError::LowCorner(_, least_hz)) = low else { panic!("{low:?}") };
        assert!((1e3..1e4).contains(&least_hz), "{least_hz}");
    }
}
