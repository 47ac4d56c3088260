//! A return is a pulse that stands out of the noise on what falls beneath it.

use crate::signal::{Channels, PulseKind, QualityFlag, SignalOptions, measure};
use crate::tests::common::{Scene, normal};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Two bells and a background that dies away from the wall's pulse on, in noise; a return as high as this.
fn shot(noise: f64, back: f64, seed: u64) -> Vec<f64> {
    let scene = Scene::default();
    let mut pulses = scene.pulses;
    pulses[2].1 = back;
    let clean = Scene { pulses, ..scene }.summed();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let since = |i: usize| (i as f64 * 1e-6 - pulses[1].0) / 400e-6;
    let falling = |t: f64| if t > 0.0 { 0.1 * (-t).exp() } else { 0.0 };
    let samples = clean.iter().enumerate();
    samples.map(|(i, x)| x + falling(since(i)) + noise * normal(&mut rng)).collect()
}

/// In how many of so many shots a return is found.
fn found(noise: f64, back: f64, shots: u64) -> usize {
    let has = |seed: &u64| {
        let samples = shot(noise, back, *seed);
        let shot = measure(Channels::Summed(&samples), 1e-6, &SignalOptions::default()).unwrap();
        shot.found.reflected.is_some()
    };
    (0..shots).filter(has).count()
}

#[test]
fn noise_on_a_smooth_decay_is_no_return() {
    for noise in [0.1, 0.03, 0.01, 3e-3, 1e-3] {
        // Below 0.2 % of shots: none of 60.
        assert_eq!(found(noise, 0.0, 60), 0, "{noise}");
    }
}

#[test]
fn low_returns_on_a_smooth_decay_are_found() {
    // Twice and a half the height that a maximum needs in the noise left by the first look.
    for (noise, back) in [(0.03, 0.12), (3e-3, 0.03)] {
        assert!(found(noise, back, 40) >= 38, "{noise}");
    }
}

#[test]
fn a_missing_return_is_reported() {
    let samples = shot(1e-3, 0.0, 1);
    let shot = measure(Channels::Summed(&samples), 1e-6, &SignalOptions::default()).unwrap();
    let missing = [QualityFlag::Missing(PulseKind::Reflected), QualityFlag::Unidentified];
    assert!(missing.iter().any(|doubt| shot.found.flags.contains(doubt)));
    assert!(shot.flight.unwrap().reflected_s.is_none());
}
