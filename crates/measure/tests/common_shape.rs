//! Pulses of one speed's shots have one shape in common.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

use hertzchain_measure::records::{Channel, Record};
use hertzchain_measure::signal::{Estimate, Method, SignalOptions, coverage};
use hertzchain_measure::{Grouping, Measurement, Options, Shot, ShotList, measure_records};

/// Incident and reflected time of flight in s.
const TIMES_S: [f64; 2] = [700.0e-6, 750.0e-6];

/// A pulse, as high as 1, that falls as fast as a dry chain's and rises somewhat slower or faster.
fn pulse(samples: f64, rise: f64) -> f64 {
    let width = if samples < 0.0 { rise } else { 28.0 };
    (-(samples / width).powi(2)).exp()
}

/// Normal noise by a formula: sums of twelve remainders, whose variance is 1.
fn noise(place: u64, seed: u64) -> f64 {
    let mut state =
        (place + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ seed.wrapping_mul(0xbf58_476d);
    let mut uniform = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..12).map(|_| uniform()).sum::<f64>() - 6.0
}

/// Shots of two channels at 1 MS/s whose first channel has pulses of this rise in samples, given by
/// the shot's number.
fn records(shots: u64, noise: (f64, u64), rise: impl Fn(u64) -> f64) -> Vec<Record> {
    records_of(shots, noise, &|shot, [incident, reflected]| {
        pulse(incident, rise(shot)) + 0.6 * pulse(reflected, rise(shot))
    })
}

/// The same, of any signal of the sensor's, given by the shot's number and samples after each pulse.
fn records_of(
    shots: u64,
    (level, seed): (f64, u64),
    sensor: &dyn Fn(u64, [f64; 2]) -> f64,
) -> Vec<Record> {
    let record = |shot: u64| {
        let at = 500.0 + 0.37 * shot as f64;
        let [wall, back] = [at + 1e6 * TIMES_S[0], at + 1e6 * (TIMES_S[0] + TIMES_S[1])];
        let channel = |name: &str, which: u64| {
            let signal = |i: u64| match which {
                0 => sensor(shot, [i as f64 - at, i as f64 - back]),
                _ => 1.5 * pulse(i as f64 - wall, 28.0),
            };
            let volts = (0..2600).map(|i| signal(i) + level * noise(i, 2 * (shot + seed) + which));
            Channel { name: name.to_owned(), volts: volts.collect(), range_v: None }
        };
        Record {
            source: format!("shot {shot}"),
            file: format!("shot-{shot}").into(),
            channels: vec![channel("sensor", 0), channel("wall", 1)],
            interval_s: 1e-6,
            programmed_speed_m_s: Some(0.5),
            speed_m_s: Some(0.5),
            ..Record::default()
        }
    };
    (0..shots).map(record).collect()
}

/// Errors of reflected times over stated ones, and stated ones over those of each shot alone, where
/// reflected pulses are two fragments of this height and second share.
fn of_fragments(seed: u64, of_shot: impl Fn(u64) -> (f64, f64)) -> (Vec<f64>, f64) {
    let reflected = |shot: u64, at: f64| {
        let (height, share) = of_shot(shot);
        height * (pulse(at, 28.0) + share * pulse(at - 32.0, 28.0))
    };
    let sensor = |shot, [first, second]: [f64; 2]| pulse(first, 28.0) + reflected(shot, second);
    let mut measured = measured(records_of(40, (0.0015, seed), &sensor), &Options::default());
    let sigma_s = |shot: &Shot| shot.flight.as_ref().unwrap().reflected_s.unwrap().sigma;
    let alone_s: f64 = measured.shots.iter().map(sigma_s).sum();
    measured.curves(&Grouping::default());
    let pull = |(number, shot): (usize, &Shot)| {
        let places = (0..3000).map(|place| 0.01 * f64::from(place));
        let height = |at: &f64| reflected(number as u64, *at);
        let at = places.max_by(|a, b| height(a).total_cmp(&height(b))).unwrap();
        let time = shot.flight.as_ref().unwrap().reflected_s.unwrap();
        (time.value - TIMES_S[1] - 1e-6 * at) / time.sigma
    };
    let pulls = measured.shots.iter().enumerate().map(pull).collect();
    (pulls, measured.shots.iter().map(sigma_s).sum::<f64>() / alone_s)
}

fn measured(records: Vec<Record>, options: &Options) -> Measurement {
    measure_records(records, options, &())
}

