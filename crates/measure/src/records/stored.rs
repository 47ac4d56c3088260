//! Stored numbers: how each is encoded, where those of a channel lie, and the records made of them.

use crate::error::{MeasureError, Result, file_name};
use crate::records::options::Parts;
use crate::records::read::Raw;
use crate::records::record::{Channel, Record, Samples, converter_range_v};
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::PathBuf;

/// Most samples of a channel in one record: 0.27 GB of `f64`.
pub(crate) const MOST_SAMPLES: usize = 1 << 25;

/// Bytes read together of numbers that do not lie side by side, if a page of memory holds several.
const BLOCK: usize = 1 << 22;
const PAGE: usize = 1 << 12;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NumberKind {
    I8,
    U8,
    I16,
    U16,
    I24,
    I32,
    U32,
    I64,
    U64,
    F16,
    F32,
    F64,
}

/// Encoding of a number: value = stored · scale + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StoredNumber {
    pub kind: NumberKind,
    pub big_endian: bool,
    pub scale: f64,
    pub offset: f64,
}

impl StoredNumber {
    pub(super) fn plain(kind: NumberKind, big_endian: bool) -> Self {
        Self { kind, big_endian, scale: 1.0, offset: 0.0 }
    }

    pub(super) fn width(&self) -> usize {
        match self.kind {
            NumberKind::I8 | NumberKind::U8 => 1,
            NumberKind::I16 | NumberKind::U16 | NumberKind::F16 => 2,
            NumberKind::I24 => 3,
            NumberKind::I32 | NumberKind::U32 | NumberKind::F32 => 4,
            NumberKind::I64 | NumberKind::U64 | NumberKind::F64 => 8,
        }
    }

    pub(super) fn scaled(&self, bytes: &[u8]) -> Vec<f64> {
        let mut values = self.values(bytes);
        if self.scale != 1.0 || self.offset != 0.0 {
            let values = values.iter_mut();
            values.for_each(|value| *value = *value * self.scale + self.offset);
        }
        values
    }

    fn values(&self, bytes: &[u8]) -> Vec<f64> {
        match self.kind {
            NumberKind::I8 => self.each(bytes, |b| f64::from(i8::from_le_bytes(b))),
            NumberKind::U8 => self.each(bytes, |b| f64::from(u8::from_le_bytes(b))),
            NumberKind::I16 => self.each(bytes, |b| f64::from(i16::from_le_bytes(b))),
            NumberKind::U16 => self.each(bytes, |b| f64::from(u16::from_le_bytes(b))),
            NumberKind::I24 => self.each(bytes, |[low, middle, high]: [u8; 3]| {
                f64::from(i32::from_le_bytes([0, low, middle, high]) >> 8)
            }),
            NumberKind::I32 => self.each(bytes, |b| f64::from(i32::from_le_bytes(b))),
            NumberKind::U32 => self.each(bytes, |b| f64::from(u32::from_le_bytes(b))),
            NumberKind::I64 => self.each(bytes, |b| i64::from_le_bytes(b) as f64),
            NumberKind::U64 => self.each(bytes, |b| u64::from_le_bytes(b) as f64),
            NumberKind::F16 => self.each(bytes, |b| half(u16::from_le_bytes(b))),
            NumberKind::F32 => self.each(bytes, |b| f64::from(f32::from_le_bytes(b))),
            NumberKind::F64 => self.each(bytes, f64::from_le_bytes),
        }
    }

    fn each<const N: usize, T>(&self, bytes: &[u8], value: impl Fn([u8; N]) -> T) -> Vec<T> {
        let (numbers, _) = bytes.as_chunks::<N>();
        let turned = |number: &[u8; N]| {
            let mut number = *number;
            number.reverse();
            value(number)
        };
        match self.big_endian {
            true => numbers.iter().map(turned).collect(),
            false => numbers.iter().map(|number| value(*number)).collect(),
        }
    }
}

/// A reader over a header in either byte order; `None` beyond its end.
pub(super) struct HeaderBytes<'a> {
    pub left: &'a [u8],
    pub big_endian: bool,
}

