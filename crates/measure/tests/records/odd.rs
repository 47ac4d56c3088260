//! What other programs write besides plain files: other letters, marks between thousands,
//! cells without a number, times among samples.

use crate::common::folder;
use hertzchain_measure::MeasureError;
use hertzchain_measure::records::{ReadOptions, Record, read};
use std::fs;
use std::path::{Path, PathBuf};

/// A signal that is no time.
fn volt(i: usize) -> f64 {
    0.01 * ((i * 7919) % 23) as f64
}

/// A thousand rows of times in ms and volts.
fn text() -> String {
    let row = |i: usize| format!("{:.3}\t{:.2}\n", i as f64 * 2e-3, volt(i));
    "Time (ms)\tµV\n".to_owned() + &(0..1000).map(row).collect::<String>()
}

fn written(folder: &Path, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, bytes).unwrap();
    path
}

fn only(path: &Path, options: &ReadOptions) -> Record {
    let mut records: Vec<Record> = read(path, options).map(Result::unwrap).collect();
    assert_eq!(records.len(), 1, "{}", path.display());
    records.remove(0)
}

fn assert_volts(record: &Record, channel: usize, count: usize) {
    let volts = record.channels[channel].volts.clone();
    assert_eq!(volts.len(), count);
    for (i, v) in volts.iter().enumerate() {
        assert!((v - volt(i)).abs() < 1e-12, "{i}: {v}");
    }
}

#[test]
fn utf_16_and_any_end_of_line_are_read_alike() {
    let folder = folder("letters");
    let text = text();
    let units = || text.encode_utf16();
    let marked = |mark: &[u8], bytes: Vec<u8>| [mark, &bytes].concat();
    let little: Vec<u8> = units().flat_map(u16::to_le_bytes).collect();
    let big: Vec<u8> = units().flat_map(u16::to_be_bytes).collect();
    for (name, bytes) in [
        ("little.csv", marked(b"\xff\xfe", little.clone())),
        ("big.txt", marked(b"\xfe\xff", big)),
        ("unmarked.csv", little),
        ("latin.csv", text.chars().map(|c| c as u8).collect()),
        ("cr.csv", text.replace('\n', "\r").into_bytes()),
        ("crlf.csv", text.replace('\n', "\r\n").into_bytes()),
        ("crcrlf.csv", text.replace('\n', "\r\r\n").into_bytes()),
    ] {
        let record = only(&written(&folder, name, bytes), &ReadOptions::default());
        assert_volts(&record, 0, 1000);
        assert_eq!(record.channels[0].name, "µV", "{name}");
        // Rounding of the file's digits.
        assert!((record.interval_s - 2e-6).abs() < 1e-18, "{name}");
    }
}

#[test]
fn segments_apart_by_empty_lines_stay_so_with_cr_alone() {
    let folder = folder("segments-cr");
    let block = "1.5\r2.5\r0.5\r1.0\r";
    let path = written(&folder, "segments.csv", format!("{block}\r{block}\r\r{block}"));
    let options = ReadOptions { rate_hz: Some(1e6), ..ReadOptions::default() };
    assert_eq!(read(&path, &options).map(Result::unwrap).count(), 3);
}

#[test]
fn marks_between_thousands_are_no_obstacle() {
    let folder = folder("thousands");
    let german = |i: usize| {
        let millivolts = 1000.0 * volt(i) + 1000.0;
        let (whole, rest) = (millivolts.floor(), (millivolts.fract() * 10.0).round());
        let whole = whole as usize;
        format!("{};{}.{:03},{rest:.0}\n", i * 2, whole / 1000, whole % 1000)
    };
    let rows: String = (0..500).map(german).collect();
    let path = written(&folder, "german.csv", format!("t (us);U (mV)\n{rows}"));
    let record = only(&path, &ReadOptions::default());
    let volts = record.channels[0].volts.clone();
    for (i, v) in volts.iter().enumerate() {
        // Rounding of tenths.
        assert!((v - volt(i) - 1.0).abs() < 1e-12, "{i}: {v}");
    }
}

/// A thousand rows with other cells in the places of some numbers.
fn with_cells(cells: &[(usize, &str)]) -> String {
    let row = |i: usize| {
        let cell = cells.iter().find(|(at, _)| *at == i);
        let volt = cell.map_or(format!("{:.2}", volt(i)), |(_, cell)| (*cell).to_owned());
        format!("{i},{volt}\n")
    };
    "t (us),U\n".to_owned() + &(0..1000).map(row).collect::<String>()
}

