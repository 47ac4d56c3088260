//! Parts of TDMS that LabVIEW writes and other writers do not, byte by byte
//! after the format's description by its maker.

use crate::common::{folder, python};
use hertzchain_measure::MeasureError;
use hertzchain_measure::records::{ReadOptions, Record, read};
use std::fs;

/// Flags of a segment: metadata, new list of objects, raw data.
const WHOLE: u32 = (1 << 1) | (1 << 2) | (1 << 3);
const INTERLEAVED: u32 = 1 << 5;
const BIG_ENDIAN: u32 = 1 << 6;
/// Samples in the rows of DAQ cards.
const CARDS: u32 = 1 << 7;

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
    let new = || Writer { big, bytes: Vec::new() };
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
    with_lead(flags, &metadata, values)
}

/// A segment's lead-in, metadata and values.
fn with_lead(flags: u32, metadata: &Writer, values: &[i16]) -> Vec<u8> {
    let big = metadata.big;
    let new = || Writer { big, bytes: Vec::new() };
    let mut raw = new();
    values.iter().for_each(|value| raw.put(value.to_le_bytes()));
    let mut lead = new();
    lead.put(4713_u32.to_le_bytes());
    lead.put(((metadata.bytes.len() + raw.bytes.len()) as u64).to_le_bytes());
    lead.put((metadata.bytes.len() as u64).to_le_bytes());
    let flags = flags.to_le_bytes().to_vec();
    [b"TDSm".to_vec(), flags, lead.bytes, metadata.bytes.clone(), raw.bytes].concat()
}

impl Writer {
    fn number(&mut self, name: &str, value: f64) {
        self.text(name);
        self.put(10_u32.to_le_bytes());
        self.put(value.to_le_bytes());
    }

    fn whole(&mut self, name: &str, value: u32) {
        self.text(name);
        self.put(7_u32.to_le_bytes());
        self.put(value.to_le_bytes());
    }

    fn word(&mut self, name: &str, value: &str) {
        self.text(name);
        self.put(0x20_u32.to_le_bytes());
        self.text(value);
    }

    /// A channel of 16-bit readings, three a chunk, `within` bytes from the beginning of
    /// a row of a card; rows of the cards have four and two bytes.
    fn on_card(&mut self, path: &str, card: u32, within: u32) {
        self.text(path);
        // Readings of inputs; no type; one axis; three values; one place.
        for number in [0x1269, u32::MAX, 1, 3, 0, 1] {
            self.put(u32::to_le_bytes(number));
        }
        // A reading of 16 bits with sign, and the scale that it goes to.
        for number in [3, card, within, 0, 0] {
            self.put(u32::to_le_bytes(number));
        }
        for number in [2, 4, 2] {
            self.put(u32::to_le_bytes(number));
        }
    }

    /// What a straight line makes volts of.
    fn linear(&mut self) {
        self.put(7_u32.to_le_bytes());
        self.word("unit_string", "mV");
        self.number("wf_increment", 2e-6);
        self.whole("NI_Number_Of_Scales", 2);
        self.word("NI_Scale[1]_Scale_Type", "Linear");
        self.number("NI_Scale[1]_Linear_Slope", 0.5);
        self.number("NI_Scale[1]_Linear_Y_Intercept", 1.0);
        self.whole("NI_Scale[1]_Linear_Input_Source", 0);
    }

    /// A card's polynomial, and a sensor's line after it.
    fn curved(&mut self) {
        self.put(12_u32.to_le_bytes());
        self.word("NI_Scaling_Status", "unscaled");
        self.whole("NI_Number_Of_Scales", 3);
        self.word("NI_Scale[1]_Scale_Type", "Polynomial");
        self.whole("NI_Scale[1]_Polynomial_Coefficients_Size", 3);
        for (power, coefficient) in [1.0, 0.5, 0.25].iter().enumerate() {
            let name = format!("NI_Scale[1]_Polynomial_Coefficients[{power}]");
            self.number(&name, *coefficient);
        }
        self.whole("NI_Scale[1]_Polynomial_Input_Source", 0);
        self.word("NI_Scale[2]_Scale_Type", "Linear");
        self.number("NI_Scale[2]_Linear_Slope", 2.0);
        self.number("NI_Scale[2]_Linear_Y_Intercept", -1.0);
        self.whole("NI_Scale[2]_Linear_Input_Source", 1);
    }
}

/// Two chunks of what two DAQ cards logged: two inputs on one, one on the other.
fn cards() -> Vec<u8> {
    let mut metadata = Writer { big: false, bytes: Vec::new() };
    metadata.put(3_u32.to_le_bytes());
    metadata.on_card("/'rig'/'bead'", 0, 2);
    metadata.linear();
    metadata.on_card("/'rig'/'gate'", 0, 0);
    metadata.put(0_u32.to_le_bytes());
    metadata.on_card("/'rig'/'wall'", 1, 0);
    metadata.curved();
    // Rows of the first card are gate and bead, those of the second the wall.
    let stored = [
        7, 1, 8, 2, 9, 3, -1, -2, -3, //
        7, 4, 8, 5, 9, 6, -4, -5, -6,
    ];
    with_lead(WHOLE | INTERLEAVED | CARDS, &metadata, &stored)
}

