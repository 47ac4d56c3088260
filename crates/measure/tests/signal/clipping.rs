//! Clipped pulses are timed by their flanks, and stated errors hold what these leave open.

use crate::signal::{
    Channels, Estimate, Measured, Method, PulseKind, QualityFlag, Shape, SignalOptions, coverage,
    measure,
};
use crate::tests::common::{Scene, normal};
use crate::tests::dry::Dry;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The record of one shot without noise, as a function of time, and when its maxima are.
struct Source {
    signal: Box<dyn Fn(f64) -> f64>,
    maxima_s: [f64; 3],
    /// The wall's height, which is the largest.
    highest: f64,
}

fn bells() -> Source {
    let pulses = Scene::default().pulses;
    let shape = Scene::default().shape;
    Source {
        maxima_s: pulses.map(|pulse| pulse.0),
        highest: 1.6,
        signal: Box::new(move |time_s| {
            let one = |(at_s, height, width_s): &(f64, f64, f64)| {
                height * shape.value((time_s - at_s) / width_s)
            };
            pulses.iter().map(one).sum()
        }),
    }
}

fn dry() -> Source {
    let dry = Dry::load();
    let highest = (900..950).map(|us| dry.summed(f64::from(us) * 1e-6)).fold(0.0, f64::max);
    Source {
        maxima_s: Dry::MAXIMA_S.map(|time_s| time_s + 500e-6),
        highest,
        signal: Box::new(move |time_s| dry.summed(time_s - 500e-6)),
    }
}

impl Source {
    /// Sampled from a random moment on, in noise, and clipped.
    fn recorded(&self, noise: f64, end: f64, rng: &mut ChaCha8Rng) -> (f64, Vec<f64>) {
        let phase_s = 1e-6 * f64::from(rng.next_u32()) / f64::from(u32::MAX);
        let sample = |i: u32| {
            let clean = (self.signal)(f64::from(i) * 1e-6 + phase_s);
            (clean + noise * normal(rng)).min(end)
        };
        (phase_s, (0..3200).map(sample).collect())
    }
}

fn measured(samples: &[f64], method: &Method) -> Measured {
    let by = SignalOptions { method: method.clone(), ..SignalOptions::default() };
    measure(Channels::Summed(samples), 1e-6, &by).unwrap()
}

/// Errors of the incident time over the stated ones, and stated ones in ns, of those of 200 shots
/// clipped at this share of the wall's pulse that are not refused.
fn pulls(source: &Source, share: f64, noise: f64) -> Vec<(f64, f64)> {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let true_s = source.maxima_s[1] - source.maxima_s[0];
    let pull = |_| {
        let (_, samples) = source.recorded(noise, share * source.highest, &mut rng);
        let shot = measured(&samples, &Method::default());
        assert!(shot.found.flags.contains(&QualityFlag::Saturation(PulseKind::Wall)));
        let Estimate { value, sigma } = shot.flight.ok()?.incident_s;
        Some(((value - true_s) / sigma, 1e9 * sigma))
    };
    (0..200).filter_map(pull).collect()
}

#[test]
fn stated_errors_of_clipped_pulses_hold_the_true_ones() {
    for (name, source) in [("bells", bells()), ("dry", dry())] {
        for share in [0.8, 0.6, 0.4] {
            for noise in [1e-3, 1e-2] {
                let found = pulls(&source, share, noise);
                let pulls: Vec<f64> = found.iter().map(|(pull, _)| *pull).collect();
                let within = [1.0, 1.96].map(|factor| coverage(&pulls, factor).unwrap().share);
                let what = format!("{name} {share} {noise}: {within:?} of {}", pulls.len());
                // Three binomial errors of 200 below 68.3 and 95 %.
                assert!(within[0] > 0.58 && within[1] > 0.90, "{what}");
                // Noise of a fortieth of what is left hides the flanks' course now and then.
                assert!(pulls.len() > 180, "{what}");
                let stated_ns: f64 = found.iter().map(|(_, ns)| ns).sum::<f64>() / 200.0;
                println!("{what}, {stated_ns:.0} ns");
            }
        }
    }
}

/// What an amplifier before the digitiser makes of a voltage.
type Amplifier = fn(f64, f64) -> f64;

const HARD: Amplifier = |volts, end| volts.min(end);
/// Straight up to nine tenths of its end.
const SOFT: Amplifier = |volts, end| {
    let rest = 0.1 * end;
    let above = volts - 0.9 * end;
    volts.min(0.9 * end) + rest * (above.max(0.0) / rest).tanh()
};

