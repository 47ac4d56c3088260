//! Streams of stored numbers, cut into records.

use crate::error::{MeasureError, file_name};
use crate::records::interval::interval_s;
use crate::records::options::{Parts, ReadOptions};
use crate::records::record::{Channel, Record, Samples};
use std::io::Read;
use std::path::{Path, PathBuf};

/// Most samples of a channel in one record: 0.27 GB of `f64`.
pub(crate) const MOST_SAMPLES: usize = 1 << 25;

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
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

/// A stored number: value = stored · scale + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Number {
    pub kind: Kind,
    pub big_endian: bool,
    pub scale: f64,
    pub offset: f64,
}

impl Number {
    /// A number that stands for itself.
    pub(super) fn plain(kind: Kind, big_endian: bool) -> Self {
        Self {
            kind,
            big_endian,
            scale: 1.0,
            offset: 0.0,
        }
    }

    /// Bytes of a number.
    pub(super) fn width(&self) -> usize {
        match self.kind {
            Kind::I8 | Kind::U8 => 1,
            Kind::I16 | Kind::U16 | Kind::F16 => 2,
            Kind::I24 => 3,
            Kind::I32 | Kind::U32 | Kind::F32 => 4,
            Kind::I64 | Kind::U64 | Kind::F64 => 8,
        }
    }

    /// Every `every`-th number of `bytes` from number `first` on.
    pub(super) fn samples(&self, bytes: &[u8], first: usize, every: usize) -> Samples {
        if self.kind == Kind::I16 {
            return Samples::Counts {
                counts: self.each(bytes, first, every, i16::from_le_bytes),
                volts_per_count: self.scale,
                offset_v: self.offset,
            };
        }
        let mut values = self.values(bytes, first, every);
        if self.scale != 1.0 || self.offset != 0.0 {
            values
                .iter_mut()
                .for_each(|value| *value = *value * self.scale + self.offset);
        }
        Samples::Volts(values)
    }

    fn values(&self, bytes: &[u8], first: usize, every: usize) -> Vec<f64> {
        match self.kind {
            Kind::I8 => self.each(bytes, first, every, |b| f64::from(i8::from_le_bytes(b))),
            Kind::U8 => self.each(bytes, first, every, |b| f64::from(u8::from_le_bytes(b))),
            Kind::I16 => self.each(bytes, first, every, |b| f64::from(i16::from_le_bytes(b))),
            Kind::U16 => self.each(bytes, first, every, |b| f64::from(u16::from_le_bytes(b))),
            Kind::I24 => self.each(bytes, first, every, |[low, middle, high]: [u8; 3]| {
                f64::from(i32::from_le_bytes([0, low, middle, high]) >> 8)
            }),
            Kind::I32 => self.each(bytes, first, every, |b| f64::from(i32::from_le_bytes(b))),
            Kind::U32 => self.each(bytes, first, every, |b| f64::from(u32::from_le_bytes(b))),
            Kind::I64 => self.each(bytes, first, every, |b| i64::from_le_bytes(b) as f64),
            Kind::U64 => self.each(bytes, first, every, |b| u64::from_le_bytes(b) as f64),
            Kind::F16 => self.each(bytes, first, every, |b| half(u16::from_le_bytes(b))),
            Kind::F32 => self.each(bytes, first, every, |b| f64::from(f32::from_le_bytes(b))),
            Kind::F64 => self.each(bytes, first, every, f64::from_le_bytes),
        }
    }

