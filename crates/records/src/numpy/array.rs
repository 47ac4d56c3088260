//! One array: its header by npyz, its numbers raw.

use crate::arrays::{Axes, Table};
use crate::cut::{Cut, Head, MOST_SAMPLES, RawNumbers, Stream};
use crate::error::{RecordError, name};
use crate::numbers::{Kind, Number};
use crate::options::ReadOptions;
use crate::read::Raw;
use crate::record::Samples;
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
        let fortran = self.fortran && self.shape.len() > 1;
        if fortran && self.shape.len() > 2 {
            let detail = "its three axes are stored column by column; save it with order C";
            return Err(RecordError::malformed(&self.file, "a NumPy array", detail));
        }
        let table = Table::of(
            &self.file,
            self.part.clone(),
            &self.shape,
            interval_s,
            options,
        )?;
        let Axes {
            shots, channels, ..
        } = table.axes;
        if fortran && shots.is_some() {
            let all = (0..table.shots).collect();
            return Ok(side_by_side(
                table.head,
                self.stream(all, table.shots, false),
            ));
        }
        // Numbers of the last axis lie side by side; column by column those of the first.
        let planar = channels.is_some_and(|axis| (axis == 0) != fortran || shots.is_some());
        let head = match planar {
            true => table.head,
            false => table.head.divided(options.parts),
        };
        let stream = self.stream(table.chosen, table.stored, planar);
        Ok(Box::new(Cut::new(head, stream)))
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
    let shots = match stream.take(head.each) {
        Ok(shots) => shots,
        Err(error) => return Box::new(std::iter::once(Err(error))),
    };
    let record = move |(row, samples)| Ok(head.record(row * head.row, vec![samples]));
    Box::new(shots.into_iter().enumerate().map(record))
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
