//! What a high-pass does to times of flight, and taking it back.

use crate::signal::{Channels, Shape, SignalOptions, invert_high_pass, measure};
use crate::tests::common::Scene;

/// Samples after a first-order high-pass, τ y' + y = τ x', from rest, by the trapezoidal rule:
/// y_n (1 + k) = y_{n−1} (1 − k) + x_n − x_{n−1} with k = interval/(2τ).
fn drooped(samples: &[f64], interval_s: f64, time_constant_s: f64) -> Vec<f64> {
    let k = 0.5 * interval_s / time_constant_s;
    let (mut x_before, mut y) = (0.0, 0.0);
    let pass = |x: &f64| {
        y = (y * (1.0 - k) + x - x_before) / (1.0 + k);
        x_before = *x;
        y
    };
    samples.iter().map(pass).collect()
}

#[test]
fn the_inverse_gives_back_what_the_high_pass_took() {
    let shape = Shape::cos_power(6.0);
    let bell = |i: i32| shape.value((f64::from(i) - 700.0) / 50.0);
    let clean: Vec<f64> = (0..2000).map(bell).collect();
    let mut samples = drooped(&clean, 1e-6, 2e-3);
    assert!(samples[1200] < -0.02, "an undershoot follows the pulse");
    invert_high_pass(&mut samples, 1e-6, 2e-3).unwrap();
    for (back, clean) in samples.iter().zip(&clean) {
        // Rounding, summed over 2,000 steps.
        assert!((back - clean).abs() < 1e-12);
    }
}

#[test]
fn times_of_flight_are_put_right_when_the_time_constant_is_given() {
    let scene = Scene { noise: 1e-6, ..Scene::default() };
    let samples = drooped(&scene.summed(), 1e-6, 2e-3);
    let off = |high_pass_s| {
        let measuring = SignalOptions { high_pass_s, ..SignalOptions::default() };
        let shot = measure(Channels::Summed(&samples), 1e-6, &measuring).unwrap();
        shot.flight.unwrap().incident_s.value - scene.incident_s()
    };
    let uncorrected = off(None);
    // (52² − 60²)/(5.33 · 2000) µs = −0.08, with the other sign: a narrow pulse moves less.
    assert!((uncorrected - 84e-9).abs() < 10e-9, "{uncorrected:e}");
    // The local model's own bias on bells of these widths.
    assert!(off(Some(2e-3)).abs() < 5e-9);
}

#[test]
fn a_time_constant_of_nothing_is_refused() {
    assert!(invert_high_pass(&mut [0.0; 4], 1e-6, 0.0).is_err());
    assert!(invert_high_pass(&mut [0.0; 4], f64::NAN, 1.0).is_err());
    assert!(invert_high_pass(&mut [f64::INFINITY; 4], 1e-6, 1.0).is_err());
}
