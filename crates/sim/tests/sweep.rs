//! Sweeps over speed.

use hertzchain_experiment::preset;
use hertzchain_sim::{
    Batch, BatchOptions, BatchResult, BatchShot, Column, Shard, Stop, count_done, parse_speeds,
};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A batch that follows the striker.
fn batch(name: &str, speeds_m_s: Vec<f64>, accuracy: f64) -> Batch {
    let experiment = preset(name).unwrap();
    let options = BatchOptions { accuracy, rebound: true, ..BatchOptions::of(&experiment) };
    Batch::new(&experiment, speeds_m_s, options).unwrap()
}

fn hertz(accuracy: f64, speeds: &str) -> BatchResult {
    batch("hertz", parse_speeds(speeds).unwrap(), accuracy).run(Shard::WHOLE, &|| {})
}

#[test]
fn hertz_tof_scales_as_speed_to_minus_one_fifth() {
    let swept = hertz(1e-11, "log:0.075:1.23:9");
    for column in [Column::Incident, Column::Reflected] {
        let fit = swept.rows.law(column, swept.accuracy).0.unwrap();
        // Ten times the accuracy asked of each time, over a factor of 16 in speed.
        assert!((fit.exponent + 0.2).abs() < 1e-10, "{}", fit.exponent);
        assert!(fit.largest_deviation() < 1e-10);
    }
}

#[test]
fn a_sweep_gives_the_same_bits_on_one_and_on_two_threads() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| hertz(1e-6, "0.1:1:5").rows.flights())
    };
    assert_eq!(on(1), on(2));
}

#[test]
fn a_speed_that_fails_does_not_stop_the_others() {
    // At 1e-30 m/s the oil's Poisson ratio is beyond 1: the file can't have that speed.
    let pump = batch("pump", vec![0.5, 1e-30, 0.1], 1e-6);
    let mut points: Vec<BatchShot> = Vec::new();
    let (result, _) = pump.run_each(Shard::WHOLE, &|| {}, |point| points.push(point));
    assert_eq!(points.len(), 3);
    assert!(points[1].shot.is_err());
    assert_eq!(result.rows.failed[0].place, 1);
    assert_eq!(result.rows.flights().len(), 2);
    // Below 0.18 m/s it exceeds 1/2, which is worth a warning.
    assert!(points[0].warnings.is_empty() && !points[2].warnings.is_empty());
}

#[test]
fn progress_is_reported_once_a_shot() {
    let count = AtomicUsize::new(0);
    let progress = || {
        count.fetch_add(1, Ordering::Relaxed);
    };
    let _ = batch("hertz", vec![0.5, -1.0, 2.0], 1e-6).run(Shard::WHOLE, &progress);
    assert_eq!(count.into_inner(), 3);
}

#[test]
fn a_watched_request_reports_every_count_on_its_own_thread() {
    static SEEN: AtomicUsize = AtomicUsize::new(0);
    let stop = Stop::watched(|stop| {
        SEEN.fetch_max(stop.done() as usize, Ordering::Relaxed);
    });
    count_done(1);
    assert_eq!(SEEN.load(Ordering::Relaxed), 0);
    stop.adopt();
    count_done(2);
    count_done(3);
    assert_eq!(SEEN.load(Ordering::Relaxed), 5);
}

#[test]
fn a_batch_that_is_stopped_at_its_first_shot_hands_over_one_piece_of_many() {
    let stop = Stop::default();
    let experiment = preset("hertz").unwrap();
    let tiny = experiment.set(&[("beads[0].count", 7.0)]).unwrap();
    let pool = stop.pool(2).unwrap();
    // 256 a thread are in memory side by side.
    let piece = 512;
    let speeds: Vec<f64> = (1..=5 * piece).map(|at| 1e-3 * at as f64).collect();
    let batch = Batch::new(&tiny, speeds, BatchOptions::of(&tiny)).unwrap();
    let mut handed = 0;
    let _ = pool.install(|| batch.run_each(Shard::WHOLE, &|| stop.ask(), |_| handed += 1));
    // A stop can't take back what is planned together.
    assert_eq!(handed, piece);
}
