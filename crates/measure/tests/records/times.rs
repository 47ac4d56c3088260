//! Times of few digits: what they leave open is reported, and nothing is refused for it.

use crate::common::folder;
use hertzchain_measure::records::{ReadOptions, Record, read};
use std::fs;
use std::path::{Path, PathBuf};

/// Samples of a segment.
const SAMPLES: usize = 4000;

/// A signal that is no time: neither constant nor even.
fn volt(i: usize) -> f64 {
    0.01 * ((i * 7919) % 23) as f64
}

/// Segments of a recording whose times are reported by `printed`.
fn written(
    folder: &Path,
    interval_s: f64,
    pre_trigger: usize,
    segments: usize,
    printed: impl Fn(f64) -> String,
) -> PathBuf {
    let mut text = "Time (s),A\n".to_owned();
    for i in (0..segments).flat_map(|_| 0..SAMPLES) {
        let time_s = (i as f64 - pre_trigger as f64) * interval_s;
        text += &format!("{},{:.2}\n", printed(time_s), volt(i));
    }
    let path = folder.join("times.csv");
    fs::write(&path, text).unwrap();
    path
}

/// So many digits in all, as a table program shows them: 1.23E-03.
fn of_digits(digits: usize) -> impl Fn(f64) -> String {
    move |time_s| format!("{time_s:.*e}", digits - 1)
}

fn all(path: &Path, options: &ReadOptions) -> Vec<Record> {
    read(path, options).map(Result::unwrap).collect()
}

/// The interval is within what is stated, and as close as the digits allow.
fn assert_told(record: &Record, interval_s: f64, unit_s: f64) {
    assert_eq!(record.len(), SAMPLES);
    let off_s = (record.interval_s - interval_s).abs();
    let steps = SAMPLES as f64 - 1.0;
    // An end of a uniform range is √3 of its standard deviations away.
    let stated_s = 3.0_f64.sqrt() * record.interval_error_s;
    let rounding_s = 1e-9 * interval_s;
    assert!(off_s <= stated_s + rounding_s, "{off_s:e} {stated_s:e}");
    assert!(stated_s <= 2.0 * unit_s / steps + rounding_s, "{stated_s:e}");
}

#[test]
fn no_number_of_digits_biases_the_interval_beyond_its_error() {
    let folder = folder("digits");
    for interval_s in [1e-6, 2e-6, 1.003e-6, 0.97531e-6] {
        for digits in 5..=9 {
            for (pre_trigger, segments) in [(0, 1), (400, 1), (400, 3)] {
                let printed = |time_s: f64| format!("{time_s:.digits$}");
                let path = written(&folder, interval_s, pre_trigger, segments, printed);
                let records = all(&path, &ReadOptions::default());
                assert_eq!(records.len(), segments);
                for record in &records {
                    assert_told(record, interval_s, 10.0_f64.powi(-(digits as i32)));
                }
            }
        }
    }
}

#[test]
fn digits_that_grow_with_the_time_shatter_no_recording() {
    let folder = folder("grown");
    for digits in 3..=6 {
        for (pre_trigger, segments) in [(0, 1), (400, 1), (400, 3)] {
            let path = written(&folder, 1e-6, pre_trigger, segments, of_digits(digits));
            let records = all(&path, &ReadOptions::default());
            assert_eq!(records.len(), segments, "{digits}");
            for record in &records {
                // The largest time is some ms: that of the fewest digits behind the point.
                assert_told(record, 1e-6, 10.0_f64.powi(-2 - digits as i32));
            }
        }
    }
}

#[test]
fn what_digits_leave_open_is_told_once_and_a_rate_ends_it() {
    let folder = folder("open");
    // No sample at a tie of rounding, which would determine more.
    let printed = |time_s: f64| format!("{:.5}", time_s + 0.3e-6);
    let path = written(&folder, 1e-6, 400, 3, printed);
    let notes: Vec<Vec<String>> =
        all(&path, &ReadOptions::default()).into_iter().map(|record| record.notes).collect();
    assert!(notes[0][0].contains("even only to 10 µs"), "{notes:?}");
    assert!(notes[0][0].contains("1000 kHz, the roundest"), "{notes:?}");
    assert!(notes[0][0].contains("--rate"), "{notes:?}");
    assert!(notes.iter().all(|of| *of == notes[0]), "{notes:?}");
    for trust_rate in [false, true] {
        let options = ReadOptions { rate_hz: Some(1e6), trust_rate, ..ReadOptions::default() };
        let records = all(&path, &options);
        assert_eq!(records.len(), 3);
        for record in records {
            assert_eq!(record.interval_s, 1e6_f64.recip());
            assert_eq!(record.interval_error_s, 0.0);
            assert_eq!(record.notes, Vec::<String>::new());
        }
    }
}