    fn each<const N: usize, T>(
        &self,
        bytes: &[u8],
        first: usize,
        every: usize,
        value: impl Fn([u8; N]) -> T,
    ) -> Vec<T> {
        let (numbers, _) = bytes.as_chunks::<N>();
        if every == 1 && !self.big_endian {
            // The usual case, as plain as it must be to be vectorised.
            let numbers = numbers.get(first..).unwrap_or_default();
            return numbers.iter().map(|number| value(*number)).collect();
        }
        let numbers = numbers.iter().skip(first).step_by(every.max(1)).copied();
        let turned = |mut number: [u8; N]| {
            if self.big_endian {
                number.reverse();
            }
            value(number)
        };
        numbers.map(turned).collect()
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

/// Samples of several channels in their order in time.
pub(crate) trait Stream {
    /// The next `count` samples of every chosen channel.
    fn take(&mut self, count: usize) -> Result<Vec<Samples>, MeasureError>;
}

/// What all records of a stream share.
#[derive(Clone, Debug)]
pub(crate) struct Head {
    pub file: PathBuf,
    /// Group or array in the file.
    pub part: Option<String>,
    pub names: Vec<String>,
    pub interval_s: f64,
    /// Samples of a channel, in all.
    pub total: usize,
    /// Samples of a channel in a row of a table, as long as all where there is but one.
    pub row: usize,
    /// Samples of a channel in a record.
    pub each: usize,
    /// Whether records are pieces of one recording and not shots.
    pub pieces: bool,
    pub note: Option<String>,
}

impl Head {
    /// The head of a stream that is one record, at the stated interval or that of the options.
    pub(super) fn new(
        file: &Path,
        names: Vec<String>,
        stated_s: Option<f64>,
        total: usize,
        options: &ReadOptions,
    ) -> Result<Self, MeasureError> {
        if total == 0 {
            return Err(MeasureError::empty(file_name(file)));
        }
        Ok(Self {
            file: file.to_owned(),
            part: None,
            names,
            interval_s: interval_s(file, stated_s, options)?,
            total,
            row: total,
            each: total,
            pieces: false,
            note: None,
        })
    }

    /// Divides what would be one record. Pieces end where rows do; several rows are not divided
    /// into shots here, which are counted by row first.
    pub(super) fn divided(self, parts: Parts) -> Self {
        match parts {
            Parts::Shots(most) if self.row == self.total => Self {
                each: most.max(1),
                ..self
            },
            Parts::Pieces(most) => Self {
                each: most.clamp(1, self.row.max(1)),
                pieces: true,
                ..self
            },
            Parts::Shots(_) | Parts::Whole => self,
        }
    }

    /// Name of the record from sample `start` on, and number of its shot where there are several.
    fn source(&self, start: usize) -> (String, Option<u64>) {
        // What has a number of its own: a shot, or a row of which records are pieces.
        let numbered = if self.pieces { self.row } else { self.each };
        let shot = (self.total > numbered).then(|| (start / numbered.max(1)) as u64 + 1);
        let part = self.part.iter().map(|part| format!(", {part}"));
        let number = shot.iter().map(|shot| format!(", shot {shot}"));
        let source: String = std::iter::once(file_name(&self.file))
            .chain(part)
            .chain(number)
            .collect();
        (from_sample(source, self.first_sample(start)), shot)
    }

    /// Of a piece in its row; shots begin anew.
    fn first_sample(&self, start: usize) -> u64 {
        match self.pieces {
            true => (start % self.row.max(1)) as u64,
            false => 0,
        }
    }

    /// The record of this stream that begins with sample `start`.
    pub(super) fn record(&self, start: usize, samples: Vec<Samples>) -> Record {
        let named = self.names.iter().cloned().zip(samples);
        let channels = named.map(|(name, samples)| Channel { name, samples });
        let (source, shot) = self.source(start);
        Record {
            shot,
            first_sample: self.first_sample(start),
            notes: self.note.iter().cloned().collect(),
            ..Record::new(source, &self.file, self.interval_s, channels.collect())
        }
    }
}

/// Name of a piece of a recording.
pub(crate) fn from_sample(source: String, first_sample: u64) -> String {
    match first_sample {
        0 => source,
        first => format!("{source}, from sample {} on", first + 1),
    }
}

/// An iterator over a stream's records.
pub(crate) struct Cut<S> {
    head: Head,
    stream: S,
    done: usize,
}

impl<S: Stream> Cut<S> {
    pub(super) fn new(head: Head, stream: S) -> Self {
        Self {
            head,
            stream,
            done: 0,
        }
    }
}

impl<S: Stream> Iterator for Cut<S> {
    type Item = Result<Record, MeasureError>;

    fn next(&mut self) -> Option<Self::Item> {
        let start = self.done;
        let left = self.head.total.saturating_sub(start);
        let of_row = self.head.row - start % self.head.row.max(1);
        let count = left.min(of_row).min(self.head.each);
        if count == 0 {
            return None;
        }
        let taken = match count > MOST_SAMPLES {
            true => Err(MeasureError::too_long(
                self.head.source(start).0,
                MOST_SAMPLES,
            )),
            false => self.stream.take(count),
        };
        self.done = match taken {
            Ok(_) => start + count,
            Err(_) => self.head.total,
        };
        Some(taken.map(|samples| self.head.record(start, samples)))
    }
}

/// Raw numbers of several channels, sample by sample.
pub(crate) struct RawNumbers<R> {
    pub reader: R,
    pub file: PathBuf,
    pub number: Number,
    /// Channels that are stored.
    pub stored: usize,
    /// Channels that are wanted.
    pub chosen: Vec<usize>,
}

impl<R: Read> Stream for RawNumbers<R> {
    fn take(&mut self, count: usize) -> Result<Vec<Samples>, MeasureError> {
        let bytes = count
            .checked_mul(self.stored)
            .and_then(|n| n.checked_mul(self.number.width()))
            .filter(|bytes| *bytes <= MOST_SAMPLES * 8)
            .ok_or_else(|| MeasureError::too_long(file_name(&self.file), MOST_SAMPLES))?;
        let mut raw = Vec::new();
        // Grows with what there is, whatever a damaged header promises.
        let mut limited = self.reader.by_ref().take(bytes as u64);
        let read = limited
            .read_to_end(&mut raw)
            .map_err(|cause| MeasureError::reading(&self.file, cause))?;
        if read < bytes {
            let detail = format!("{read} of {bytes} bytes of a record");
            return Err(MeasureError::truncated(file_name(&self.file), detail));
        }
        let one = |channel: &usize| self.number.samples(&raw, *channel, self.stored);
        Ok(self.chosen.iter().map(one).collect())
    }
}

#[cfg(test)]
#[path = "tests/numbers.rs"]
mod tests;