/// Ends of its gaps.
fn gaps(record: &Record) -> Vec<(usize, usize)> {
    record.gaps.iter().map(|gap| (gap.start, gap.end)).collect()
}

#[test]
fn single_cells_without_a_number_are_gaps_and_refuse_nothing() {
    let folder = folder("cells");
    let cells = [(200, "OVERLOAD"), (300, "NaN"), (301, ""), (400, "-inf"), (999, "#N/A")];
    let record = only(&written(&folder, "cells.csv", with_cells(&cells)), &ReadOptions::default());
    assert_eq!(gaps(&record), [(200, 201), (300, 302), (400, 401), (999, 1000)]);
    let volts = record.channels[0].volts.clone();
    assert_eq!((volts[200], volts[400]), (0.22, 0.0));
    let between = volt(299) + (volt(302) - volt(299)) / 3.0;
    assert!((volts[300] - between).abs() < 1e-12);
    assert_eq!(volts[999], volts[998]);
    // Other words are mistakes, as ever.
    let wrong = written(&folder, "wrong.csv", with_cells(&[(200, "what?")]));
    let reported = read(&wrong, &ReadOptions::default()).next().unwrap().unwrap_err();
    assert!(reported.to_string().contains("line 202 is no row"), "{reported}");
}

#[test]
fn gaps_go_with_the_parts_of_a_recording() {
    let folder = folder("gap-parts");
    let path = written(&folder, "cells.csv", with_cells(&[(499, "nan"), (500, "nan")]));
    let options = ReadOptions {
        parts: hertzchain_measure::records::Parts::Shots(500),
        ..ReadOptions::default()
    };
    let parts: Vec<_> = read(&path, &options).map(|r| gaps(&r.unwrap())).collect();
    assert_eq!(parts, [[(499, 500)], [(0, 1)]]);
    let whole = only(&path, &ReadOptions::default());
    assert_eq!(gaps(&whole.part(400, 300)), [(99, 101)]);
    assert_eq!(gaps(&whole.part(0, 300)), []);
}

/// A NumPy array of doubles.
fn npy(shape: &str, fortran: &str, values: impl Iterator<Item = f64>) -> Vec<u8> {
    let mut header = format!("{{'descr': '<f8', 'fortran_order': {fortran}, 'shape': {shape}, }}");
    while (header.len() + 11) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    let mut bytes = [b"\x93NUMPY\x01\x00".as_slice(), &length, header.as_bytes()].concat();
    bytes.extend(values.flat_map(f64::to_le_bytes));
    bytes
}

#[test]
fn times_in_an_array_are_no_channel() {
    let folder = folder("array-times");
    let time = |i: usize| i as f64 * 2e-6 - 1e-3;
    let rows = || (0..900).flat_map(|i| [time(i), volt(i)]);
    let columns = || (0..900).map(time).chain((0..900).map(volt));
    for (name, bytes) in [
        ("columns.npy", npy("(900, 2)", "False", rows())),
        ("fortran.npy", npy("(900, 2)", "True", columns())),
        ("rows.npy", npy("(2, 900)", "False", columns())),
    ] {
        let path = written(&folder, name, bytes);
        let record = only(&path, &ReadOptions::default());
        assert_eq!(record.channels.len(), 1, "{name}");
        assert_volts(&record, 0, 900);
        // Rounding of sums.
        assert!((record.interval_s - 2e-6).abs() < 1e-15, "{name}");
        assert!(record.notes[0].contains("taken as times in s"), "{:?}", record.notes);
        let asked = ReadOptions {
            channels: vec!["1".to_owned()],
            rate_hz: Some(5e5),
            rows: hertzchain_measure::records::Rows::Channels,
            ..ReadOptions::default()
        };
        if name == "rows.npy" {
            let times = only(&path, &asked).channels.remove(0);
            assert_eq!(times.volts[0], -1e-3);
        }
    }
    let three = (0..900).flat_map(|i| [time(i), volt(i), volt(i + 1)]);
    let path = written(&folder, "three.npy", npy("(900, 3)", "False", three));
    let record = only(&path, &ReadOptions::default());
    assert_eq!(record.channels.len(), 2);
    assert_volts(&record, 0, 900);
    let counts = (0..900).flat_map(|i| [i as f64, volt(i)]);
    let path = written(&folder, "counts.npy", npy("(900, 2)", "False", counts));
    let reported = read(&path, &ReadOptions::default()).next().unwrap();
    assert!(
        matches!(reported, Err(MeasureError::Rate(_, why)) if why.contains("does not say how fast"))
    );
}

