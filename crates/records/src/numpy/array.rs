//! One array: its header by npyz, its numbers raw.

use crate::channels::{chosen, numbered};
use crate::cut::{Cut, Head, MOST_SAMPLES, Raw as RawNumbers, Stream};
use crate::error::{RecordError, name};
use crate::numbers::{Kind, Number};
use crate::options::{ReadOptions, Rows};
use crate::read::Raw;
use crate::record::{Record, Samples};
use npyz::{DType, Endianness, NpyHeader, Order, TypeChar};
use std::io::Read;
use std::path::{Path, PathBuf};

/// An array whose numbers are still to be read.
pub(super) struct Array {
    file: PathBuf,
    /// Its name in an NPZ.
    pub part: Option<String>,
    pub shape: Vec<usize>,
    fortran: bool,
    number: Number,
    reader: Box<dyn Read>,
}

/// How an array's numbers make records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Layout {
    stored: usize,
    frames: usize,
    records: usize,
    planar: bool,
    /// Whether what is stored side by side are shots.
    shots_side_by_side: bool,
}

impl Array {
    pub fn open(
        file: &Path,
        part: Option<String>,
        mut reader: Box<dyn Read>,
    ) -> Result<Self, RecordError> {
        let refused = |detail: String| RecordError::malformed(file, "a NumPy array", detail);
        let header = NpyHeader::from_reader(&mut reader);
        let header = header.map_err(|error| match error.kind() {
            std::io::ErrorKind::UnexpectedEof => RecordError::reading(file, error),
            _ => refused(error.to_string()),
        })?;
        let number = number(&header.dtype()).ok_or_else(|| {
            refused(format!(
                "its items are {}, not real numbers; save a plain array",
                header.dtype().descr()
            ))
        })?;
        let sizes = header.shape().iter();
        let shape: Option<Vec<usize>> = sizes.map(|size| usize::try_from(*size).ok()).collect();
        Ok(Self {
            file: file.to_owned(),
            part,
            shape: shape.ok_or_else(|| refused("an axis is beyond all bounds".to_owned()))?,
            fortran: header.order() == Order::Fortran,
            number,
            reader,
        })
    }

    /// All numbers of a small array, in the order in which they are stored.
    pub fn values(self) -> Result<Vec<f64>, RecordError> {
        let count = self
            .shape
            .iter()
            .try_fold(1, |n: usize, axis| n.checked_mul(*axis));
        let count = count.filter(|count| *count <= MOST_SAMPLES);
        let count = count.ok_or_else(|| RecordError::TooLong {
            source_name: name(&self.file),
            most: MOST_SAMPLES,
        })?;
        let mut stream = self.stream(vec![0], 1, false);
        let samples = stream.take(count)?;
        Ok(samples.first().map(Samples::volts).unwrap_or_default())
    }

    /// The records of an array of samples.
    pub fn records(self, interval_s: f64, options: &ReadOptions) -> Result<Raw, RecordError> {
        if self.shape.contains(&0) {
            return Err(RecordError::Empty {
                source_name: name(&self.file),
            });
        }
        let layout = layout(&self.shape, self.fortran, options.rows);
        let layout = layout.ok_or_else(|| {
            let detail = format!("an array of {:?} is no table of samples", self.shape);
            RecordError::malformed(&self.file, "a NumPy array", detail)
        })?;
        let names = numbered(layout.stored);
        let chosen = match layout.shots_side_by_side || layout.stored == 1 {
            true => (0..layout.stored).collect(),
            false => chosen(&self.file, &names, options)?,
        };
        let continuous = layout.records == 1 && !layout.planar && !layout.shots_side_by_side;
        let cut = options.shot_samples.filter(|_| continuous);
        let head = Head {
            file: self.file.clone(),
            part: self.part.clone(),
            names: chosen.iter().map(|index| names[*index].clone()).collect(),
            interval_s,
            total: layout.frames.saturating_mul(layout.records),
            each: cut.unwrap_or(layout.frames).max(1),
        };
        let stream = self.stream(chosen, layout.stored, layout.planar);
        Ok(match layout.shots_side_by_side {
            true => side_by_side(head, stream),
            false => Box::new(Cut::new(head, stream)),
        })
    }

