//! Samples that stand out of a smooth signal: found, repaired, and none where there are none.

use crate::signal::{
    Channels, Measured, QualityFlag, Shape, SignalOptions, measure, without_spikes,
};
use crate::tests::common::normal;
use crate::tests::dry::Dry;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// When the computed shot begins in a record, in s.
const BEGINS_S: f64 = 0.5e-3;

/// Samples of a computed dry shot and noise, this far apart; the first pulse's height is 1.
fn record(interval_s: f64, noise: f64, seed: u64) -> Vec<f64> {
    let dry = Dry::load();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let phase = uniform(&mut rng);
    let sample = |i: usize| {
        let clean = dry.summed((i as f64 + phase) * interval_s - BEGINS_S);
        clean + noise * normal(&mut rng)
    };
    (0..(2.38e-3 / interval_s) as usize).map(sample).collect()
}

fn uniform(rng: &mut ChaCha8Rng) -> f64 {
    rng.next_u64() as f64 / u64::MAX as f64
}

#[test]
fn clean_records_have_no_spikes_whatever_their_rate_and_noise() {
    // Pulses of the dry shot are 46 µs wide at half maximum: 92 to 3.5 samples.
    for interval_us in [0.5, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 13.0] {
        for noise in [0.0, 1e-4, 1e-3, 1e-2, 1e-1] {
            for seed in 0..6 {
                let samples = record(interval_us * 1e-6, noise, seed);
                let (_, spikes) = without_spikes(&samples);
                assert!(spikes.is_empty(), "{interval_us} µs, noise {noise}: {spikes:?}");
                // Eight bits.
                let rounded: Vec<f64> = samples.iter().map(|x| (64.0 * x).round()).collect();
                assert!(without_spikes(&rounded).1.is_empty(), "{interval_us} µs, {noise}");
            }
        }
    }
}

#[test]
fn bells_three_samples_wide_are_no_spikes() {
    for width in [3.0, 3.5, 4.0, 5.0, 7.0, 10.0] {
        for seed in 0..20 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let (phase, noise) = (uniform(&mut rng), [0.0, 1e-3, 1e-2][seed as usize % 3]);
            let shape = Shape::cos_power([2.0, 4.0, 6.0][seed as usize / 3 % 3]);
            let sample = |i: usize| {
                let bell = |at: f64| shape.value((i as f64 + phase - at) / width);
                let clean = bell(100.0) + 1.6 * bell(100.0 + 16.0 * width);
                clean + noise * normal(&mut rng)
            };
            let samples: Vec<f64> = (0..400).map(sample).collect();
            assert!(without_spikes(&samples).1.is_empty(), "{width}, seed {seed}");
        }
    }
}

/// A record at 1 MHz with spikes of one or two samples of either sign, and where they are: one
/// anywhere, one on a pulse.
fn spiked(noise: f64, height: f64, seed: u64) -> (Vec<f64>, Vec<usize>) {
    let mut samples = record(1e-6, noise, seed);
    let mut rng = ChaCha8Rng::seed_from_u64(1000 + seed);
    let top = 1e6 * (Dry::MAXIMA_S[seed as usize % 3] + BEGINS_S);
    let on_pulse = top + 60.0 * (uniform(&mut rng) - 0.5);
    let anywhere = 40.0 + 1000.0 * uniform(&mut rng);
    let mut spikes = Vec::new();
    for (number, at) in [on_pulse, anywhere].into_iter().enumerate() {
        let count = 1 + (seed as usize + number) % 2;
        let sign = if (seed / 2).is_multiple_of(2) { 1.0 } else { -1.0 };
        let both = samples.iter_mut().enumerate().skip(at as usize);
        for (at, sample) in both.take(count) {
            *sample += sign * height;
            spikes.push(at);
        }
    }
    spikes.sort_unstable();
    spikes.dedup();
    (samples, spikes)
}

#[test]
fn spikes_of_one_or_two_samples_are_found_from_fifteen_deviations_of_noise_up() {
    for (noise, height) in [(1e-3, 0.015), (1e-3, 0.1), (1e-2, 0.15), (1e-2, 1.0), (1e-4, 3.0)] {
        for seed in 0..30 {
            let (samples, spikes) = spiked(noise, height, seed);
            let (repaired, found) = without_spikes(&samples);
            assert_eq!(found, spikes, "noise {noise}, height {height}, seed {seed}");
            // What neighbours say is about as good as a sample: within six deviations of both.
            let clean = record(1e-6, noise, seed);
            for at in found {
                let off = (repaired[at] - clean[at]).abs();
                assert!(off < 6.0 * 1.5 * noise, "noise {noise}, height {height}: {off}");
            }
        }
    }
}

#[test]
fn times_of_shots_with_spikes_are_as_right_as_stated_and_the_spikes_are_counted() {
    let exact = Dry::MAXIMA_S[1] - Dry::MAXIMA_S[0];
    let (mut squares, mut count) = (0.0, 0.0);
    // From half a deviation of noise to a third of the height.
    for height in [0.0015, 0.005, 0.015, 0.05, 0.3] {
        for seed in 0..30 {
            let (samples, _) = spiked(3e-3, height, seed);
            let channels = Channels::Summed(&samples);
            let Measured { found, flight, .. } =
                measure(channels, 1e-6, &SignalOptions::default()).unwrap();
            let incident = flight.unwrap().incident_s;
            let pull = (incident.value - exact) / incident.sigma;
            assert!(pull.abs() < 4.5, "height {height}, seed {seed}: {pull}");
            squares += pull * pull;
            count += 1.0;
            let spikes =
                found.flags.iter().any(|doubt| matches!(doubt, QualityFlag::Spikes(2..=4)));
            assert!(spikes || height < 0.04, "height {height}, seed {seed}: {:?}", found.flags);
        }
    }
    // Spikes too low to be found add to the noise: by a fifth at most. 150 pulls give 12 %.
    let deviation = f64::sqrt(squares / count);
    assert!((0.7..1.3).contains(&deviation), "{deviation}");
}