#[test]
fn two_channels_of_an_array_are_still_two_channels() {
    let folder = folder("array-channels");
    let rows = (0..900).flat_map(|i| [volt(i), volt(i + 3)]);
    let path = written(&folder, "two.npy", npy("(900, 2)", "False", rows));
    let options = ReadOptions { rate_hz: Some(1e6), ..ReadOptions::default() };
    assert_eq!(only(&path, &options).channels.len(), 2);
}

#[test]
fn a_single_number_that_is_none_is_a_gap_in_an_array_too() {
    let folder = folder("array-gap");
    let values = (0..900).map(|i| if i == 77 { f64::NAN } else { volt(i) });
    let path = written(&folder, "gap.npy", npy("(900,)", "False", values));
    let options = ReadOptions { rate_hz: Some(1e6), ..ReadOptions::default() };
    assert_eq!(gaps(&only(&path, &options)), [(77, 78)]);
}

#[test]
fn half_an_array_is_told_as_such_before_a_rate_is_asked_for() {
    let folder = folder("half");
    let mut bytes = npy("(900,)", "False", (0..900).map(volt));
    bytes.truncate(bytes.len() - 4000);
    let path = written(&folder, "half.npy", bytes);
    let reported = read(&path, &ReadOptions::default()).next().unwrap().unwrap_err();
    assert!(matches!(reported, MeasureError::Truncated(..)), "{reported}");
    assert!(reported.to_string().contains("3200 of 7200 bytes"), "{reported}");
}

#[test]
fn arrays_of_three_axes_are_read_in_either_order() {
    let folder = folder("cubes");
    let value = |shot: usize, channel: usize, at: usize| volt(at + 3 * channel + 7 * shot);
    let rows = (0..2).flat_map(|shot| (0..2).map(move |channel| (shot, channel)));
    let rows = rows.flat_map(|(shot, channel)| (0..900).map(move |at| value(shot, channel, at)));
    let columns = (0..900).flat_map(|at| [(0, 0, at), (1, 0, at), (0, 1, at), (1, 1, at)]);
    let columns = columns.map(|(shot, channel, at)| value(shot, channel, at));
    let options = ReadOptions { rate_hz: Some(1e6), ..ReadOptions::default() };
    let shape = "(2, 2, 900)";
    for bytes in [npy(shape, "False", rows), npy(shape, "True", columns)] {
        let path = written(&folder, "cube.npy", bytes);
        let records: Vec<Record> = read(&path, &options).map(Result::unwrap).collect();
        assert_eq!(records.len(), 2);
        for (shot, record) in records.iter().enumerate() {
            for (channel, found) in record.channels.iter().enumerate() {
                let expected = (0..900).map(|at| value(shot, channel, at));
                assert!(found.volts.iter().copied().eq(expected), "{shot} {channel}");
            }
        }
    }
}

#[test]
fn lost_samples_in_a_pulse_are_gaps_and_flat_tops_and_quiet_are_none() {
    let folder = folder("dropouts");
    let bell = |i: usize| {
        let u = (i as f64 - 500.0) / 20.0;
        (1.0 - u * u / 4.0).max(0.0) + 1e-3 * volt(i)
    };
    let text = |sample: &dyn Fn(usize) -> f64| {
        (0..1000).map(|i| format!("{}\n", sample(i))).collect::<String>()
    };
    let lost = |i: usize| if (502..508).contains(&i) { 0.0 } else { bell(i) };
    let clipped = |i: usize| bell(i).min(0.8);
    let options = ReadOptions { rate_hz: Some(1e6), ..ReadOptions::default() };
    let of = |name, sample: &dyn Fn(usize) -> f64| {
        gaps(&only(&written(&folder, name, text(sample)), &options))
    };
    assert_eq!(of("lost.csv", &lost), [(502, 508)]);
    assert_eq!(of("clipped.csv", &clipped), []);
    assert_eq!(of("whole.csv", &bell), []);
    // Three samples across, clipped; a square; a digitiser that goes up and down by one step.
    let narrow = |i: usize| (-0.5 * (i as f64 - 500.0).powi(2)).exp().min(0.58) + 1e-4 * volt(i);
    let square = |i: usize| f64::from(u8::from((500..520).contains(&i)));
    let stepped = |i: usize| f64::from(u8::from(i % 5 > 1));
    assert_eq!(of("narrow.csv", &narrow), []);
    assert_eq!(of("square.csv", &square), []);
    assert_eq!(of("stepped.csv", &stepped), []);
}
