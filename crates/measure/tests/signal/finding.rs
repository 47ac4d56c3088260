//! Pulses are found whatever the offset, polarity and noise, and doubts are raised where due.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::MeasureError;
use crate::signal::{
    Channels, DigitiserRange, FindOptions, Found, Polarity, PulseKind, QualityFlag, SignalOptions,
    measure, pulses,
};
use crate::tests::common::{Scene, channels};

fn find(samples: &[f64]) -> Found {
    pulses(Channels::Summed(samples), &FindOptions::default()).unwrap()
}

/// Every pulse within `widths` of its width of where it is.
fn assert_found(scene: &Scene, found: &Found, widths: f64) {
    for (pulse, (at, _, width)) in
        [found.incident, found.wall, found.reflected].into_iter().zip(scene.pulses)
    {
        let pulse = pulse.unwrap_or_else(|| panic!("{found:?}"));
        let off = (pulse.at as f64 * scene.interval_s - at).abs();
        assert!(off < widths * width, "{pulse:?} {at}");
    }
}

#[test]
fn clean_pulses_are_found_to_a_sample_and_without_doubt() {
    for (offset, sign, samples) in [(0.0, 1.0, 4000), (-7.5, -1.0, 4000), (1e3, 1.0, 100_000)] {
        let scene = Scene { offset, sign, samples, ..Scene::default() };
        let found = find(&scene.summed());
        // Half a sample, and rounding of equal neighbours.
        assert_found(&scene, &found, 0.02);
        assert_eq!(found.flags, []);
        let pair = scene.separate();
        let found = pulses(channels(&pair), &FindOptions::default()).unwrap();
        assert_found(&scene, &found, 0.02);
        assert_eq!(found.flags, []);
        assert_eq!(found.sensor.sign, sign);
    }
}

#[test]
fn heights_and_widths_are_near_the_pulses_own() {
    let scene = Scene::default();
    let found = find(&scene.summed());
    for (pulse, (_, height, width)) in found.pulses().zip(scene.pulses) {
        // Half a sample off the top of a bell 50 samples wide.
        assert!((pulse.height / height - 1.0).abs() < 1e-3);
        assert!((pulse.width_samples * 1e-6 / width - 1.0).abs() < 1e-2);
    }
}

#[test]
fn pulses_are_found_at_20_db() {
    for (interval_s, samples) in [(1e-6, 4000), (2e-6, 2000), (1e-6, 100_000)] {
        for seed in 0..60 {
            let scene = Scene {
                interval_s,
                samples,
                noise: 0.1,
                seed,
                offset: 0.3,
                sign: if seed % 2 == 0 { 1.0 } else { -1.0 },
                ..Scene::default()
            };
            let found = find(&scene.summed());
            // The flat top in noise of a tenth.
            assert_found(&scene, &found, 0.4);
            let pair = scene.separate();
            let found = pulses(channels(&pair), &FindOptions::default()).unwrap();
            assert_found(&scene, &found, 0.4);
            // The reflected pulse is 13 dB above the noise, and said to be low.
            assert!(found.flags.contains(&QualityFlag::LowSignal(PulseKind::Reflected)));
        }
    }
}

#[test]
fn narrow_pulses_are_found_at_20_db_in_long_records() {
    for seed in 0..40 {
        let scene = Scene {
            interval_s: 2e-6,
            samples: 50_000,
            noise: 0.1,
            seed,
            // The fastest shots: 17 samples across half the maximum.
            pulses: [(800e-6, 1.0, 35e-6), (1450e-6, 1.6, 32e-6), (2150e-6, 0.47, 38e-6)],
            ..Scene::default()
        };
        let found = find(&scene.summed());
        let strong = [found.incident, found.wall];
        for (pulse, (at, _, width)) in strong.iter().zip(scene.pulses) {
            let off = (pulse.unwrap().at as f64 * 2e-6 - at).abs();
            // The flat top in noise of a tenth.
            assert!(off < 0.4 * width, "{seed}: {found:?}");
        }
    }
}

#[test]
fn a_spike_before_the_first_pulse_is_passed_over() {
    let scene = Scene { noise: 1e-3, ..Scene::default() };
    for sign in [1.0, -1.0] {
        let mut samples = scene.summed();
        samples[300] += 3.0 * sign;
        let found = find(&samples);
        assert_found(&scene, &found, 0.05);
        assert_eq!(found.flags, []);
    }
}

