//! Small pulses before the first one are no noise.

use crate::signal::{Channels, SignalOptions, measure};
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
fn what_is_not_known_of_the_baseline_is_in_the_ratio_of_peaks() {
    let scene = Scene {
        pulses: [(70e-6, 1.0, 60e-6), (770e-6, 1.6, 52e-6), (1550e-6, 0.45, 66e-6)],
        noise: 1e-3,
        samples: 3000,
        ..Scene::default()
    };
    let mut samples = scene.summed();
    // From the first pulse on contacts are open: the record's median is no baseline.
    samples[110..].iter_mut().for_each(|sample| *sample -= 0.02);
    let shot = measure(Channels::Summed(&samples), 1e-6, &SignalOptions::default()).unwrap();
    let ratio = shot.flight.unwrap().wall_over_incident;
    assert!((ratio.value - 1.58).abs() < 1.96 * ratio.sigma, "{ratio:?}");
    assert!((0.01..0.2).contains(&ratio.sigma), "{ratio:?}");
}

#[test]
fn crosstalk_before_a_pulse_does_not_widen_its_error() {
    // Ten per cent more noise, and the slope of what crosses over.
    let ratio = stated(0.1) / stated(0.0);
    assert!((0.8..1.3).contains(&ratio), "{ratio}");
}
