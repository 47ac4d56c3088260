//! Small pulses before the first one are no noise.

use crate::signal::{SignalOptions, measure};
use crate::tests::common::{Scene, channels};

/// Stated error of the incident time, with so much of each channel in the other one.
fn stated(crosstalk: f64) -> f64 {
    let scene = Scene { noise: 3e-3, ..Scene::default() };
    let (sensor, wall) = scene.separate();
    let mixed = |own: &[f64], other: &[f64]| -> Vec<f64> {
        let pairs = own.iter().zip(other);
        pairs.map(|(own, other)| own + crosstalk * other).collect()
    };
    let pair = (mixed(&sensor, &wall), mixed(&wall, &sensor));
    let shot = measure(channels(&pair), 1e-6, &SignalOptions::default()).unwrap();
    shot.flight.unwrap().incident_s.sigma
}

#[test]
fn crosstalk_before_a_pulse_does_not_widen_its_error() {
    // Ten per cent more noise, and the slope of what crosses over.
    let ratio = stated(0.1) / stated(0.0);
    assert!((0.8..1.3).contains(&ratio), "{ratio}");
}