fn times(shots: &[Shot]) -> Vec<Estimate> {
    shots.iter().map(|shot| shot.flight.as_ref().unwrap().incident_s).collect()
}

fn rms_s(shots: &[Shot]) -> f64 {
    let errors = times(shots).into_iter().map(|time| (time.value - TIMES_S[0]).powi(2));
    (errors.sum::<f64>() / shots.len() as f64).sqrt()
}

#[test]
fn times_of_twenty_shots_are_twice_as_exact_together_and_state_it() {
    let mut made = Vec::new();
    for series in 0..10 {
        let records = records(20, (0.01, 100 * series), |_| 28.0);
        let mut measured = measured(records, &Options::default());
        let alone_s = rms_s(&measured.shots);
        measured.curves(&Grouping::default());
        let together_s = rms_s(&measured.shots);
        assert!(together_s < 0.5 * alone_s, "{series}: {together_s} of {alone_s}");
        let all = times(&measured.shots).into_iter();
        made.extend(all.map(|time| (time.value - TIMES_S[0]) / time.sigma));
    }
    let coverage = coverage(&made, 1.96).unwrap();
    // 200 shots, whose common errors are ten: 0.95 ± 0.03.
    assert!(coverage.share > 0.86 && coverage.scale > 0.5, "{coverage:?}");
}

#[test]
fn a_shot_of_another_shape_keeps_its_own_pick() {
    let odd = |shot| if shot == 3 { 38.0 } else { 28.0 };
    let mut together = measured(records(12, (0.003, 0), odd), &Options::default());
    let alone = together.clone();
    together.curves(&Grouping::default());
    for (number, (one, other)) in together.shots.iter().zip(&alone.shots).enumerate() {
        let [one, other] = [one, other].map(|shot| shot.flight.as_ref().unwrap().picks.incident);
        assert_eq!(one.time_s == other.time_s, number == 3, "{number}");
    }
}

#[test]
fn a_shape_that_changes_with_the_height_is_followed() {
    let mut made = Vec::new();
    for seed in 0..4 {
        let (pulls, of_alone) = of_fragments(100 * seed, |shot| {
            let off = 0.03 * ((7 * shot) % 40) as f64 / 20.0 - 0.03;
            (0.4 * (1.0 + 1.2 * off), 0.5 + 2.0 * off)
        });
        assert!(of_alone < 0.5, "{of_alone}");
        made.extend(pulls);
    }
    let coverage = coverage(&made, 1.96).unwrap();
    assert!(coverage.share > 0.9 && coverage.scale < 1.25, "{coverage:?}");
}

#[test]
fn shots_of_shapes_that_differ_by_more_than_noise_keep_their_own() {
    let mut made = Vec::new();
    for seed in 0..4 {
        let share = |shot: u64| 0.5 + 0.04 * noise(shot, seed);
        let (pulls, of_alone) = of_fragments(100 * seed, |shot| (0.4, share(shot)));
        assert!(of_alone < 0.6, "{of_alone}");
        made.extend(pulls);
    }
    let coverage = coverage(&made, 1.96).unwrap();
    assert!(coverage.share > 0.9 && coverage.scale < 1.25, "{coverage:?}");
}

#[test]
fn picks_of_other_methods_and_by_hand_stay() {
    let onset = SignalOptions { method: Method::Onset { fraction: 0.2 }, ..Default::default() };
    let list = "file,incident pick s\nshot-2,5.07e-4\n";
    let list = ShotList::parse(list).unwrap();
    for options in [
        Options { measuring: onset, ..Options::default() },
        Options { list: Some(list), ..Options::default() },
    ] {
        let by_hand = options.list.is_some();
        let mut together = measured(records(5, (0.01, 0), |_| 28.0), &options);
        let alone = together.clone();
        together.curves(&Grouping::default());
        for (number, (one, other)) in together.shots.iter().zip(&alone.shots).enumerate() {
            let [one, other] =
                [one, other].map(|shot| shot.flight.as_ref().unwrap().picks.incident);
            assert_eq!(one == other, !by_hand || number == 2, "{number}");
        }
    }
}

#[test]
fn one_shot_alone_keeps_its_pick() {
    let mut measured = measured(records(1, (0.01, 0), |_| 28.0), &Options::default());
    let alone = measured.shots.clone();
    measured.curves(&Grouping::default());
    assert_eq!(measured.shots, alone);
}
