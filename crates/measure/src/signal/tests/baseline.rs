use super::*;
use crate::signal::statistics::median;

#[test]
fn a_median_ignores_what_lies_far_out() {
    assert_eq!(median(&[3.0, 1.0, 2.0]), Some(2.0));
    assert_eq!(median(&[1.0, 2.0, 1e9, 3.0]), Some(2.0));
    assert_eq!(median(&[]), None);
}

#[test]
fn a_spike_moves_neither_offset_nor_noise() {
    // ±1 by turns about 40: deviation 1 (with n − 1: 1.005), correlation below 1.
    let mut quiet: Vec<f64> = (0..100).map(|i| 40.0 + f64::from(i % 2) * 2.0 - 1.0).collect();
    quiet[17] = 5e3;
    let level = baseline(&quiet).unwrap();
    // One of a hundred samples is left out: 1/99 of a deviation.
    assert!((level.offset - 40.0).abs() < 0.011, "{level:?}");
    assert!((level.noise - 1.0).abs() < 0.011, "{level:?}");
}

#[test]
fn noise_below_a_digitiser_step_is_still_seen() {
    // One sample in five is one step up: mean 0.2, variance 0.16.
    let quiet: Vec<f64> = (0..500).map(|i| if i % 5 == 0 { 1.0 } else { 0.0 }).collect();
    let level = baseline(&quiet).unwrap();
    // n − 1 in place of n.
    assert!((level.offset - 0.2).abs() < 1e-12);
    assert!((level.noise - 0.4).abs() < 1e-3);
}

#[test]
fn a_constant_has_no_noise() {
    let level = baseline(&[2.5; 50]).unwrap();
    assert_eq!((level.offset, level.noise), (2.5, 0.0));
}

#[test]
fn too_little_or_nonsense_is_refused() {
    assert!(matches!(baseline(&[1.0; 7]), Err(MeasureError::TooShort(..))));
    let mut bad = [1.0; 20];
    bad[3] = f64::NAN;
    assert!(matches!(baseline(&bad), Err(MeasureError::NotFinite(3, _))));
}

#[test]
fn the_half_periods_of_a_sine_do_not_cancel() {
    // Of 37 samples a period, over many: what is summed goes up to a quarter of one, 1/π periods.
    for count in [400, 4000, 20_000] {
        let sine = |i: usize| (std::f64::consts::TAU * i as f64 / 36.63).sin();
        let quiet: Vec<f64> = (0..count).map(sine).collect();
        let found = baseline(&quiet).unwrap().correlation;
        assert!((10.0..14.0).contains(&found), "{count}: {found}");
    }
}

#[test]
fn noise_whose_neighbours_are_opposed_counts_less_in_means() {
    // x_i = e_i − x_{i−1}/2: (1 − 1/2)/(1 + 1/2).
    let (mut x, mut seed) = (0.0, 1_u64);
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f64 / f64::from(1_u32 << 24) - 0.5
    };
    let quiet: Vec<f64> = (0..20_000)
        .map(|_| {
            x = next() - 0.5 * x;
            x
        })
        .collect();
    // Lags up to the noise of their own estimates.
    let found = baseline(&quiet).unwrap().correlation;
    assert!((found - 1.0 / 3.0).abs() < 0.08, "{found}");
}