/// Of 25 shots that an amplifier clipped before noise was added, incident times within 1.96
/// stated errors, and how many are flagged.
fn clipped_before_noise(
    source: &Source,
    amplifier: Amplifier,
    share: f64,
    noise: f64,
) -> [usize; 2] {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let true_s = source.maxima_s[1] - source.maxima_s[0];
    let (mut within, mut flagged) = (0, 0);
    for _ in 0..25 {
        let (_, mut samples) = source.recorded(0.0, f64::INFINITY, &mut rng);
        for volts in &mut samples {
            *volts = amplifier(*volts, share * source.highest) + noise * normal(&mut rng);
        }
        let shot = measured(&samples, &Method::default());
        let saturated = shot.found.flags.contains(&QualityFlag::Saturation(PulseKind::Wall));
        flagged += usize::from(saturated);
        let inside = |t: Estimate| (t.value - true_s).abs() < 1.96 * t.sigma;
        within += usize::from(shot.flight.is_ok_and(|flight| inside(flight.incident_s)));
    }
    [within, flagged]
}

#[test]
fn tops_that_an_amplifier_clipped_before_the_digitiser_are_seen_in_its_noise() {
    for (name, source) in [("bells", bells()), ("dry", dry())] {
        for share in [0.95, 0.9, 0.85, 0.7] {
            for noise in [1e-3, 1e-2] {
                let hard = clipped_before_noise(&source, HARD, share, noise);
                // Three binomial errors below 95 %, and one in ten unseen in most noise.
                assert!(hard[0] >= 20 && hard[1] >= 22, "{name} {share} {noise}: {hard:?}");
                // Rounded corners are no bell's: 80 % are covered.
                let soft = clipped_before_noise(&source, SOFT, share, noise);
                assert!(soft[0] >= 17, "soft {name} {share} {noise}: {soft:?}");
            }
        }
    }
}

#[test]
fn whole_tops_are_not_taken_for_clipped_ones() {
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    for source in [bells(), dry()] {
        for noise in [1e-4, 1e-3, 1e-2, 3e-2] {
            for _ in 0..20 {
                let (_, samples) = source.recorded(noise, f64::INFINITY, &mut rng);
                let doubts = measured(&samples, &Method::default()).found.flags;
                let saturated = doubts.iter().any(|d| matches!(d, QualityFlag::Saturation(_)));
                assert!(!saturated, "{noise}: {doubts:?}");
            }
        }
    }
}

#[test]
fn other_methods_use_the_flanks_or_say_why_they_cannot() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let source = bells();
    let (_, samples) = source.recorded(1e-3, 1.0, &mut rng);
    let true_s = source.maxima_s[1] - source.maxima_s[0];
    let shape = Method::MatchedShape { shape: Shape::cos_power(6.0), width: 2.0 };
    let by_shape = measured(&samples, &shape).flight.unwrap().incident_s;
    assert!((by_shape.value - true_s).abs() < 3.0 * by_shape.sigma, "{by_shape:?}");
    let onset = |fraction| measured(&samples, &Method::Onset { fraction }).flight;
    let rise = onset(0.3).unwrap().incident_s;
    // Half the difference of both widths at 0.3 of their heights: 1.32 times that at half.
    let expected_s = true_s + 0.5 * 1.32 * 8e-6;
    assert!((rise.value - expected_s).abs() < 0.2e-6, "{rise:?} {expected_s:e}");
    let reported = onset(0.8).unwrap_err().to_string();
    assert!(reported.contains("clipped"), "{reported}");
    let correlation = Method::CrossCorrelation;
    let reported = measured(&samples, &correlation).flight.unwrap_err().to_string();
    assert!(reported.contains("wall") && reported.contains("clipped"), "{reported}");
}

#[test]
fn tops_with_wide_rounded_corners_are_seen() {
    // Powers of 8: a tenth of the voltage is missing where the amplifier's end is at 90 %.
    let knee = |volt: f64, end: f64| volt / (1.0 + (volt / end).max(0.0).powi(8)).powf(0.125);
    for (share, noise) in [(0.95, 0.001), (0.9, 0.001), (0.75, 0.01), (0.6, 0.01)] {
        let scene = Scene { noise: 0.0, ..Scene::default() };
        let end = share * 1.6;
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        let samples = scene.summed();
        let samples: Vec<f64> =
            samples.iter().map(|volt| knee(*volt, end) + noise * normal(&mut rng)).collect();
        let shot = measure(Channels::Summed(&samples), 1e-6, &SignalOptions::default()).unwrap();
        let seen = shot.found.flags.contains(&QualityFlag::Saturation(PulseKind::Wall));
        assert!(seen, "{share} {noise}: {:?}", shot.found.flags);
    }
}