#[test]
fn a_short_lead_is_doubted_but_the_pulses_are_found() {
    let scene = Scene {
        pulses: [(70e-6, 1.0, 60e-6), (770e-6, 1.6, 52e-6), (1550e-6, 0.45, 66e-6)],
        noise: 0.01,
        samples: 3000,
        ..Scene::default()
    };
    let found = find(&scene.summed());
    assert_found(&scene, &found, 0.1);
    assert!(found.flags.contains(&QualityFlag::FewQuietSamples));
}

#[test]
fn saturation_is_seen_with_and_without_known_rails() {
    let scene = Scene { noise: 1e-3, ..Scene::default() };
    let clipped: Vec<f64> = scene.summed().iter().map(|x| x.min(1.2)).collect();
    let found = find(&clipped);
    assert_eq!(found.flags, [QualityFlag::Saturation(PulseKind::Wall)]);
    let finding = FindOptions {
        range: Some(DigitiserRange { low: -1.2, high: 1.2 }),
        ..FindOptions::default()
    };
    let found = pulses(Channels::Summed(&clipped), &finding).unwrap();
    assert_eq!(found.flags, [QualityFlag::Saturation(PulseKind::Wall)]);
}

#[test]
fn each_channel_is_held_against_its_own_rails() {
    let scene = Scene::default();
    let whole = scene.separate();
    let mut clipped = whole.clone();
    clipped.1.iter_mut().for_each(|x| *x = x.min(1.2));
    let up_to = |volts: f64| {
        let (low, high) = (-volts, volts);
        Some(DigitiserRange { low, high })
    };
    let within = |sensor, wall| FindOptions {
        range: up_to(sensor),
        wall_range: up_to(wall),
        ..FindOptions::default()
    };
    let doubts = |pair, finding| pulses(channels(pair), &finding).unwrap().flags;
    let saturated = [QualityFlag::Saturation(PulseKind::Wall)];
    assert_eq!(doubts(&clipped, within(10.0, 1.2)), saturated);
    // The wall's pulse is higher than the sensor's range, not than its own.
    assert_eq!(doubts(&whole, within(1.1, 10.0)), []);
}

#[test]
fn a_coarse_digitiser_does_not_look_saturated() {
    // 200 steps to the top of the wall's pulse.
    let samples: Vec<f64> = Scene::default().summed().iter().map(|x| (x * 125.0).round()).collect();
    assert_eq!(find(&samples).flags, []);
    // 48 steps, as eight bits give a wall's pulse of three eighths of the range.
    let samples: Vec<f64> = Scene::default().summed().iter().map(|x| (x * 30.0).round()).collect();
    let flags = find(&samples).flags;
    assert!(!flags.iter().any(|flag| matches!(flag, QualityFlag::Saturation(_))), "{flags:?}");
}

#[test]
fn missing_pulses_are_named() {
    let mut scene = Scene { noise: 1e-3, ..Scene::default() };
    scene.pulses[2].1 = 0.0;
    let found = of_row(&scene);
    assert_eq!(found.flags, [QualityFlag::Missing(PulseKind::Reflected)]);
    scene.pulses[1].1 = 0.0;
    let found = find(&scene.summed());
    let both = [QualityFlag::Missing(PulseKind::Wall), QualityFlag::Missing(PulseKind::Reflected)];
    assert_eq!(found.flags, both);
}

/// With the paper's row known.
fn of_row(scene: &Scene) -> Found {
    let finding = FindOptions { beads: Some((40, 7)), ..FindOptions::default() };
    pulses(Channels::Summed(&scene.summed()), &finding).unwrap()
}

#[test]
fn a_lost_passing_pulse_is_named_where_the_row_is_known_and_doubted_where_not() {
    for samples in [2700, 4000] {
        let mut scene = Scene { noise: 1e-3, samples, ..Scene::default() };
        scene.pulses[0].1 = 0.0;
        let found = of_row(&scene);
        assert!(found.flags.contains(&QualityFlag::Missing(PulseKind::Incident)));
        assert!(found.incident.is_none());
        let at = [found.wall, found.reflected].map(|pulse| pulse.unwrap().at.abs_diff(0));
        assert!(at[0].abs_diff(1500) < 3 && at[1].abs_diff(2281) < 3, "{at:?}");
        let found = find(&scene.summed());
        assert!(found.flags.contains(&QualityFlag::Unidentified), "{:?}", found.flags);
    }
}

