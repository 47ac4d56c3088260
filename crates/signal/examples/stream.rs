//! How fast a recording goes through trigger, conditioning and picking.
//!
//! `cargo run --release -p hertzchain-signal --example stream [SHOTS]`
//! makes a recording of i16 like a campaign's, 100,000 samples a shot at
//! 1 MS/s, and measures it in pieces of 1 MiB on two threads: one recording
//! each, as parts of a campaign are.

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use common::Scene;
use hertzchain_signal::{Channels, Cutter, Cutting, Measuring, Segment, Trigger, measure};

const SAMPLES_A_SHOT: usize = 100_000;
const PIECE: usize = 1 << 19;
const STEPS: f64 = 10_000.0;
const THREADS: usize = 2;

/// One shot as a 16-bit digitiser gives it, 50 dB above its noise.
fn shot(seed: u64) -> Vec<i16> {
    let scene = Scene {
        samples: SAMPLES_A_SHOT,
        noise: 3e-3,
        offset: 0.02,
        seed,
        ..Scene::default()
    };
    let digits = |x: &f64| (x * STEPS).round() as i16;
    scene.summed().iter().map(digits).collect()
}

/// Measures a segment; whether it gave both times of flight.
fn measured(segment: &Segment<'_, i16>, samples: &mut Vec<f64>, measuring: &Measuring) -> bool {
    samples.clear();
    samples.extend(segment.samples.iter().map(|x| f64::from(*x)));
    let shot = measure(Channels::Summed(samples), 1e-6, measuring);
    shot.is_ok_and(|shot| shot.flight.is_ok_and(|flight| flight.reflected_s.is_some()))
}

/// Shots measured out of a recording that repeats some shots.
fn read(recording: &[i16], times: usize, cutting: Cutting) -> usize {
    let measuring = Measuring::default();
    let mut samples = Vec::new();
    let mut good = 0;
    let Ok(mut cutter) = Cutter::new(cutting) else {
        return 0;
    };
    for _ in 0..times {
        for piece in recording.chunks(PIECE) {
            cutter.feed(piece, |segment| {
                good += usize::from(measured(&segment, &mut samples, &measuring));
            });
        }
    }
    good
}

fn time(name: &str, recording: &[i16], times: usize, cutting: Cutting) {
    let start = Instant::now();
    let good: usize = std::thread::scope(|scope| {
        let threads = (0..THREADS).map(|_| scope.spawn(|| read(recording, times, cutting)));
        let threads: Vec<_> = threads.collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap_or(0))
            .sum()
    });
    let seconds = start.elapsed().as_secs_f64();
    let bytes = (THREADS * times * recording.len() * size_of::<i16>()) as f64;
    let rate = bytes / seconds / 1e6;
    println!("{name}: {good} shots in {seconds:.2} s, {rate:.0} MB/s on {THREADS} threads");
}

fn main() {
    let shots = std::env::args().nth(1).and_then(|text| text.parse().ok());
    let shots: usize = shots.unwrap_or(2000);
    let recording: Vec<i16> = (0..20).flat_map(shot).collect();
    let times = shots.div_ceil(20 * THREADS);
    let fixed = Cutting::Fixed {
        length: SAMPLES_A_SHOT,
    };
    let level = Cutting::Level(Trigger {
        level: 0.3 * STEPS,
        falling: false,
        hysteresis: 0.1 * STEPS,
        before: 500,
        length: 90_000,
        hold_off: 0,
    });
    time("segments of equal length", &recording, times, fixed);
    time("level trigger", &recording, times, level);
}
