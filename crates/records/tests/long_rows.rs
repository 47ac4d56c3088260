//! Recordings in one row that is longer than memory should hold.

use crate::common::{folder, python};
use crate::formats::at_1_mhz;
use hertzchain_records::{Parts, ReadOptions, read};
use std::path::Path;

/// Bytes without a place on the disk, but for the last.
fn hollow(file: &Path, shape: (usize, usize)) {
    let mut head = format!(
        "{{'descr': '|i1', 'fortran_order': False, 'shape': ({}, {}), }}",
        shape.0, shape.1
    );
    // Magic, version, length and head fill 128 bytes.
    head = format!("{head:<117}\n");
    let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    bytes.extend(head.bytes());
    std::fs::write(file, &bytes).unwrap();
    let opened = std::fs::OpenOptions::new().write(true).open(file).unwrap();
    opened
        .set_len((bytes.len() + shape.0 * shape.1) as u64)
        .unwrap();
}

/// More samples than a record may have.
const LONG: usize = (1 << 27) + 1;

#[test]
fn rows_too_long_for_memory_are_read_in_pieces() {
    let folder = folder("hollow");
    for rows in [1, 2] {
        hollow(&folder.join(format!("{rows}.npy")), (rows, LONG));
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
        let pieces = ReadOptions {
            parts: Parts::Pieces(1 << 20),
            ..at_1_mhz()
        };
        for (at, piece) in read(&file, &pieces).take(3).enumerate() {
            let piece = piece.unwrap();
            assert_eq!(
                (piece.first_sample, piece.len()),
                ((at as u64) << 20, 1 << 20),
                "{name}"
            );
        }
    }
    let shots = ReadOptions {
        parts: Parts::Shots(1000),
        ..at_1_mhz()
    };
    // Nothing but zeros is no shot, but it was read as one.
    let first = read(&folder.join("1.npy"), &shots).next().unwrap();
    let error = first.unwrap_err().to_string();
    assert!(
        error.contains("shot 1") && error.contains("1000"),
        "{error}"
    );
    std::fs::remove_dir_all(&folder).unwrap();
}
