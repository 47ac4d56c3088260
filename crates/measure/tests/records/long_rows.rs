//! Recordings in one row that is longer than memory should hold.

use crate::common::{folder, python};
use crate::formats::at_1_mhz;
use hertzchain_measure::MeasureError;
use hertzchain_measure::records::{Parts, ReadOptions, Rows, read};
use std::io::{Seek, SeekFrom, Write};
use std::path::Path;

/// Readings of one byte each, by their places in the file: all others are 0 and have no place on
/// the disk.
fn hollow(file: &Path, shape: (usize, usize), fortran: bool, readings: &[(usize, u8)]) {
    let order = if fortran { "True" } else { "False" };
    let mut head = format!(
        "{{'descr': '|i1', 'fortran_order': {order}, 'shape': ({}, {}), }}",
        shape.0, shape.1
    );
    // Magic, version, length and head fill 128 bytes.
    head = format!("{head:<117}\n");
    let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    bytes.extend(head.bytes());
    std::fs::write(file, &bytes).unwrap();
    let mut opened = std::fs::OpenOptions::new().write(true).open(file).unwrap();
    opened.set_len((bytes.len() + shape.0 * shape.1) as u64).unwrap();
    for (at, reading) in readings {
        let place = SeekFrom::Start((bytes.len() + at) as u64);
        opened.seek(place).unwrap();
        opened.write_all(&[*reading]).unwrap();
    }
}

/// More samples than a record may have.
const LONG: usize = (1 << 27) + 1;

#[test]
fn rows_too_long_for_memory_are_read_in_pieces() {
    let folder = folder("hollow");
    for rows in [1, 2] {
        hollow(&folder.join(format!("{rows}.npy")), (rows, LONG), false, &[]);
    }
    let mut names = vec!["1.npy", "2.npy"];
    let program = format!(
        "import h5py\nwith h5py.File('2.h5', 'w') as file:\n    \
         file.create_dataset('a', (2, {LONG}), 'i1', chunks=(1, 1 << 20))[1, -1] = 1\n"
    );
    names.extend(python(&folder, &program).map(|_| "2.h5"));
    for name in names {
        let file = folder.join(name);
        let whole = read(&file, &at_1_mhz()).next().unwrap().unwrap_err();
        assert!(whole.to_string().contains("--level"), "{name}: {whole}");
        let pieces = ReadOptions { parts: Parts::Pieces(1 << 20), ..at_1_mhz() };
        for (at, piece) in read(&file, &pieces).take(3).enumerate() {
            let piece = piece.unwrap();
            assert_eq!((piece.first_sample, piece.len()), ((at as u64) << 20, 1 << 20), "{name}");
        }
    }
    let shots = ReadOptions { parts: Parts::Shots(1000), ..at_1_mhz() };
    // Nothing but zeros is no shot, but it was read as one.
    let first = read(&folder.join("1.npy"), &shots).next().unwrap();
    let error = first.unwrap_err().to_string();
    assert!(error.contains("shot 1") && error.contains("1000"), "{error}");
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn channels_stored_one_after_the_other_are_read_in_pieces() {
    let folder = folder("planes");
    let file = folder.join("planes.npy");
    hollow(&file, (2, LONG), false, &[(5, 6), (LONG + 3, 7), (2 * LONG - 1, 8)]);
    let channels = |parts| ReadOptions { rows: Rows::Channels, parts, ..at_1_mhz() };
    let whole = read(&file, &channels(Parts::Whole)).next().unwrap();
    assert!(matches!(whole, Err(MeasureError::Samples(_, why)) if why.contains("more than")));
    let mut pieces = read(&file, &channels(Parts::Pieces(1 << 20)));
    let first = pieces.next().unwrap().unwrap();
    let of = |channel: usize, at: usize| first.channels[channel].volts[at];
    assert_eq!((of(0, 5), of(1, 3), of(1, 5)), (6.0, 7.0, 0.0));
    let second = pieces.next().unwrap().unwrap();
    assert_eq!((second.first_sample, second.shot), (1 << 20, None));
    let last = pieces.last().unwrap().unwrap();
    assert_eq!(last.first_sample + last.len() as u64, LONG as u64);
    assert_eq!(last.channels[1].volts.last(), Some(&8.0));
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn shots_of_which_samples_alternate_are_read_in_pieces() {
    let folder = folder("alternating");
    let file = folder.join("alternating.npy");
    // More numbers in all than are held together.
    let frames = (1 << 24) + 3;
    hollow(&file, (2, frames), true, &[(10, 6), (11, 7), (2 * frames - 1, 8)]);
    let pieces = ReadOptions { parts: Parts::Pieces(1 << 20), ..at_1_mhz() };
    let pieces = read(&file, &pieces).map(|piece| piece.unwrap());
    let reported = pieces.map(|piece| {
        let volts = piece.channels[0].volts.clone();
        let some: Vec<f64> = volts.into_iter().filter(|volt| *volt != 0.0).collect();
        (piece.shot.unwrap(), piece.first_sample, some)
    });
    let reported: Vec<_> = reported.filter(|(.., some)| !some.is_empty()).collect();
    let last = (1 << 24, vec![8.0]);
    assert_eq!(reported[0], (1, 0, vec![6.0]));
    assert_eq!(reported[1], (2, 0, vec![7.0]));
    assert_eq!(reported[2], (2, last.0, last.1));
    std::fs::remove_dir_all(&folder).unwrap();
}
