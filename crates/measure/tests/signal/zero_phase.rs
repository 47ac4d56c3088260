//! The zero-phase low-pass against scipy.signal.

use crate::MeasureError;
use crate::signal::LowPass;

fn samples() -> Vec<f64> {
    let sample = |i: f64| (-((i - 33.3) / 6.0).powi(2)).exp() + 0.3 * (0.9 * i).sin() + 0.01 * i;
    (0..80).map(|i| sample(f64::from(i))).collect()
}

/// Samples 0, 1, 7, 33, 34, 60, 78, 79 and the sum of all, from scipy 1.17.1:
/// `b, a = butter(order, cutoff, fs=1e6); y = filtfilt(b, a, x)`.
fn assert_scipy(low_pass: LowPass, at: [f64; 8], sum: f64) {
    let found = low_pass.apply(&samples(), 1e-6).unwrap();
    for (k, expected) in [0, 1, 7, 33, 34, 60, 78, 79].into_iter().zip(at) {
        // Sections here, one polynomial there: rounding of the recursion.
        assert!((found[k] - expected).abs() < 1e-11, "{k}: {}", found[k]);
    }
    assert!((found.iter().sum::<f64>() - sum).abs() < 1e-9);
}

#[test]
fn second_order_agrees_with_scipy_filtfilt() {
    let low_pass = LowPass { cutoff_hz: 40e3, order: 2 };
    let at = [
        -0.001205196070149609,
        0.013382773742524296,
        0.06540822994068451,
        1.0303515698329553,
        1.0374397654172274,
        0.579205549112996,
        1.001739743632771,
        1.0560833136229275,
    ];
    assert_scipy(low_pass, at, 43.217403612834346);
}

#[test]
fn fourth_order_agrees_with_scipy_filtfilt() {
    let low_pass = LowPass { cutoff_hz: 120e3, order: 4 };
    let at = [
        -0.0012348831856834066,
        0.04873673039618041,
        0.0708944753809749,
        1.2719503053398065,
        1.2846207841613333,
        0.5714070193967449,
        0.8741501129892175,
        1.0618229045573073,
    ];
    assert_scipy(low_pass, at, 42.443311367064595);
}

#[test]
fn what_cannot_be_filtered_is_refused() {
    let low_pass = |cutoff_hz, order| LowPass { cutoff_hz, order };
    let refused =
        |filter: LowPass, samples: &[f64], interval| filter.apply(samples, interval).is_err();
    assert!(refused(low_pass(6e5, 2), &samples(), 1e-6));
    assert!(refused(low_pass(0.0, 2), &samples(), 1e-6));
    assert!(refused(low_pass(f64::NAN, 2), &samples(), 1e-6));
    assert!(refused(low_pass(1e5, 3), &samples(), 1e-6));
    assert!(refused(low_pass(1e5, 2), &samples(), 0.0));
    assert!(refused(low_pass(1e5, 4), &[1.0; 15], 1e-6));
    let mut bad = samples();
    bad[40] = f64::NAN;
    assert!(matches!(low_pass(1e5, 2).apply(&bad, 1e-6), Err(MeasureError::NotFinite(40, _))));
}
