//! Nothing panics, whatever the samples.

use crate::signal::{
    Channels, DigitiserRange, Estimate, FindOptions, LowPass, Method, Polarity, Shape,
    SignalOptions, baseline, chi_square, coverage, groups, invert_high_pass, measure,
    power_law_both_errors, summary,
};
use crate::tests::common::Scene;
use proptest::prelude::*;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1.0..1.0_f64,
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(f64::MAX),
        1 => Just(f64::MIN_POSITIVE),
        1 => Just(0.0),
        1 => any::<f64>(),
    ]
}

fn methods() -> Vec<Method> {
    vec![
        Method::default(),
        Method::Onset { fraction: 0.1 },
        Method::CrossCorrelation,
        Method::MatchedShape { shape: Shape::cos_power(6.0), width: 2.0 },
    ]
}

fn measure_all(samples: &[f64], wall: &[f64], interval_s: f64) {
    for method in methods() {
        for channels in [Channels::Summed(samples), Channels::Separate { sensor: samples, wall }] {
            for beads in [None, Some((40, 7))] {
                let find = FindOptions {
                    beads,
                    polarity: Polarity::Auto,
                    wall_polarity: Polarity::Negative,
                    range: Some(DigitiserRange { low: -1.0, high: 1.0 }),
                    limits: crate::signal::PulseLimits::default(),
                    wall_range: None,
                };
                let measuring = SignalOptions {
                    find,
                    method: method.clone(),
                    high_pass_s: beads.map(|_| 1e-3),
                    low_pass: None,
                    bandwidth: None,
                    mains_hz: beads.map(|_| 50.0),
                    calibration: crate::signal::SensorCalibration {
                        sensitivities_v_n: beads.map(|_| [1e-300, 1e300]),
                        skew_s: 0.0,
                    },
                };
                let _ = measure(channels, interval_s, &measuring);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn random_numbers_are_measured_or_refused(
        samples in prop::collection::vec(number(), 0..300),
        wall in prop::collection::vec(-1.0..1.0_f64, 0..300),
        interval in number(),
    ) {
        measure_all(&samples, &wall, interval);
        let _ = baseline(&samples);
        let _ = invert_high_pass(&mut samples.clone(), interval, 1e-3);
        let _ = LowPass { cutoff_hz: interval, order: 4 }.apply(&samples, 1e-6);
        let _ = groups(&samples, interval);
        let _ = coverage(&samples, interval);
        let _ = power_law_both_errors(&samples, &samples, &samples, &samples);
        let pairs: Vec<Estimate> =
            samples.iter().map(|x| Estimate { value: *x, sigma: *x }).collect();
        let _ = summary(&pairs);
        let _ = chi_square(&pairs, &samples, 0);
    }

    #[test]
    fn finite_walks_are_measured_or_refused(
        steps in prop::collection::vec(-1.0..1.0_f64, 64..400),
        scale in -300.0..130.0_f64,
    ) {
        let mut at = 0.0;
        let walk: Vec<f64> = steps.iter().map(|s| { at += s; at * 10_f64.powf(scale) }).collect();
        measure_all(&walk, &walk, 1e-6);
    }

    #[test]
    fn damaged_shots_are_measured_or_refused(
        cut in 0_usize..4000,
        from in 0_usize..4000,
        length in 0_usize..3000,
        fill in number(),
        noise in 0.0..0.5_f64,
    ) {
        let scene = Scene { noise, ..Scene::default() };
        let mut samples = scene.summed();
        samples.iter_mut().skip(from).take(length).for_each(|x| *x = fill);
        samples.drain(..cut);
        let wall = scene.summed();
        measure_all(&samples, &wall[cut..], 1e-6);
    }
}
