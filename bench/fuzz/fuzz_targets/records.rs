//! A recording of any format, whole, in shots and in pieces: the first byte chooses the ending and the
//! way it is read, the others are the file.
#![no_main]

use hertzchain_fuzz::with_file;
use hertzchain_measure::records::{Parts, ReadOptions, Rows, read};
use libfuzzer_sys::fuzz_target;

const ENDINGS: [&str; 8] = [".csv", ".txt", ".npy", ".npz", ".wav", ".tdms", ".mat", ".h5"];
const PARTS: [Parts; 3] = [Parts::Whole, Parts::Shots(100), Parts::Pieces(64)];
const ROWS: [Rows; 4] = [Rows::Auto, Rows::Shots, Rows::Channels, Rows::Times];
/// Records looked at: more are more of the same.
const MOST: usize = 50;

fuzz_target!(|bytes: &[u8]| {
    let Some((choice, file)) = bytes.split_first() else { return };
    let choice = usize::from(*choice);
    let options = ReadOptions {
        rate_hz: Some(1e6),
        parts: PARTS[choice / 8 % 3],
        rows: ROWS[choice / 24 % 4],
        ..ReadOptions::default()
    };
    with_file(ENDINGS[choice % 8], file, |path| {
        for record in read(path, &options).take(MOST) {
            match record {
                Ok(record) => assert!(record.channels.iter().all(|c| c.volts.len() == record.len())),
                Err(error) => assert!(!error.to_string().is_empty()),
            }
        }
    });
});
