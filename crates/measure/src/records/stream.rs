//! Samples that arrive as a stream of raw numbers, from a pipe or a socket.

use crate::error::{MeasureError, Result};
use crate::records::files::write_whole;
use crate::records::options::numbered;
use crate::records::record::{Channel, Record, converter_range_v};
use crate::records::stored::{NumberKind, StoredNumber};
use std::io::{self, Read};
use std::path::Path;

/// Least length in s of a piece: the first one's median is the baseline of a level.
const PIECE_S: f64 = 10e-3;

/// Most bytes read at once.
const BLOCK: usize = 1 << 16;

/// Type of the samples of a stream, little-endian.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SampleKind {
    /// Whole numbers of 16 bits.
    #[default]
    I16,
    /// Whole numbers of 32 bits.
    I32,
    /// Floating-point numbers of 32 bits.
    F32,
    /// Floating-point numbers of 64 bits.
    F64,
}

impl SampleKind {
    const fn number(self) -> NumberKind {
        match self {
            Self::I16 => NumberKind::I16,
            Self::I32 => NumberKind::I32,
            Self::F32 => NumberKind::F32,
            Self::F64 => NumberKind::F64,
        }
    }

    /// Type and bytes as a header of NumPy has them.
    const fn descr(self) -> &'static str {
        match self {
            Self::I16 => "<i2",
            Self::I32 => "<i4",
            Self::F32 => "<f4",
            Self::F64 => "<f8",
        }
    }

    /// Bytes of a sample that was read as this kind: the cast gives back what was read.
    fn bytes(self, sample: f64) -> Vec<u8> {
        match self {
            Self::I16 => (sample as i16).to_le_bytes().to_vec(),
            Self::I32 => (sample as i32).to_le_bytes().to_vec(),
            Self::F32 => (sample as f32).to_le_bytes().to_vec(),
            Self::F64 => sample.to_le_bytes().to_vec(),
        }
    }
}

/// What a stream does not say itself. Samples of all channels alternate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamFormat {
    /// Samples of a channel a second.
    pub rate_hz: f64,
    /// One channel that sums both sensors, or the sensor bead's and the wall's.
    pub channels: usize,
    /// Type of its samples.
    pub kind: SampleKind,
}

/// Returns the pieces of a stream as they arrive, until it ends; samples keep the stream's unit.
pub fn stream_pieces(
    name: String,
    mut reader: impl Read,
    format: StreamFormat,
) -> impl Iterator<Item = Result<Record>> {
    let number = StoredNumber::plain(format.kind.number(), false);
    let frame = number.width() * format.channels;
    let least = frame * (PIECE_S * format.rate_hz).ceil().max(1.0) as usize;
    let (mut bytes, mut first, mut ended) = (Vec::new(), 0, false);
    std::iter::from_fn(move || {
        let mut block = vec![0; BLOCK];
        while bytes.len() < least && !ended {
            match reader.read(&mut block) {
                Ok(0) => ended = true,
                Ok(count) => bytes.extend_from_slice(&block[..count]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => {
                    ended = true;
                    return Some(Err(MeasureError::reading(Path::new(&name), error)));
                }
            }
        }
        // What is no whole frame at the end of a stream is dropped.
        let whole = bytes.len() / frame * frame;
        if whole == 0 {
            return None;
        }
        let samples = number.scaled(&bytes[..whole]);
        bytes.drain(..whole);
        let piece = piece(&name, &samples, first, format);
        first += piece.len() as u64;
        Some(Ok(piece))
    })
}

fn piece(name: &str, samples: &[f64], first_sample: u64, format: StreamFormat) -> Record {
    let is_counts = format.kind == SampleKind::I16;
    let channels = numbered(format.channels).into_iter().enumerate().map(|(at, name)| {
        let volts: Vec<f64> = samples.iter().skip(at).step_by(format.channels).copied().collect();
        let range_v = is_counts.then(|| converter_range_v(&volts, 1.0, 0.0));
        Channel { name, volts, range_v }
    });
    let new =
        Record::new(name.to_owned(), Path::new(name), format.rate_hz.recip(), channels.collect());
    Record { first_sample, ..new }
}

/// Writes the samples of a record of a stream, bit for bit, as a NumPy array with a row a moment and
/// a column a channel.
///
/// # Errors
/// What the system reports; nothing half-written stays.
pub fn write_npy(path: &Path, record: &Record, kind: SampleKind) -> io::Result<()> {
    let (descr, rows) = (kind.descr(), record.len());
    let shape = match record.channels.len() {
        1 => format!("({rows},)"),
        columns => format!("({rows}, {columns})"),
    };
    let mut header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    // NumPy aligns numbers to 64 bytes, and a line end stands before them.
    let padded = (10 + header.len() + 1).next_multiple_of(64) - 10;
    header = format!("{header:<width$}\n", width = padded - 1);
    write_whole(path, |out| {
        out.write_all(b"\x93NUMPY\x01\x00")?;
        out.write_all(&(padded as u16).to_le_bytes())?;
        out.write_all(header.as_bytes())?;
        let row = |at| record.channels.iter().map(move |channel| channel.volts[at]);
        (0..rows).flat_map(row).try_for_each(|sample| out.write_all(&kind.bytes(sample)))
    })
}
