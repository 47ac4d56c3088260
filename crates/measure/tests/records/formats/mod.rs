//! Every format as another program writes it.

mod hdf5;
mod laboratory;
mod numpy;
mod text_and_tdms;
mod wav;

use hertzchain_measure::records::{ReadOptions, Record, read};
use std::path::Path;

/// Files that do not determine their rate.
pub fn at_1_mhz() -> ReadOptions {
    ReadOptions { rate_hz: Some(1e6), ..ReadOptions::default() }
}

pub fn all(path: &Path, options: &ReadOptions) -> Vec<Record> {
    read(path, options).map(|record| record.unwrap()).collect()
}

/// The signal that the scripts write: a wave that no two samples share.
pub fn wave(shot: usize, i: usize) -> f64 {
    ((i * 37 + shot * 11) % 101) as f64 / 128.0 - 0.25
}

/// The scripts' beginning.
pub const WAVE: &str = "
import numpy
def wave(shot, count=200):
    return ((numpy.arange(count) * 37 + shot * 11) % 101) / 128 - 0.25
";

pub fn assert_wave(record: &Record, channel: usize, shot: usize, scale: f64) {
    let volts = record.channels[channel].volts.clone();
    assert_eq!(volts.len(), 200, "{}", record.source);
    for (i, volt) in volts.iter().enumerate() {
        // All values are multiples of 1/128: exact in every format.
        assert_eq!(*volt * scale, wave(shot, i), "{}, sample {i}", record.source);
    }
}