    fn stream(self, chosen: Vec<usize>, stored: usize, planar: bool) -> RawNumbers<Box<dyn Read>> {
        RawNumbers {
            reader: self.reader,
            file: self.file,
            number: self.number,
            stored,
            chosen,
            planar,
        }
    }
}

/// Shots whose samples alternate are read together.
fn side_by_side(head: Head, mut stream: RawNumbers<Box<dyn Read>>) -> Raw {
    let shots = match stream.take(head.total) {
        Ok(shots) => shots,
        Err(error) => return Box::new(std::iter::once(Err(error))),
    };
    let head = Head {
        names: numbered(1),
        each: head.total,
        total: head.total.saturating_mul(shots.len()),
        ..head
    };
    let record = move |(number, samples)| -> Result<Record, RecordError> {
        Ok(head.record(number, vec![samples]))
    };
    Box::new((1..).zip(shots).map(record))
}

/// A number that a plain item is.
fn number(dtype: &DType) -> Option<Number> {
    let DType::Plain(plain) = dtype else {
        return None;
    };
    let kind = match (plain.type_char(), plain.size_field()) {
        (TypeChar::Int, 1) => Kind::I8,
        (TypeChar::Uint, 1) => Kind::U8,
        (TypeChar::Int, 2) => Kind::I16,
        (TypeChar::Uint, 2) => Kind::U16,
        (TypeChar::Int, 4) => Kind::I32,
        (TypeChar::Uint, 4) => Kind::U32,
        (TypeChar::Int, 8) => Kind::I64,
        (TypeChar::Uint, 8) => Kind::U64,
        (TypeChar::Float, 4) => Kind::F32,
        (TypeChar::Float, 8) => Kind::F64,
        _ => return None,
    };
    Some(Number::plain(kind, plain.endianness() == Endianness::Big))
}

/// What the axes are. Of two, the second goes over numbers side by side; stored
/// column by column it is the first that does.
fn layout(shape: &[usize], fortran: bool, rows: Rows) -> Option<Layout> {
    let make = |stored, frames, records, planar| {
        Some(Layout {
            stored,
            frames,
            records,
            planar,
            shots_side_by_side: false,
        })
    };
    match (shape, fortran) {
        (&[frames], _) => make(1, frames, 1, false),
        (&[a, b], fortran) => {
            let rows = match rows {
                Rows::Auto if a <= b => Rows::Shots,
                Rows::Auto => Rows::Times,
                told => told,
            };
            match (rows, fortran) {
                (Rows::Times, false) => make(b, a, 1, false),
                (Rows::Times, true) => make(b, a, 1, true),
                (Rows::Channels, false) => make(a, b, 1, true),
                (Rows::Channels, true) => make(a, b, 1, false),
                (_, false) => make(1, b, a, false),
                (_, true) => Some(Layout {
                    shots_side_by_side: true,
                    ..make(a, b, 1, false)?
                }),
            }
        }
        (&[shots, channels, frames], false) => make(channels, frames, shots, true),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longer_axis_is_time_unless_told() {
        let told = |shape: &[usize], rows| layout(shape, false, rows).unwrap();
        let shots = told(&[20, 1000], Rows::Auto);
        assert_eq!((shots.records, shots.frames, shots.stored), (20, 1000, 1));
        let columns = told(&[1000, 2], Rows::Auto);
        assert_eq!(
            (columns.records, columns.frames, columns.stored),
            (1, 1000, 2)
        );
        let channels = told(&[2, 1000], Rows::Channels);
        assert_eq!(
            (channels.records, channels.stored, channels.planar),
            (1, 2, true)
        );
    }
}