#[test]
fn a_return_much_lower_than_the_first_pulse_is_still_found() {
    for height in [0.45, 0.3, 0.1] {
        let mut scene = Scene { noise: 1e-3, ..Scene::default() };
        scene.pulses[0].1 = 0.0;
        scene.pulses[2].1 = height;
        let found = of_row(&scene);
        assert!(found.flags.contains(&QualityFlag::Missing(PulseKind::Incident)), "{height}");
    }
}

#[test]
fn a_lost_pulse_of_the_wall_is_told_from_a_lost_passing_one() {
    let mut scene = Scene { noise: 1e-3, samples: 6000, ..Scene::default() };
    // 16.2 widths to the wall, as in a row of Hertz beads.
    scene.pulses = [(800e-6, 1.0, 45e-6), (0.0, 0.0, 1.0), (2300e-6, 0.35, 50e-6)];
    let found = of_row(&scene);
    assert!(found.flags.contains(&QualityFlag::Missing(PulseKind::Wall)), "{:?}", found.flags);
    assert!(find(&scene.summed()).flags.contains(&QualityFlag::Unidentified));
}

#[test]
fn a_lost_passing_pulse_is_doubted_though_a_later_one_is_taken_for_the_return() {
    let mut scene = Scene { noise: 1e-3, samples: 5000, ..Scene::default() };
    // The wall's, the return, and the wall's again after 47 beads for 33.
    scene.pulses = [(800e-6, 1.6, 40e-6), (1570e-6, 0.47, 50e-6), (2680e-6, 0.4, 55e-6)];
    for found in [find(&scene.summed()), of_row(&scene)] {
        assert!(found.flags.contains(&QualityFlag::Order), "{:?}", found.flags);
    }
    // Without the low second pulse, the ways' times alone determine in a known row.
    scene.pulses[1].1 = 1.2;
    assert!(of_row(&scene).flags.contains(&QualityFlag::Order));
}

#[test]
fn pulses_of_few_samples_are_doubted() {
    let scene = Scene { interval_s: 14e-6, samples: 300, noise: 1e-3, ..Scene::default() };
    let doubts = find(&scene.summed()).flags;
    let few = |doubt: &QualityFlag| matches!(doubt, QualityFlag::FewSamples(_));
    assert!(doubts.iter().any(few), "{doubts:?}");
}

#[test]
fn two_pulses_without_a_third_are_no_shot_unless_the_record_ends_before_it() {
    let mut scene = Scene { noise: 1e-3, ..Scene::default() };
    scene.pulses[2].1 = 0.0;
    assert_eq!(find(&scene.summed()).flags, [QualityFlag::Unidentified]);
    scene.samples = 2000;
    let doubts = find(&scene.summed()).flags;
    assert!(!doubts.iter().any(QualityFlag::is_grave), "{doubts:?}");
}

#[test]
fn a_record_that_ends_early_is_too_short() {
    let scene = Scene { samples: 2000, noise: 1e-3, ..Scene::default() };
    let found = find(&scene.summed());
    assert!(found.flags.contains(&QualityFlag::RecordTooShort));
    assert!(found.flags.contains(&QualityFlag::Missing(PulseKind::Reflected)));
}

#[test]
fn a_fragment_beside_a_pulse_splits_it() {
    let scene = Scene::default();
    let fragment = Scene {
        pulses: [(2.44e-3, 0.2, 60e-6), (0.0, 0.0, 1.0), (0.0, 0.0, 1.0)],
        ..Scene::default()
    };
    let both: Vec<f64> = scene.summed().iter().zip(fragment.summed()).map(|(a, b)| a + b).collect();
    assert_eq!(find(&both).flags, [QualityFlag::Split(PulseKind::Reflected)]);
}

#[test]
fn pulses_that_run_into_each_other_overlap() {
    let scene = Scene {
        pulses: [(800e-6, 1.0, 100e-6), (950e-6, 1.6, 100e-6), (1120e-6, 0.9, 100e-6)],
        ..Scene::default()
    };
    let found = find(&scene.summed());
    assert!(found.flags.contains(&QualityFlag::Overlap(PulseKind::Incident, PulseKind::Wall)));
}