impl<'a> HeaderBytes<'a> {
    pub(super) fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, left) = self.left.split_at_checked(count)?;
        self.left = left;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let mut bytes: [u8; N] = self.take(N)?.try_into().ok()?;
        if self.big_endian {
            bytes.reverse();
        }
        Some(bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    pub(super) fn size(&mut self) -> Option<usize> {
        usize::try_from(self.u64()?).ok()
    }
}

/// A number of half precision: a sign, five bits of exponent, ten of fraction (IEEE 754).
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 0 { 1.0 } else { -1.0 };
    let fraction = f64::from(bits & 0x3ff);
    sign * match i32::from(bits >> 10 & 0x1f) {
        0 => fraction * 2.0_f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        exponent => (1024.0 + fraction) * 2.0_f64.powi(exponent - 25),
    }
}

/// Equal runs of samples of one channel, one a chunk of the file.
#[derive(Clone, Debug)]
pub(crate) struct SampleRuns {
    /// Of the first sample, from the file's beginning.
    pub offset: u64,
    /// Samples a run.
    pub count: usize,
    /// Bytes from a sample to the next.
    pub stride: usize,
    pub chunks: usize,
    pub chunk_bytes: usize,
}

/// Where the samples of one channel are, and what makes volts of them.
#[derive(Clone, Debug)]
pub(crate) struct StoredChannel {
    pub number: StoredNumber,
    /// Polynomials in turn, by their coefficients from that of power 0 on.
    pub scales: Vec<Vec<f64>>,
    pub runs: Vec<SampleRuns>,
}

impl StoredChannel {
    pub(super) fn run(number: StoredNumber, offset: u64, count: usize, stride: usize) -> Self {
        let run = SampleRuns { offset, count, stride, chunks: 1, chunk_bytes: 0 };
        Self { number, scales: Vec::new(), runs: vec![run] }
    }

    pub(super) fn len(&self) -> usize {
        let runs = self.runs.iter();
        runs.map(|run| run.count * run.chunks).sum()
    }

    /// The samples of a range, `shift` bytes after where the runs are.
    pub(super) fn read(
        &self,
        reader: &mut (impl Read + Seek),
        shift: u64,
        wanted: Range<usize>,
    ) -> io::Result<Vec<f64>> {
        let wide = self.number.width();
        let (mut bytes, mut begin) = (Vec::new(), 0);
        for run in &self.runs {
            let end = begin + run.count * run.chunks;
            let mut at = wanted.start.max(begin);
            while at < wanted.end.min(end) {
                let (chunk, first) = ((at - begin) / run.count, (at - begin) % run.count);
                let together = match run.stride {
                    stride if stride == wide => usize::MAX,
                    stride if stride > PAGE => 1,
                    stride => BLOCK / stride,
                };
                let count = (run.count - first).min(wanted.end - at).min(together);
                let place = (chunk * run.chunk_bytes + first * run.stride) as u64;
                let place = run.offset.saturating_add(place).saturating_add(shift);
                reader.seek(SeekFrom::Start(place))?;
                append(reader, &mut bytes, count, run.stride, wide)?;
                at += count;
            }
            begin = end;
        }
        let mut volts = self.number.scaled(&bytes);
        for powers in &self.scales {
            let horner = |x: f64| powers.iter().rev().fold(0.0, |sum, power| sum * x + power);
            volts.iter_mut().for_each(|volt| *volt = horner(*volt));
        }
        Ok(volts)
    }
}

/// Appends numbers that lie `stride` bytes apart. Memory grows with what there is, whatever a
/// damaged header promises.
fn append(
    reader: &mut impl Read,
    bytes: &mut Vec<u8>,
    count: usize,
    stride: usize,
    wide: usize,
) -> io::Result<()> {
    let span = (count - 1) * stride + wide;
    let mut limited = reader.take(span as u64);
    let read = if stride == wide {
        limited.read_to_end(bytes)?
    } else {
        let mut raw = Vec::new();
        limited.read_to_end(&mut raw)?;
        let numbers = raw.chunks(stride).filter_map(|row| row.get(..wide));
        bytes.extend(numbers.flatten());
        raw.len()
    };
    match read < span {
        true => Err(io::ErrorKind::UnexpectedEof.into()),
        false => Ok(()),
    }
}

