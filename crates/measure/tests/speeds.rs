//! Files that determine the speeds of several shots: which shot gets which.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

use hertzchain_measure::records::{Parts, ReadOptions};
use hertzchain_measure::{Cut, Level, Measurement, Options, ShotList, measure};
use rust_hdf5::H5File;
use std::fs;
use std::path::{Path, PathBuf};
use std::slice::from_ref;

/// Samples of a shot with the quiet after it.
const EACH: usize = 30_000;

/// Three bells and a ripple, in counts.
fn shot() -> Vec<i16> {
    let bell = |at: f64, i: f64| ((i - at) / 35.0).cosh().powi(-4);
    let sample = |i: f64| {
        let pulses = bell(3000.0, i) + 1.6 * bell(3700.0, i) + 0.4 * bell(4410.0, i);
        (9000.0 * pulses + 9.0 * (1.7 * i).sin()) as i16
    };
    (0..EACH).map(|i| sample(i as f64)).collect()
}

/// As another program stores it: samples of this shape, sampling interval, speeds.
fn file(test: &str, samples: &[i16], shape: &[usize], speeds_m_s: &[f64]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("speeds");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{test}.h5"));
    let file = H5File::create(&path).unwrap();
    let counts = file.new_dataset::<i16>().shape(shape).create("counts");
    counts.unwrap().write_raw(samples).unwrap();
    for (name, numbers) in [("dt", &[1e-6][..]), ("speeds", speeds_m_s)] {
        let numbers_of = file.new_dataset::<f64>().shape([numbers.len()]);
        numbers_of.create(name).unwrap().write_raw(numbers).unwrap();
    }
    file.close_no_sync().unwrap();
    path
}

/// One row of three shots.
fn row(test: &str, speeds_m_s: &[f64]) -> PathBuf {
    file(test, &shot().repeat(3), &[3 * EACH], speeds_m_s)
}

/// The ways to cut a recording.
fn ways() -> [Options; 3] {
    let cutting = |cutting| Options { cutting, ..Options::default() };
    let level = Level { volts: 1000.0, samples: None };
    [
        cutting(Cut::Plain),
        cutting(Cut::Level(level)),
        Options {
            reading: ReadOptions { parts: Parts::Shots(EACH), ..ReadOptions::default() },
            ..Options::default()
        },
    ]
}

fn speeds_m_s(measured: &Measurement) -> Vec<Option<f64>> {
    let shots = measured.shots.iter();
    shots.map(|shot| Some(shot.speed_m_s?.value)).collect()
}

#[test]
fn every_shot_of_a_long_recording_gets_its_own_speed_however_it_is_cut() {
    let path = row("own", &[0.3, 0.5, 0.7]);
    for options in ways() {
        let measured = measure(from_ref(&path), &options, &());
        assert_eq!(speeds_m_s(&measured), [Some(0.3), Some(0.5), Some(0.7)]);
        assert!(measured.refused.is_empty(), "{:?}", measured.refused);
        assert_eq!(measured.examples[0].shot.speed_m_s, measured.shots[0].speed_m_s);
    }
}

#[test]
fn one_speed_is_that_of_all_shots_and_as_many_as_rows_are_those_of_rows() {
    for options in ways() {
        let one = measure(&[row("one", &[0.5])], &options, &());
        assert_eq!(speeds_m_s(&one), [Some(0.5); 3]);
        let rows = [shot(), shot()].concat();
        let rows = file("rows", &rows, &[2, EACH], &[0.3, 0.7]);
        let rows = measure(&[rows], &options, &());
        assert_eq!(speeds_m_s(&rows), [Some(0.3), Some(0.7)]);
    }
}

#[test]
fn speeds_that_are_not_as_many_as_shots_are_given_to_none_and_told() {
    let path = row("unlike", &[0.3, 0.5]);
    for mut options in ways() {
        let measured = measure(from_ref(&path), &options, &());
        assert_eq!(speeds_m_s(&measured), [None; 3]);
        assert_eq!(measured.refused.len(), 1, "{:?}", measured.refused);
        let why = measured.refused[0].to_string();
        assert!(why.contains("has 2 speeds, and 3 shots"), "{why}");
        let list = "file,shot,speed\nunlike.h5,1,0.2\nunlike.h5,2,0.4\nunlike.h5,3,0.6\n";
        options.list = Some(ShotList::parse(list).unwrap());
        let listed = measure(from_ref(&path), &options, &());
        assert_eq!(speeds_m_s(&listed), [Some(0.2), Some(0.4), Some(0.6)]);
        assert!(listed.refused.is_empty(), "{:?}", listed.refused);
    }
}

#[test]
fn a_bad_shot_among_shots_of_equal_length_takes_its_speed_along() {
    let samples = [shot(), vec![3; EACH], shot(), vec![3; EACH]].concat();
    let path = file("bad", &samples, &[4 * EACH], &[0.3, 0.5, 0.7, 0.9]);
    let measured = measure(&[path], &ways()[2], &());
    assert_eq!(speeds_m_s(&measured), [Some(0.3), Some(0.7)]);
    assert_eq!(measured.refused.len(), 2);
}
