//! What is damaged is reported, once, and the rest is still read; nothing panics.

use crate::common::{folder, kept};
use hertzchain_measure::MeasureError;
use hertzchain_measure::records::{
    ReadOptions, Record, SeriesChannels, SeriesInfo, SeriesWriter, ShotRow, read,
};
use proptest::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

const KEPT: &[&str] = &[
    "shots.npy",
    "shots.npz",
    "shots.tdms",
    "both.wav",
    "oscilloscope.csv",
    "decimal-comma.csv",
    "segments.csv",
];

fn at_1_mhz() -> ReadOptions {
    ReadOptions { rate_hz: Some(1e6), ..ReadOptions::default() }
}

fn results(path: &Path) -> Vec<Result<Record, MeasureError>> {
    read(path, &at_1_mhz()).collect()
}

fn file(folder: &Path, name: &str, content: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, content).unwrap();
    path
}

fn only_error(path: &Path) -> String {
    let mut results = results(path);
    assert_eq!(results.len(), 1, "{results:?}");
    results.remove(0).unwrap_err().to_string()
}

#[test]
fn each_failing_is_one_clear_report() {
    let folder = folder("failings");
    let numbers = "1.5\n2.5\n0.5\n1.0\n";
    for (name, content, expected) in [
        ("empty.csv", "", "holds no samples"),
        ("prose.csv", "alas, poor Yorick\n", "no columns of numbers"),
        ("constant.csv", "2.5\n2.5\n2.5\n2.5\n", "all 4 samples in \"1\" are 2.5"),
        ("nan.csv", "1.5\nnan\n2.5\ninf\n", "2 of 4 samples in \"1\" are not finite"),
        ("bad.csv", "1.5\n2.5\n3.5\n-.-\n1.5\n2.5\n3.5\n1.5\n", "line 4 is no row of numbers"),
        ("lie.wav", numbers, "is called .wav but holds text"),
        ("lie.npy", numbers, "is called .npy but holds text"),
        (
            "times.csv",
            "t,a\n0,1.5\n1,2.5\n2,1.5\n4,2.5\n5,1.0\n6,3.5\n7,2.5\n8,1.5\n",
            "not evenly spaced",
        ),
        (
            "stops.csv",
            "1.5,2\n2.5,1\n3.5,2\n1.5,1\n2.5,2\n1.5,3\n0.5,2\n1.5,1\n2.5,2\n4.5",
            "line 10 stops in the middle",
        ),
        ("other.xyz", "\u{1}\u{2}\u{3}", "none of HDF5"),
    ] {
        let reported = only_error(&file(&folder, name, content));
        assert!(reported.contains(expected), "{name}: {reported}");
        assert!(reported.contains(name), "{name}: {reported}");
    }
    let header = folder.join("header.wav");
    fs::write(&header, &fs::read(kept("both.wav")).unwrap()[..20]).unwrap();
    let reported = only_error(&header);
    assert!(reported.contains("its header is not whole"), "{reported}");
    let missing = only_error(&folder.join("missing.csv"));
    assert!(missing.contains("cannot be read"), "{missing}");
    let renamed = folder.join("renamed.csv");
    fs::copy(kept("shots.npy"), &renamed).unwrap();
    assert!(only_error(&renamed).contains("holds a NumPy array"));
}

#[test]
fn a_missing_rate_and_a_wrong_one_are_told() {
    let open: Vec<_> = read(&kept("shots.npy"), &ReadOptions::default()).collect();
    assert!(
        matches!(&open[0], Err(MeasureError::Rate(_, why)) if why.contains("does not say how fast"))
    );
    let wrong = ReadOptions { rate_hz: Some(5e5), ..ReadOptions::default() };
    for name in ["shots.tdms", "both.wav", "oscilloscope.csv"] {
        let reported: Vec<_> = read(&kept(name), &wrong).collect();
        assert!(
            matches!(&reported[0], Err(MeasureError::Rate(_, why)) if why.contains("--trust-rate")),
            "{name}"
        );
    }
}

#[test]
fn what_was_taken_for_granted_is_told() {
    let folder = folder("granted");
    let rows = "0,1.5\n2,2.5\n4,0.5\n6,1.0\n";
    let file = |name: &str, content: String| file(&folder, name, &content);
    let bare = file("bare.csv", rows.to_owned());
    let titled = file("titled.csv", format!("t,a\n{rows}"));
    let notes = |path: &Path, options: &ReadOptions| {
        let mut records: Vec<_> = read(path, options).collect();
        records.remove(0).unwrap().notes
    };
    let open = ReadOptions::default();
    assert!(notes(&bare, &open)[0].contains("its first column names no unit"));
    assert!(notes(&titled, &open)[0].contains("\"t\" names no unit"));
    let reported = ReadOptions { time_unit_s: Some(1e-6), ..ReadOptions::default() };
    let record = read(&titled, &reported).next().unwrap().unwrap();
    assert_eq!((record.interval_s, record.notes.len()), (2e-6, 0));
    let unit = file("unit.csv", format!("t (us),a\n{rows}"));
    assert_eq!(notes(&unit, &open).len(), 0);
    let two = file("two.csv", "t (s),x,y\n0,1,2\n1,2,1\n2,1,3\n3,5,1\n".to_owned());
    let note = notes(&two, &open).remove(0);
    assert!(note.contains("\"x\" was taken for the sensor"), "{note}");
}

