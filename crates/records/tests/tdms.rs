//! Parts of TDMS that LabVIEW writes and other writers do not, byte by byte
//! after the format's description by its maker.

use crate::common::folder;
use hertzchain_records::{ReadOptions, Record, RecordError, read};
use std::fs;

/// Flags of a segment: metadata, new list of objects, raw data.
const WHOLE: u32 = (1 << 1) | (1 << 2) | (1 << 3);
const INTERLEAVED: u32 = 1 << 5;
const BIG_ENDIAN: u32 = 1 << 6;

/// Numbers in one byte order.
struct Writer {
    big: bool,
    bytes: Vec<u8>,
}

impl Writer {
    fn put<const N: usize>(&mut self, mut little: [u8; N]) {
        if self.big {
            little.reverse();
        }
        self.bytes.extend(little);
    }

    fn text(&mut self, text: &str) {
        self.put((text.len() as u32).to_le_bytes());
        self.bytes.extend(text.as_bytes());
    }
}

/// A segment with two channels of 16 bits, three values a chunk each, and the
/// values as they are to be stored.
fn segment(flags: u32, values: &[i16]) -> Vec<u8> {
    let big = flags & BIG_ENDIAN != 0;
    let new = || Writer {
        big,
        bytes: Vec::new(),
    };
    let mut metadata = new();
    metadata.put(2_u32.to_le_bytes());
    for channel in ["/'rig'/'bead'", "/'rig'/'wall'"] {
        metadata.text(channel);
        metadata.put(20_u32.to_le_bytes());
        metadata.put(2_u32.to_le_bytes());
        metadata.put(1_u32.to_le_bytes());
        metadata.put(3_u64.to_le_bytes());
        metadata.put(1_u32.to_le_bytes());
        metadata.text("wf_increment");
        metadata.put(10_u32.to_le_bytes());
        metadata.put(1e-6_f64.to_le_bytes());
    }
    let mut raw = new();
    values.iter().for_each(|value| raw.put(value.to_le_bytes()));
    let mut lead = new();
    lead.put(4713_u32.to_le_bytes());
    lead.put(((metadata.bytes.len() + raw.bytes.len()) as u64).to_le_bytes());
    lead.put((metadata.bytes.len() as u64).to_le_bytes());
    let flags = flags.to_le_bytes().to_vec();
    [
        b"TDSm".to_vec(),
        flags,
        lead.bytes,
        metadata.bytes,
        raw.bytes,
    ]
    .concat()
}

fn records(test: &str, bytes: &[u8]) -> Vec<Result<Record, RecordError>> {
    let path = folder(test).join("rig.tdms");
    fs::write(&path, bytes).unwrap();
    read(&path, &ReadOptions::default()).collect()
}

fn channels(test: &str, bytes: &[u8]) -> [Vec<f64>; 2] {
    let record = records(test, bytes).remove(0).unwrap();
    assert_eq!(record.interval_s, 1e-6);
    [0, 1].map(|channel: usize| record.channels[channel].samples.volts())
}

const BEAD: [f64; 6] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
const WALL: [f64; 6] = [-1.0, -2.0, -3.0, -4.0, -5.0, -6.0];

#[test]
fn several_chunks_of_a_segment_are_joined() {
    let stored = [1, 2, 3, -1, -2, -3, 4, 5, 6, -4, -5, -6];
    assert_eq!(
        channels("chunks", &segment(WHOLE, &stored)),
        [BEAD.to_vec(), WALL.to_vec()]
    );
}

#[test]
fn interleaved_channels_come_apart() {
    let stored = [1, -1, 2, -2, 3, -3, 4, -4, 5, -5, 6, -6];
    let bytes = segment(WHOLE | INTERLEAVED, &stored);
    assert_eq!(
        channels("interleaved", &bytes),
        [BEAD.to_vec(), WALL.to_vec()]
    );
}

#[test]
fn big_endian_segments_are_read() {
    let stored = [1, 2, 3, -1, -2, -3, 4, 5, 6, -4, -5, -6];
    let bytes = segment(WHOLE | BIG_ENDIAN, &stored);
    assert_eq!(channels("big", &bytes), [BEAD.to_vec(), WALL.to_vec()]);
}

#[test]
fn a_file_that_was_not_closed_gives_its_whole_chunks_and_says_so() {
    let stored = [1, 2, 3, -1, -2, -3, 4, 5];
    let mut bytes = segment(WHOLE, &stored);
    // What LabVIEW leaves in place of the length until a segment is complete.
    bytes[12..20].fill(0xff);
    let results = records("open", &bytes);
    let first = results[0].as_ref().unwrap().channels[0].samples.volts();
    assert_eq!(first, BEAD[..3]);
    assert!(matches!(results[1], Err(RecordError::Truncated { .. })));
}