#[test]
fn a_weak_pulse_of_the_wall_is_told_from_the_return() {
    // The wall's disc is less sensitive than the bead's: its pulse is the lowest.
    let scene = Scene {
        pulses: [(800e-6, 1.0, 45e-6), (1520e-6, 0.2, 45e-6), (2260e-6, 0.5, 45e-6)],
        noise: 1e-3,
        ..Scene::default()
    };
    let finding = FindOptions { beads: Some((40, 7)), ..FindOptions::default() };
    let found = pulses(Channels::Summed(&scene.summed()), &finding).unwrap();
    assert_found(&scene, &found, 0.1);
    assert!(found.flags.contains(&QualityFlag::Order));
    // Without it a pulse half way must be half as high, and is doubted too.
    let mut strong = scene;
    strong.pulses[1].1 = 0.3;
    let found = find(&strong.summed());
    assert_found(&strong, &found, 0.1);
    assert!(found.flags.contains(&QualityFlag::Order));
}

#[test]
fn a_stated_polarity_is_obeyed() {
    let scene = Scene { sign: -1.0, noise: 0.01, ..Scene::default() };
    let finding = |polarity| FindOptions { polarity, ..FindOptions::default() };
    let samples = scene.summed();
    let found = pulses(Channels::Summed(&samples), &finding(Polarity::Negative)).unwrap();
    assert_found(&scene, &found, 0.1);
    let wrong = pulses(Channels::Summed(&samples), &finding(Polarity::Positive));
    assert!(matches!(wrong, Err(MeasureError::NoPulse { .. })), "{wrong:?}");
}

#[test]
fn noise_alone_is_no_pulse() {
    for seed in 0..40 {
        let scene = Scene {
            pulses: [(0.0, 0.0, 1.0); 3],
            samples: 20_000,
            noise: 1.0,
            seed,
            ..Scene::default()
        };
        let found = pulses(Channels::Summed(&scene.summed()), &FindOptions::default());
        assert!(matches!(found, Err(MeasureError::NoPulse { .. })), "{found:?}");
    }
}

#[test]
fn records_that_hold_nothing_say_why() {
    let on =
        |samples: &[f64]| pulses(Channels::Summed(samples), &FindOptions::default()).unwrap_err();
    assert!(matches!(on(&[]), MeasureError::TooShort(0, _)));
    assert!(matches!(on(&[3.0; 500]), MeasureError::Constant { .. }));
    let mut bad = Scene::default().summed();
    bad[77] = f64::INFINITY;
    assert!(matches!(on(&bad), MeasureError::NotFinite(77, _)));
    let pair = (vec![0.0; 100], vec![0.0; 99]);
    let lengths = pulses(channels(&pair), &FindOptions::default());
    assert!(matches!(lengths, Err(MeasureError::Lengths { .. })));
    let finding = FindOptions { beads: Some((7, 7)), ..FindOptions::default() };
    let beads = pulses(Channels::Summed(&Scene::default().summed()), &finding);
    assert!(matches!(beads, Err(MeasureError::Option(..))));
}

/// A wall's pulse that falls three times as slowly as it rises.
fn trailing() -> (Vec<f64>, Vec<f64>) {
    let (sensor, mut wall) = Scene::default().separate();
    let top = 1500;
    for (i, volt) in wall.iter_mut().enumerate().skip(top) {
        *volt = 1.6 / ((i - top) as f64 / 59.0).cosh().powi(2);
    }
    (sensor, wall)
}

#[test]
fn a_pulse_that_trails_is_doubted_in_a_summed_channel_alone() {
    let pair = trailing();
    let sum: Vec<f64> = pair.0.iter().zip(&pair.1).map(|(a, b)| a + b).collect();
    assert_eq!(find(&sum).flags, [QualityFlag::Asymmetric(PulseKind::Wall)]);
    let found = pulses(channels(&pair), &FindOptions::default()).unwrap();
    assert_eq!(found.flags, []);
}

#[test]
fn what_lies_under_a_pulse_that_trails_is_in_its_error() {
    let (sensor, wall) = trailing();
    let sum: Vec<f64> = sensor.iter().zip(&wall).map(|(a, b)| a + b).collect();
    // A swing of a hundredth as it rises, over when it falls.
    let swing = |i: usize| 0.016 * (-((i as f64 - 1450.0) / 50.0).powi(2)).exp();
    let under = sum.iter().enumerate().map(|(i, volt)| volt - swing(i));
    let under: Vec<f64> = under.collect();
    let wall_s = |samples: &[f64]| {
        let shot = measure(Channels::Summed(samples), 1e-6, &SignalOptions::default());
        shot.unwrap().flight.unwrap().incident_s
    };
    let (alone, beneath) = (wall_s(&sum), wall_s(&under));
    let off = (beneath.value - alone.value).abs();
    assert!(off > 1e-7, "{off:e}");
    assert!(off < 1.96 * beneath.sigma, "{off:e} {beneath:?}");
}
