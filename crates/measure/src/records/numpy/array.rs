//! One array: its header by npyz, its numbers raw.

use super::order::{Passes, Planes, side_by_side};
use super::place::{Bytes, Place};
use crate::records::arrays::{Axes, Table};
use crate::records::cut::{Cut, MOST_SAMPLES, RawNumbers, Stream};
use crate::records::error::{RecordError, name};
use crate::records::numbers::{Kind, Number};
use crate::records::options::ReadOptions;
use crate::records::read::Raw;
use crate::records::record::Samples;
use npyz::{DType, Endianness, NpyHeader, Order, TypeChar};
use std::io::Read;

/// An array whose numbers are still to be read.
pub(super) struct Array {
    place: Place,
    /// Its name in an NPZ.
    pub part: Option<String>,
    pub shape: Vec<usize>,
    fortran: bool,
    number: Number,
    /// Its numbers from the first on.
    bytes: Bytes,
}

impl Array {
    pub(super) fn open(place: Place, part: Option<String>) -> Result<Self, RecordError> {
        let (header, bytes) = opened(&place)?;
        let refused = |detail: String| RecordError::malformed(&place.file, "a NumPy array", detail);
        let number = number(&header.dtype()).ok_or_else(|| refused(why_not(&header.dtype())))?;
        let sizes = header.shape().iter();
        let shape: Option<Vec<usize>> = sizes.map(|size| usize::try_from(*size).ok()).collect();
        let shape = shape.ok_or_else(|| refused("an axis is beyond all bounds".to_owned()))?;
        Ok(Self {
            place,
            part,
            shape,
            fortran: header.order() == Order::Fortran,
            number,
            bytes,
        })
    }

    /// All numbers of a small array, in the order in which they are stored.
    pub(super) fn values(self) -> Result<Vec<f64>, RecordError> {
        let count = self
            .shape
            .iter()
            .try_fold(1, |n: usize, axis| n.checked_mul(*axis));
        let count = count.filter(|count| *count <= MOST_SAMPLES);
        let count = count.ok_or_else(|| RecordError::TooLong {
            source_name: name(&self.place.file),
            most: MOST_SAMPLES,
        })?;
        let mut stream = self.stream(vec![0], 1);
        let samples = stream.take(count)?;
        Ok(samples.first().map(Samples::volts).unwrap_or_default())
    }

    /// Whether the file ends before its numbers do, as its header counts them.
    pub(super) fn cut_short(&self) -> Option<RecordError> {
        let sizes = self.shape.iter().map(|size| *size as u64);
        let bytes = sizes.fold(self.number.width() as u64, u64::saturating_mul);
        let there = self.bytes.left().filter(|there| *there < bytes)?;
        let detail = format!("{there} of {bytes} bytes of numbers are there");
        Some(RecordError::truncated(name(&self.place.file), detail))
    }

    /// The records of an array of samples.
    pub(super) fn records(
        self,
        interval_s: f64,
        options: &ReadOptions,
    ) -> Result<Raw, RecordError> {
        let fortran = self.fortran && self.shape.len() > 1;
        if fortran && self.shape.len() > 2 {
            let detail = "its three axes are stored column by column; save it with order C";
            return Err(RecordError::malformed(
                &self.place.file,
                "a NumPy array",
                detail,
            ));
        }
        let table = Table::of(
            &self.place.file,
            self.part.clone(),
            &self.shape,
            interval_s,
            options,
        )?;
        let Axes {
            shots, channels, ..
        } = table.axes;
        let side_by_side = if fortran { Some(0) } else { Some(1) };
        if channels.is_none() && shots == side_by_side {
            return self.alternating(table, options);
        }
        // Numbers of the last axis lie side by side; column by column those of the first.
        let planar = channels.is_some_and(|axis| (axis == 0) != fortran || shots.is_some());
        let head = table.head.clone().divided(options.parts);
        Ok(match planar {
            true => Box::new(Cut::new(head, self.planes(&table)?)),
            false => Box::new(Cut::new(head, self.stream(table.chosen, table.stored))),
        })
    }

    /// Shots of which samples alternate.
    fn alternating(self, table: Table, options: &ReadOptions) -> Result<Raw, RecordError> {
        let (shots, frames) = (table.shots, table.frames);
        if shots.saturating_mul(frames) <= HELD {
            let stream = self.stream((0..shots).collect(), shots);
            return Ok(side_by_side(table.head, stream));
        }
        let (place, number) = (self.place, self.number);
        let open = move |shot| {
            let (_, reader) = opened(&place)?;
            Ok(numbers(reader, &place, number, vec![shot], shots))
        };
        let passes = Passes {
            open: Box::new(open),
            shots,
            frames,
            at: 0,
            under_way: None,
        };
        Ok(Box::new(Cut::new(
            table.head.divided(options.parts),
            passes,
        )))
    }