fn volts_of_cards() -> [Vec<f64>; 2] {
    let line = |x: f64| 0.5 * x + 1.0;
    let curve = |x: f64| 2.0 * (1.0 + 0.5 * x + 0.25 * x * x) - 1.0;
    [BEAD.map(line).to_vec(), WALL.map(curve).to_vec()]
}

#[test]
fn what_daq_cards_logged_is_read_and_scaled() {
    let path = folder("cards").join("rig.tdms");
    fs::write(&path, cards()).unwrap();
    let options = ReadOptions {
        channels: vec!["bead".to_owned(), "wall".to_owned()],
        ..ReadOptions::default()
    };
    let records: Vec<_> = read(&path, &options).collect();
    let record = records[0].as_ref().unwrap();
    assert_eq!(record.interval_s, 2e-6);
    let [bead_mv, wall_v] = volts_of_cards();
    let near = |(volts, millivolts): (&f64, &f64)| (volts - 1e-3 * millivolts).abs() < 1e-15;
    assert!(record.channels[0].volts.iter().zip(&bead_mv).all(near));
    // Halves and quarters are exact.
    assert_eq!(record.channels[1].volts, wall_v);
}

#[test]
fn nptdms_reads_the_same_of_daq_cards() {
    let folder = folder("cards-elsewhere");
    fs::write(folder.join("rig.tdms"), cards()).unwrap();
    let program = "
from nptdms import TdmsFile
group = TdmsFile.read('rig.tdms')['rig']
for name in ('bead', 'wall'):
    print(' '.join(repr(float(x)) for x in group[name][:]))
";
    let Some(printed) = python(&folder, program) else {
        return;
    };
    let numbers = |line: &str| -> Vec<f64> {
        let words = line.split_whitespace();
        words.map(|word| word.parse().unwrap()).collect()
    };
    let found: Vec<Vec<f64>> = printed.trim().lines().map(numbers).collect();
    assert_eq!(found, volts_of_cards());
}

#[test]
fn a_scale_that_is_no_polynomial_is_named_and_the_other_channels_are_read() {
    let bytes = cards();
    let at = bytes.windows(10).position(|part| part == b"Polynomial").unwrap();
    let mut bytes = bytes;
    bytes[at..at + 10].copy_from_slice(b"Thermistor");
    let path = folder("thermistor").join("rig.tdms");
    fs::write(&path, bytes).unwrap();
    let reported = |channel: &str| ReadOptions {
        channels: vec![channel.to_owned()],
        ..ReadOptions::default()
    };
    let wall: Vec<_> = read(&path, &reported("wall")).collect();
    let refused = wall[0].as_ref().unwrap_err().to_string();
    assert!(refused.contains("Thermistor") && refused.contains("scaled values"), "{refused}");
    assert!(read(&path, &reported("bead")).all(|record| record.is_ok()));
}

fn records(test: &str, bytes: &[u8]) -> Vec<Result<Record, MeasureError>> {
    let path = folder(test).join("rig.tdms");
    fs::write(&path, bytes).unwrap();
    read(&path, &ReadOptions::default()).collect()
}

fn channels(test: &str, bytes: &[u8]) -> [Vec<f64>; 2] {
    let record = records(test, bytes).remove(0).unwrap();
    assert_eq!(record.interval_s, 1e-6);
    [0, 1].map(|channel: usize| record.channels[channel].volts.clone())
}

const BEAD: [f64; 6] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
const WALL: [f64; 6] = [-1.0, -2.0, -3.0, -4.0, -5.0, -6.0];

#[test]
fn several_chunks_of_a_segment_are_joined() {
    let stored = [1, 2, 3, -1, -2, -3, 4, 5, 6, -4, -5, -6];
    assert_eq!(channels("chunks", &segment(WHOLE, &stored)), [BEAD.to_vec(), WALL.to_vec()]);
}

#[test]
fn interleaved_channels_come_apart() {
    let stored = [1, -1, 2, -2, 3, -3, 4, -4, 5, -5, 6, -6];
    let bytes = segment(WHOLE | INTERLEAVED, &stored);
    assert_eq!(channels("interleaved", &bytes), [BEAD.to_vec(), WALL.to_vec()]);
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
    let first = results[0].as_ref().unwrap().channels[0].volts.clone();
    assert_eq!(first, BEAD[..3]);
    assert!(matches!(results[1], Err(MeasureError::Truncated(..))));
}