#[test]
fn digits_that_show_no_step_at_all_ask_for_a_rate() {
    let folder = folder("none");
    let path = written(&folder, 1e-6, 0, 1, |time_s| format!("{time_s:.1}"));
    let reported = read(&path, &ReadOptions::default()).next().unwrap();
    let reported = reported.unwrap_err();
    assert!(reported.to_string().contains("too coarse"), "{reported}");
    assert!(reported.to_string().contains("--rate"), "{reported}");
    let options = ReadOptions { rate_hz: Some(1e6), ..ReadOptions::default() };
    assert_eq!(all(&path, &options)[0].len(), SAMPLES);
}

#[test]
fn a_trusted_rate_makes_any_column_of_times_irrelevant() {
    let folder = folder("irrelevant");
    let path = folder.join("bad.csv");
    let bad: [(&str, &dyn Fn(usize) -> String); 4] = [
        ("jitters", &|i| format!("{}", (i * 7919) % 101)),
        ("stands still", &|_| "0".to_owned()),
        ("stops", &|i| format!("{}", i.min(900))),
        ("has holes", &|i| match i % 10 {
            3 => "########".to_owned(),
            _ => format!("{:e}", i as f64 * 2.7e-6),
        }),
    ];
    for (what, time) in bad {
        let rows: String = (0..SAMPLES).map(|i| format!("{},{:.2}\n", time(i), volt(i))).collect();
        fs::write(&path, "Time (s),A\n".to_owned() + &rows).unwrap();
        let options =
            ReadOptions { rate_hz: Some(1e6), trust_rate: true, ..ReadOptions::default() };
        let records = all(&path, &options);
        assert_eq!(records.len(), 1, "{what}");
        assert_eq!(records[0].len(), SAMPLES, "{what}");
        assert_eq!(records[0].interval_s, 1e6_f64.recip());
    }
}

#[test]
fn times_that_go_to_and_fro_are_told_once() {
    let folder = folder("fro");
    let path = folder.join("fro.csv");
    let jitter = |i: usize| (i * 7919) % 5 * 10;
    let rows: String =
        (0..SAMPLES).map(|i| format!("{},{:.2}\n", i + jitter(i), volt(i))).collect();
    fs::write(&path, "t (us),A\n".to_owned() + &rows).unwrap();
    let reported: Vec<_> = read(&path, &ReadOptions::default()).collect();
    assert_eq!(reported.len(), 1);
    let error = reported.into_iter().next().unwrap().unwrap_err();
    assert!(error.to_string().contains("not evenly spaced"), "{error}");
    assert!(error.to_string().contains("--trust-rate"), "{error}");
}

#[test]
fn numbered_titles_separate_segments() {
    let folder = folder("numbered");
    let path = folder.join("numbered.csv");
    let segment = |number: usize| {
        let rows = (0..SAMPLES).map(|i| format!("{i},{:.2}\n", volt(i)));
        format!("Segment {number}\nt (us),A\n{}", rows.collect::<String>())
    };
    fs::write(&path, (0..3).map(segment).collect::<String>()).unwrap();
    assert_eq!(all(&path, &ReadOptions::default()).len(), 3);
}

#[test]
fn times_without_a_title_are_told_from_a_signal_though_they_repeat() {
    let folder = folder("untitled");
    let path = folder.join("untitled.csv");
    for pre_trigger in [0.0, 400.0] {
        let rows: String = (0..SAMPLES)
            .map(|i| format!("{:.5},{:.2}\n", (i as f64 - pre_trigger) * 1e-6, volt(i)))
            .collect();
        fs::write(&path, rows).unwrap();
        let records = all(&path, &ReadOptions::default());
        assert_eq!((records.len(), records[0].channels.len()), (1, 1));
        assert_told(&records[0], 1e-6, 1e-5);
    }
}

#[test]
fn a_stated_interval_that_times_allow_counts_before_them() {
    let folder = folder("stated");
    let path = folder.join("scope.csv");
    let rows: String =
        (0..SAMPLES).map(|i| format!("{:.5},{:.2}\n", i as f64 * 1.0002e-6, volt(i))).collect();
    fs::write(&path, format!("Sample Interval,1.0002e-06\nTIME,CH1\n{rows}")).unwrap();
    let records = all(&path, &ReadOptions::default());
    assert_eq!((records[0].interval_s, records[0].interval_error_s), (1.0002e-6, 0.0));
}