    /// A place in the file for every channel that is wanted.
    fn planes(&self, table: &Table) -> Result<Planes, RecordError> {
        let plane = (table.frames as u64).saturating_mul(self.number.width() as u64);
        let channel = |channel: &usize| {
            let (_, mut bytes) = opened(&self.place)?;
            let skipped = bytes.skip(plane.saturating_mul(*channel as u64));
            skipped.map_err(|cause| RecordError::reading(&self.place.file, cause))?;
            Ok(numbers(bytes, &self.place, self.number, vec![0], 1))
        };
        let channels: Result<_, RecordError> = table.chosen.iter().map(channel).collect();
        Ok(Planes {
            channels: channels?,
            between: plane.saturating_mul(table.stored.saturating_sub(1) as u64),
            frames: table.frames,
            at: 0,
        })
    }

    fn stream(self, chosen: Vec<usize>, stored: usize) -> RawNumbers<Bytes> {
        numbers(self.bytes, &self.place, self.number, chosen, stored)
    }
}

/// Most numbers of alternating shots that are read together.
const HELD: usize = 1 << 25;

fn numbers(
    reader: Bytes,
    place: &Place,
    number: Number,
    chosen: Vec<usize>,
    stored: usize,
) -> RawNumbers<Bytes> {
    RawNumbers {
        reader,
        file: place.file.clone(),
        number,
        stored,
        chosen,
    }
}

/// An array's header, and its numbers after it.
fn opened(place: &Place) -> Result<(NpyHeader, Bytes), RecordError> {
    let reading = |cause| RecordError::reading(&place.file, cause);
    let mut bytes = place.open().map_err(reading)?;
    let begins = beginning(&mut bytes).map_err(reading)?;
    if let Some(detail) = lies(&begins) {
        return Err(RecordError::malformed(&place.file, "a NumPy array", detail));
    }
    let header = NpyHeader::from_reader(begins.chain(&mut bytes));
    let header = header.map_err(|error| match error.kind() {
        std::io::ErrorKind::UnexpectedEof => reading(error),
        _ => RecordError::malformed(&place.file, "a NumPy array", error),
    })?;
    Ok((header, bytes))
}

/// Most bytes of a header: NumPy itself reads no longer ones, and a table's has a hundred.
const MOST_HEADER: usize = 10_000;

/// Most brackets within each other in a header.
const MOST_NESTED: usize = 16;

/// The bytes of a header, as far as it is not longer than it may be.
fn beginning(bytes: &mut Bytes) -> std::io::Result<Vec<u8>> {
    let mut begins = Vec::new();
    bytes.by_ref().take(FIXED as u64).read_to_end(&mut begins)?;
    let more = header_length(&begins).unwrap_or(0).min(MOST_HEADER);
    bytes.by_ref().take(more as u64).read_to_end(&mut begins)?;
    Ok(begins)
}

/// Bytes of magic and version, and of the length in the first version.
const FIXED: usize = 10;

/// Bytes after the first ten that the header has, by what these say.
fn header_length(begins: &[u8]) -> Option<usize> {
    let (version, low) = (begins.get(6)?, begins.get(8..10)?);
    let low = usize::from(u16::from_le_bytes(low.try_into().ok()?));
    match version {
        1 => Some(low),
        // The other two bytes of the length follow; a length in them is beyond all bounds.
        _ => Some(low + 2),
    }
}

/// Why a header cannot be one.
fn lies(begins: &[u8]) -> Option<String> {
    let length = header_length(begins)?;
    let upper = match begins.get(6)? {
        1 => &[][..],
        _ => begins.get(10..12)?,
    };
    if length > MOST_HEADER || upper.iter().any(|byte| *byte != 0) {
        return Some(format!("its header claims more than {MOST_HEADER} bytes"));
    }
    let mut nested = 0_usize;
    for byte in begins {
        match byte {
            b'(' | b'[' | b'{' => nested += 1,
            b')' | b']' | b'}' => nested = nested.saturating_sub(1),
            _ => {}
        }
        if nested > MOST_NESTED {
            let detail =
                format!("its header has more than {MOST_NESTED} brackets within each other");
            return Some(detail);
        }
    }
    None
}

/// Why items are not read.
fn why_not(dtype: &DType) -> String {
    match dtype {
        DType::Plain(plain) if plain.type_char() == TypeChar::Float => format!(
            "its items are floating-point numbers of {} bytes, of which every machine has others; \
             save them as float64",
            plain.size_field()
        ),
        _ => format!(
            "its items are {}, not real numbers; save a plain array",
            dtype.descr()
        ),
    }
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
        (TypeChar::Float, 2) => Kind::F16,
        (TypeChar::Float, 4) => Kind::F32,
        (TypeChar::Float, 8) => Kind::F64,
        _ => return None,
    };
    Some(Number::plain(kind, plain.endianness() == Endianness::Big))
}