#[test]
fn a_jump_in_times_is_told_where_it_is() {
    let folder = folder("jump");
    let times = (0..100).map(|i| if i < 60 { i } else { i + 3 });
    let rows: String = times.map(|t| format!("{t},{}\n", t % 7)).collect();
    let path = file(&folder, "jump.csv", &format!("t (us),a\n{rows}"));
    let reported = only_error(&path);
    assert!(reported.contains("from sample 60, at 0.000059 s"), "{reported}");
    assert!(reported.contains("by 4.0000 µs where steps of 1.0000 µs"), "{reported}");
}

#[test]
fn good_segments_are_read_beside_bad_ones() {
    let folder = folder("beside");
    let good = "1.5\n2.5\n3.5\n4.5\n";
    let text = format!("{good}\n1.5\nwhat?\n2.5\n9.5\n\n{good}\n1.5\n2.5\n\n{good}");
    let results = results(&file(&folder, "mixed.csv", &text));
    let good: Vec<bool> = results.iter().map(Result::is_ok).collect();
    assert_eq!(good, [true, false, true, false, true]);
    let short = results[3].as_ref().unwrap_err().to_string();
    assert!(short.contains("has 2 samples where 4"), "{short}");
}

#[test]
fn a_truncated_recording_still_gives_its_whole_shots() {
    let folder = folder("truncated");
    let bytes = fs::read(kept("shots.npy")).unwrap();
    let path = folder.join("cut.npy");
    fs::write(&path, &bytes[..bytes.len() - 10]).unwrap();
    let good: Vec<bool> = results(&path).iter().map(Result::is_ok).collect();
    assert_eq!(good, [true, true, false]);
}

/// A small series, as bytes; written once for all tests.
fn series() -> Vec<u8> {
    static SERIES: OnceLock<Vec<u8>> = OnceLock::new();
    SERIES.get_or_init(written).clone()
}

fn written() -> Vec<u8> {
    let path = folder("fuzz-series").join("series.h5");
    let info = SeriesInfo {
        channels: SeriesChannels::Summed,
        interval_s: 1e-6,
        volts_per_count: 1e-3,
        offset_v: 0.0,
        pretrigger: 0,
        samples_per_shot: 50,
        series: 0,
        case: "dry".to_owned(),
        seed: 1,
        experiment: String::new(),
        long_names: &[],
        more: Vec::new(),
    };
    let mut writer = SeriesWriter::create(&path, &info).unwrap();
    for shot in 0..3 {
        let samples: Vec<i16> = (0..50).map(|i| i * 3 % 17).collect();
        let row = ShotRow {
            shot,
            programmed_speed_m_s: 1.0,
            measured_speed_m_s: 1.0,
            triggered: true,
            contacts: &[],
            samples: &samples,
            truth: &[("speed_m_s", 1.0)],
        };
        writer.push(&row).unwrap();
    }
    fs::read(writer.finish().unwrap()).unwrap()
}

/// A file of each format, by its ending.
fn originals() -> Vec<(String, Vec<u8>)> {
    let kept = KEPT.iter().map(|name| {
        let path = kept(name);
        let ending = path.extension().unwrap().to_str().unwrap().to_owned();
        (ending, fs::read(path).unwrap())
    });
    kept.chain([("h5".to_owned(), series())]).collect()
}

fn read_bytes(folder: &Path, ending: &str, bytes: &[u8]) {
    let path = folder.join(format!("any.{ending}"));
    fs::write(&path, bytes).unwrap();
    // More records than there are bytes would be out of nothing.
    let count = read(&path, &at_1_mhz()).take(bytes.len() + 2).count();
    assert!(count <= bytes.len() + 1);
}

#[test]
fn no_truncation_panics() {
    let folder = folder("truncations");
    for (ending, bytes) in originals() {
        for length in (0..bytes.len()).step_by(bytes.len() / 60 + 1) {
            read_bytes(&folder, &ending, &bytes[..length]);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200), kind in 0usize..8) {
        let folder = folder(&format!("bytes-{kind}"));
        let (ending, original) = &originals()[kind];
        read_bytes(&folder, ending, &bytes);
        // Behind a true beginning.
        let begin = original.len().min(40);
        read_bytes(&folder, ending, &[&original[..begin], &bytes].concat());
    }

    #[test]
    fn no_changed_byte_panics(at in 0.0..1.0f64, value: u8, run in 1usize..9, kind in 0usize..8) {
        let folder = folder(&format!("changed-{kind}"));
        let (ending, mut bytes) = originals().swap_remove(kind);
        let at = (at * bytes.len() as f64) as usize;
        bytes.iter_mut().skip(at).take(run).for_each(|byte| *byte = value);
        read_bytes(&folder, &ending, &bytes);
    }
}
