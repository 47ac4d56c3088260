//! What stands beside numbers: footers, times of day, columns that are shots.

use crate::common::folder;
use hertzchain_measure::MeasureError;
use hertzchain_measure::records::{ReadOptions, Record, Rows, read};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

const SAMPLES: usize = 400;

/// A text of times in s and volts, with this before and after its numbers.
fn text(name: &str, after: &str) -> PathBuf {
    let mut text = "time,volt\n".to_owned();
    for i in 0..SAMPLES {
        writeln!(text, "{:.6},{}", i as f64 * 1e-6, i % 7).unwrap();
    }
    let path = folder(name).join("record.csv");
    fs::write(&path, text + after).unwrap();
    path
}

fn results(path: &Path, options: &ReadOptions) -> Vec<Result<Record, MeasureError>> {
    read(path, options).collect()
}

#[test]
fn a_footer_is_noted_and_the_record_read() {
    let footers = [
        "# end\n",
        "End of file",
        "Mean: 3.2\n",
        "Mean,3.2\nStandard deviation,0.1\n",
        "\n# end\n",
        "\n\nsaved by a recorder\n",
    ];
    for (number, footer) in footers.into_iter().enumerate() {
        let path = text(&format!("footer-{number}"), footer);
        let found = results(&path, &ReadOptions::default());
        assert_eq!(found.len(), 1, "{footer:?}: {found:?}");
        let record = found[0].as_ref().unwrap();
        assert_eq!(record.len(), SAMPLES, "{footer:?}");
        let word = footer.trim().split(['\n', ',']).next().unwrap();
        let noted = record.notes.iter().any(|note| note.contains(word));
        assert!(noted, "{footer:?}: {:?}", record.notes);
    }
}

#[test]
fn words_among_the_numbers_and_rows_that_stop_refuse_the_record() {
    let after = "an interruption\n0.000400,1\n0.000401,2\n";
    let found = results(&text("among", after), &ReadOptions::default());
    assert!(found.len() == 1 && found[0].is_err(), "{found:?}");
    for broken in ["0.0004", "0.000400,1e-"] {
        let found = results(&text("stops", broken), &ReadOptions::default());
        let whole = found.iter().filter_map(|one| one.as_ref().ok());
        assert_eq!(whole.count(), 0, "{broken:?}: {found:?}");
    }
    // Pages of words are no footer.
    let found = results(&text("pages", &"words\n".repeat(20)), &ReadOptions::default());
    assert!(found.iter().any(Result::is_err), "{found:?}");
}

#[test]
fn a_footer_of_one_segment_leaves_the_next_alone() {
    let segment = |from: usize| -> String {
        let row = |i: usize| format!("{:.6},{}\n", i as f64 * 1e-6, (i + from) % 7);
        (0..SAMPLES).map(row).collect()
    };
    let path = folder("two-footers").join("two.csv");
    let whole = format!("time,volt\n{}# end\n\n{}# end\n", segment(0), segment(1));
    fs::write(&path, whole).unwrap();
    let found = results(&path, &ReadOptions::default());
    assert_eq!(found.len(), 2, "{found:?}");
    for record in found {
        assert_eq!(record.unwrap().len(), SAMPLES);
    }
}

/// A row of a stamp and a number.
type Row = fn(f64, usize) -> String;

const STAMPS: [(&str, char, Row); 4] = [
    ("iso", ',', |s, v| format!("2024-05-01 12:00:{s:09.6},{v}")),
    ("zone", ',', |s, v| format!("2024-05-01T23:59:{s:09.6}Z,{v}")),
    ("clock", ';', |s, v| format!("12:00:{s:09.6};{v}")),
    ("comma", ';', |s, v| format!("12:00:{s:09.6};0.{v}").replace('.', ",")),
];

#[test]
fn stamps_of_date_and_time_tell_the_interval() {
    for (name, delimiter, row) in STAMPS {
        for title in ["Time (HH:mm:ss)", "Timestamp"] {
            let mut text = format!("{title}{delimiter}volt\n");
            for i in 0..SAMPLES {
                text += &row(i as f64 * 2e-6, i % 7);
                text.push('\n');
            }
            let path = folder(&format!("stamps-{name}")).join("record.csv");
            fs::write(&path, text).unwrap();
            let found = results(&path, &ReadOptions::default());
            assert_eq!(found.len(), 1, "{name}: {found:?}");
            let record = found[0].as_ref().unwrap();
            let size = (record.len(), record.channels.len());
            assert_eq!(size, (SAMPLES, 1), "{name}");
            // Of 43,200 s double precision knows 7e-12 s, of a month 2e-10 s: over 399 steps
            // of 2 us less than 1e-6.
            let off = record.interval_s / 2e-6 - 1.0;
            assert!(off.abs() < 1e-6, "{name}: {off}");
        }
    }
}

/// An array of floats as numpy saves it, column by column or not.
fn npy(name: &str, (rows, columns): (usize, usize), fortran: bool) -> PathBuf {
    let order = if fortran { "True" } else { "False" };
    let mut header =
        format!("{{'descr': '<f8', 'fortran_order': {order}, 'shape': ({rows}, {columns}), }}");
    // With ten bytes before it and a newline behind a multiple of 64.
    while !(header.len() + 11).is_multiple_of(64) {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    bytes.extend(header.as_bytes());
    for at in 0..rows * columns {
        let (row, column) = match fortran {
            true => (at % rows, at / rows),
            false => (at / columns, at % columns),
        };
        bytes.extend(value(column, row).to_le_bytes());
    }
    let path = folder(name).join("table.npy");
    fs::write(&path, bytes).unwrap();
    path
}

fn value(column: usize, row: usize) -> f64 {
    ((37 * row + 11 * column) % 101) as f64
}

#[test]
fn many_columns_are_shots_and_few_only_if_told() {
    let rate = ReadOptions { rate_hz: Some(1e6), ..ReadOptions::default() };
    let reported = ReadOptions { rows: Rows::Moments, ..rate.clone() };
    for fortran in [false, true] {
        let path = npy("moments", (SAMPLES, 20), fortran);
        for options in [&rate, &reported] {
            let found = results(&path, options);
            assert_eq!(found.len(), 20, "{found:?}");
            for (shot, record) in found.into_iter().enumerate() {
                let record = record.unwrap();
                let expected: Vec<f64> = (0..SAMPLES).map(|row| value(shot, row)).collect();
                assert_eq!(record.channels[0].volts, expected);
                let noted = record.notes.iter().any(|n| n.contains("taken for a shot"));
                assert_eq!(noted, options.rows == Rows::Auto, "{:?}", record.notes);
            }
        }
        let third = ReadOptions { channels: vec!["3".to_owned()], ..rate.clone() };
        let found = results(&path, &third);
        assert_eq!(found.len(), 1);
        let volts = found[0].as_ref().unwrap().channels[0].volts.clone();
        assert_eq!(volts[1], value(2, 1));
        let few = npy("few", (SAMPLES, 5), fortran);
        let error = results(&few, &rate).remove(0).unwrap_err().to_string();
        assert!(error.contains("--rows moments"), "{error}");
        assert_eq!(results(&few, &reported).len(), 5);
    }
}