/// What the records of a table of shots share.
#[derive(Clone, Debug)]
pub(crate) struct Head {
    pub file: PathBuf,
    /// Group or array in the file.
    pub part: Option<String>,
    pub names: Vec<String>,
    pub interval_s: f64,
    pub rows: usize,
    /// Samples of a channel in a row.
    pub frames: usize,
    pub note: Option<String>,
}

impl Head {
    /// The records of channels in a file, whose rows, or shots, are so many bytes apart.
    pub(super) fn stored(
        self,
        parts: Parts,
        mut reader: impl Read + Seek + 'static,
        channels: Vec<StoredChannel>,
        row_bytes: u64,
    ) -> Raw {
        let file = self.file.clone();
        self.records(parts, move |row, from, count| {
            let shift = row_bytes.saturating_mul(row as u64);
            let read = channels.iter().map(|one| {
                let volts = one.read(&mut reader, shift, from..from + count)?;
                let is_counts = one.number.kind == NumberKind::I16 && one.scales.is_empty();
                let range = || converter_range_v(&volts, one.number.scale, one.number.offset);
                let range_v = is_counts.then(range);
                Ok((volts, range_v))
            });
            let read: io::Result<_> = read.collect();
            read.map_err(|cause| MeasureError::reading(&file, cause))
        })
    }

    /// The records: rows, or parts of them, of which `samples` returns a count of every channel's
    /// samples from a row's sample on. Several rows are not divided into shots here, which are
    /// counted by row first.
    pub(super) fn records(
        self,
        parts: Parts,
        mut samples: impl FnMut(usize, usize, usize) -> Result<Vec<Samples>> + 'static,
    ) -> Raw {
        let pieces = matches!(parts, Parts::Pieces(_));
        let each = match parts {
            Parts::Pieces(most) => most.clamp(1, self.frames),
            Parts::Shots(most) if self.rows == 1 => most.max(1),
            Parts::Shots(_) | Parts::Whole => self.frames,
        };
        let total = self.rows.saturating_mul(self.frames);
        let mut start = 0;
        Box::new(std::iter::from_fn(move || {
            let (row, from) = (start / self.frames, start % self.frames);
            let count = each.min(self.frames - from);
            if start >= total {
                return None;
            }
            let shot = match (self.rows > 1, pieces) {
                (true, _) => Some(row as u64 + 1),
                (false, false) if total > each => Some((start / each) as u64 + 1),
                (false, _) => None,
            };
            let first = if pieces { from as u64 } else { 0 };
            let name = self.source(shot, first);
            let taken = match count > MOST_SAMPLES {
                true => Err(MeasureError::too_long(name.clone(), MOST_SAMPLES)),
                false => samples(row, from, count),
            };
            start = if taken.is_ok() { start + count } else { total };
            Some(taken.map(|samples| self.record(name, shot, first, samples)))
        }))
    }

    fn source(&self, shot: Option<u64>, first_sample: u64) -> String {
        let mut name = file_name(&self.file);
        name.extend(self.part.iter().map(|part| format!(", {part}")));
        name.extend(shot.map(|shot| format!(", shot {shot}")));
        from_sample(name, first_sample)
    }

    fn record(
        &self,
        source: String,
        shot: Option<u64>,
        first_sample: u64,
        samples: Vec<Samples>,
    ) -> Record {
        let named = self.names.iter().cloned().zip(samples);
        let channels = named.map(|(name, (volts, range_v))| Channel { name, volts, range_v });
        Record {
            shot,
            first_sample,
            notes: self.note.iter().cloned().collect(),
            ..Record::new(source, &self.file, self.interval_s, channels.collect())
        }
    }
}

pub(crate) fn from_sample(source: String, first_sample: u64) -> String {
    match first_sample {
        0 => source,
        first => format!("{source}, from sample {} on", first + 1),
    }
}

#[cfg(test)]
#[path = "tests/numbers.rs"]
mod tests;
