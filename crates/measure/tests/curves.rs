//! Records into curves: what counts, what is left out, and in which order.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

use hertzchain_measure::records::{Channels, SeriesInfo, SeriesWriter, ShotRow};
use hertzchain_measure::{Curves, Grouping, Measurement, Options, ShotList, measure};
use hertzchain_signal::Doubt;
use std::fs;
use std::path::{Path, PathBuf};

/// Size of a count in V.
const COUNT_V: f64 = 1e-4;

fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("curves-{test}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Three bells and noise by a formula; heights in counts.
fn samples(incident: f64, height: f64, seed: u64) -> Vec<i16> {
    let bell = |at: f64, i: f64| ((i - at) / 35.0).cosh().powi(-4);
    let noise = |i: u64| ((i * 7919 + seed * 104_729 + i * i * 31) % 23) as f64 - 11.0;
    let sample = |i: u64| {
        let t = i as f64;
        let pulses = bell(500.0, t) + 1.6 * bell(500.0 + incident, t);
        let all = height * (pulses + 0.4 * bell(500.0 + 2.02 * incident, t)) + noise(i);
        all.clamp(-32_768.0, 32_767.0) as i16
    };
    (0..4000).map(sample).collect()
}

/// A series of five shots whose times of flight differ by 0.2 samples.
fn series(folder: &Path, case: &str, speed_m_s: f64, height: f64) -> PathBuf {
    let path = folder.join(format!("{case}-{speed_m_s}.h5"));
    let info = SeriesInfo {
        channels: Channels::Summed,
        interval_s: 1e-6,
        volts_per_count: COUNT_V,
        offset_v: 0.0,
        pretrigger: 0,
        samples_per_shot: 4000,
        series: 0,
        case: case.to_owned(),
        seed: 0,
        experiment: String::new(),
        more: vec![("measured_speed_error_m_s".to_owned(), "0.001".to_owned())],
    };
    let mut writer = SeriesWriter::create(&path, &info).unwrap();
    for shot in 0..5_u64 {
        let incident = 630.0 * speed_m_s.powf(-0.2) + 0.2 * (shot as f64 - 2.0);
        writer
            .push(&ShotRow {
                shot,
                programmed_speed_m_s: speed_m_s,
                measured_speed_m_s: speed_m_s + 0.02 * (shot as f64 - 2.0),
                samples: &samples(incident, height, shot),
                truth: &[],
            })
            .unwrap();
    }
    writer.finish().unwrap()
}

fn measured(files: &[PathBuf]) -> Measurement {
    measure(files, &Options::default(), &mut |_| {})
}

#[test]
fn shots_of_one_programmed_speed_are_one_row_with_mean_and_spread() {
    let folder = folder("row");
    let files = [0.2, 0.5, 1.0].map(|speed| series(&folder, "dry", speed, 9000.0));
    let measured = measured(&files);
    let curves = Curves::of(&measured.shots, &Grouping::default());
    let rows = &curves.cases[0].rows;
    assert_eq!(rows.len(), 3);
    for (row, speed) in rows.iter().zip([0.2_f64, 0.5, 1.0]) {
        assert_eq!(row.shots, (5, 0));
        // The five deviations of the speed cancel up to rounding.
        assert!((row.speed_m_s.value - speed).abs() < 1e-12);
        // The measured speeds' own error, not their spread.
        assert!((row.speed_m_s.sigma - 1e-3 / 5.0_f64.sqrt()).abs() < 1e-12);
        // Noise of 7 in 9000 moves a time by some 0.03 µs; five shots average.
        let expected_s = 630e-6 * speed.powf(-0.2);
        assert!((row.incident_s.mean - expected_s).abs() < 6e-8, "{row:?}");
        // 0.2 samples times the deviation of −2..=2, √2.5, and the noise.
        assert!(
            (row.incident_s.deviation - 0.316e-6).abs() < 1e-7,
            "{row:?}"
        );
    }
    let law = curves.cases[0].laws.incident.as_ref().unwrap();
    // Speeds are wrong by less than 1e-12 here; times by 1e-4 at most.
    assert!((law.exponent + 0.2).abs() < 2e-4, "{law:?}");
}

#[test]
fn clipped_shots_are_flagged_and_count_only_if_asked() {
    let folder = folder("clipped");
    let files = [series(&folder, "dry", 0.5, 30_000.0)];
    let measured = measured(&files);
    for shot in &measured.shots {
        let clipped = |doubt: &Doubt| matches!(doubt, Doubt::Saturation(_));
        assert!(shot.doubts.iter().any(clipped), "{}", shot.flags());
    }
    assert!(
        Curves::of(&measured.shots, &Grouping::default())
            .cases
            .is_empty()
    );
    let keep = Grouping {
        keep_dubious: true,
        ..Grouping::default()
    };
    assert_eq!(
        Curves::of(&measured.shots, &keep).cases[0].rows[0].shots.0,
        5
    );
}

#[test]
fn wet_is_held_against_dry_with_both_errors() {
    let folder = folder("ratio");
    let files = [
        series(&folder, "dry", 0.5, 9000.0),
        series(&folder, "pump", 0.5, 9000.0),
    ];
    let curves = Curves::of(&measured(&files).shots, &Grouping::default());
    let ratio = curves.ratios[0].incident[0];
    // The same series twice, to the last bit.
    assert_eq!(ratio.ratio.value, 1.0);
    let relative = |case: usize| {
        let row = &curves.cases[case].rows[0];
        let speed = 0.2 * row.speed_m_s.sigma / row.speed_m_s.value;
        (row.incident_s.error / row.incident_s.mean).hypot(speed)
    };
    // Rounding.
    assert!((ratio.ratio.sigma - relative(0).hypot(relative(1))).abs() < 1e-15);
}

#[test]
fn results_come_in_the_order_of_the_records_whatever_the_threads() {
    let folder = folder("order");
    let files = [0.2, 0.5].map(|speed| series(&folder, "dry", speed, 9000.0));
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| measured(&files).shots)
    };
    let one = on(1);
    let numbers: Vec<u64> = one.iter().filter_map(|shot| shot.shot).collect();
    assert_eq!(numbers, [0, 1, 2, 3, 4, 0, 1, 2, 3, 4]);
    assert_eq!(one, on(3));
}

#[test]
fn a_list_overrides_what_files_say() {
    let folder = folder("list");
    let files = [series(&folder, "dry", 0.5, 9000.0)];
    let list = "file,shot,case,speed,speed error\ndry-0.5.h5,3,gear,0.7,0.01\n";
    let options = Options {
        list: Some(ShotList::parse(list).unwrap()),
        ..Options::default()
    };
    let shots = measure(&files, &options, &mut |_| {}).shots;
    let third = shots[3].speed_m_s.unwrap();
    assert_eq!(
        (shots[3].case.as_str(), third.value, third.sigma),
        ("gear", 0.7, 0.01)
    );
    assert_eq!(shots[2].case, "dry");
}
