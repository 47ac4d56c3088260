//! Sweeps over speed.

use hertzchain_experiment::preset;
use hertzchain_sim::{Rows, Settings, Stop, Sweep, parse_speeds, piece, sweep, sweep_each};
use std::sync::atomic::{AtomicUsize, Ordering};

fn hertz(accuracy: f64, speeds: &str) -> Sweep {
    let settings = Settings {
        adjust: &|plan| plan.accuracy = accuracy,
        ..Settings::default()
    };
    sweep(
        &preset("hertz").unwrap(),
        &parse_speeds(speeds).unwrap(),
        &settings,
    )
}

#[test]
fn hertz_tof_scales_as_speed_to_minus_one_fifth() {
    let swept = hertz(1e-11, "log:0.075:1.23:9");
    for fit in [swept.incident.unwrap(), swept.reflected.unwrap()] {
        // Ten times the accuracy asked of each time, over a factor of 16 in speed.
        assert!((fit.exponent + 0.2).abs() < 1e-10, "{}", fit.exponent);
        assert!(fit.largest_deviation() < 1e-10);
    }
}

#[test]
fn a_sweep_gives_the_same_bits_on_one_and_on_two_threads() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| hertz(1e-6, "0.1:1:5").flights())
    };
    assert_eq!(on(1), on(2));
}

#[test]
fn a_speed_that_fails_does_not_stop_the_others() {
    // At 1e-30 m/s the oil's Poisson ratio is beyond 1: the file can't have that speed.
    let pump = preset("pump").unwrap();
    let swept = sweep(&pump, &[0.5, 1e-30, 0.1], &Settings::default());
    assert_eq!(swept.points.len(), 3);
    assert!(swept.points[1].shot.is_err());
    assert_eq!(swept.flights().len(), 2);
    // Below 0.18 m/s it exceeds 1/2, which is worth a warning.
    assert!(swept.points[0].warnings.is_empty() && !swept.points[2].warnings.is_empty());
}

#[test]
fn progress_is_told_once_a_shot() {
    let count = AtomicUsize::new(0);
    let settings = Settings {
        progress: &|| {
            count.fetch_add(1, Ordering::Relaxed);
        },
        ..Settings::default()
    };
    let _ = sweep(&preset("hertz").unwrap(), &[0.5, 1.0, 2.0], &settings);
    assert_eq!(count.into_inner(), 3);
}

#[test]
fn what_is_broken_off_at_its_first_shot_has_planned_one_piece_of_many() {
    let stop = Stop::default();
    let planned = AtomicUsize::new(0);
    let settings = Settings {
        adjust: &|_| {
            planned.fetch_add(1, Ordering::Relaxed);
        },
        progress: &|| stop.ask(),
        ..Settings::default()
    };
    let experiment = preset("hertz").unwrap();
    let tiny = experiment.set(&[("beads[0].count", 7.0)]).unwrap();
    let pool = stop.pool(2).unwrap();
    let piece = pool.install(piece);
    let speeds: Vec<f64> = (1..=5 * piece).map(|at| 1e-3 * at as f64).collect();
    let mut handed = 0;
    pool.install(|| sweep_each(&tiny, &speeds, &settings, |_| handed += 1));
    // A stop can't take back what is planned together.
    assert_eq!((planned.into_inner(), handed), (piece, piece));
}

#[test]
fn points_handed_over_are_those_of_the_whole_sweep() {
    let hertz = preset("hertz").unwrap();
    let speeds = [0.3, -1.0, 0.7, 0.5];
    let whole = sweep(&hertz, &speeds, &Settings::default());
    let mut rows = Rows::default();
    let _ = sweep_each(&hertz, &speeds, &Settings::default(), |point| {
        rows.add(rows.len(), &point);
    });
    assert_eq!(rows.failed[0].place, 1);
    let bits = |rows: &Rows| {
        rows.columns
            .clone()
            .map(|of| of.iter().map(|v| v.to_bits()).collect::<Vec<_>>())
    };
    assert_eq!(bits(&rows), bits(&Rows::of(&whole.points)));
}
