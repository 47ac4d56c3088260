//! NumPy arrays, one in an NPY or several in an NPZ: headers by npyz, numbers raw.

use crate::error::{MeasureError, Result};
use crate::records::archive::{Archive, Packing, StoredArray, Stretch};
use crate::records::arrays;
use crate::records::options::ReadOptions;
use crate::records::read::Raw;
use crate::records::stored::{NumberKind, StoredNumber};
use indexmap::IndexMap;
use npyz::{DType, Endianness, NpyHeader, Order, TypeChar};
use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;
use std::rc::Rc;
use zip::{CompressionMethod, ZipArchive};

/// Most bytes of a header, which NumPy itself enforces, and most brackets within each other.
const MOST_HEADER: usize = 10_000;
const MOST_NESTED: usize = 16;

pub(crate) fn open_npy(file: &Path, options: &ReadOptions) -> Result<Raw> {
    let whole = Stretch { start: 0, size: u64::MAX, packing: Packing::Plain };
    let arrays = IndexMap::from([(String::new(), Ok(array(file, whole)?))]);
    arrays::open(Rc::new(Archive { file: file.to_owned(), arrays }), options)
}

pub(crate) fn open_npz(file: &Path, options: &ReadOptions) -> Result<Raw> {
    let refused = |detail: String| MeasureError::malformed(file, "NPZ", detail);
    let damaged = |error: zip::result::ZipError| refused(format!("cut short or damaged ({error})"));
    let opened = File::open(file).map_err(|cause| MeasureError::reading(file, cause))?;
    let mut archive = ZipArchive::new(BufReader::new(opened)).map_err(damaged)?;
    let mut arrays = IndexMap::new();
    for index in 0..archive.len() {
        let entry = archive.by_index_raw(index).map_err(damaged)?;
        let name = entry.name().map_err(damaged)?;
        let Some(name) = name.strip_suffix(".npy").map(str::to_owned) else {
            continue;
        };
        let packing = match entry.compression() {
            CompressionMethod::Stored => Packing::Plain,
            CompressionMethod::DEFLATE => Packing::Deflate,
            other => {
                let detail = format!("{name} is compressed by {other:?}; use savez_compressed");
                return Err(refused(detail));
            }
        };
        let start = entry.data_start();
        let start = start.ok_or_else(|| refused(format!("{name} has no place in the file")))?;
        let within = Stretch { start, size: entry.compressed_size(), packing };
        arrays.insert(name, array(file, within));
    }
    arrays::open(Rc::new(Archive { file: file.to_owned(), arrays }), options)
}

fn array(file: &Path, within: Stretch) -> Result<StoredArray> {
    let malformed = |detail: String| MeasureError::malformed(file, "a NumPy array", detail);
    let mut begins = within.beginning(file, MOST_HEADER)?;
    let start = header_length(&begins).unwrap_or(begins.len());
    if start > MOST_HEADER {
        let detail = format!("its header claims more than {MOST_HEADER} bytes");
        return Err(malformed(detail));
    }
    begins.truncate(start);
    if nested(&begins) > MOST_NESTED {
        let detail = format!("its header has more than {MOST_NESTED} brackets within each other");
        return Err(malformed(detail));
    }
    let header = NpyHeader::from_reader(begins.as_slice());
    let header = header.map_err(|error| match error.kind() {
        io::ErrorKind::UnexpectedEof => MeasureError::reading(file, error),
        _ => malformed(error.to_string()),
    })?;
    let number = number(&header.dtype()).map_err(malformed)?;
    let sizes = header.shape();
    let length = sizes.iter().fold(number.width() as u64, |all, n| all.saturating_mul(*n));
    let sizes = sizes.iter().map(|size| usize::try_from(*size).ok());
    let shape: Option<Vec<usize>> = sizes.collect();
    Ok(StoredArray {
        within,
        shape: shape.ok_or_else(|| malformed("an axis is beyond all bounds".to_owned()))?,
        fortran: header.order() == Order::Fortran,
        number,
        start: start as u64,
        length,
    })
}

/// Bytes before the numbers, as the first twelve of a file state them.
fn header_length(begins: &[u8]) -> Option<usize> {
    let low = begins.get(8..10)?.try_into().ok()?;
    match begins.get(6)? {
        1 => Some(10 + usize::from(u16::from_le_bytes(low))),
        _ => {
            let length = begins.get(8..12)?.try_into().ok()?;
            Some((u32::from_le_bytes(length) as usize).saturating_add(12))
        }
    }
}

/// Most brackets within each other: the parser recurses into them.
fn nested(header: &[u8]) -> usize {
    let (mut depth, mut most) = (0_usize, 0);
    for byte in header {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        most = most.max(depth);
    }
    most
}

fn number(dtype: &DType) -> Result<StoredNumber, String> {
    let no_number =
        || format!("its items are {}, not real numbers; save a plain array", dtype.descr());
    let DType::Plain(plain) = dtype else {
        return Err(no_number());
    };
    let kind = match (plain.type_char(), plain.size_field()) {
        (TypeChar::Int, 1) => NumberKind::I8,
        (TypeChar::Uint, 1) => NumberKind::U8,
        (TypeChar::Int, 2) => NumberKind::I16,
        (TypeChar::Uint, 2) => NumberKind::U16,
        (TypeChar::Int, 4) => NumberKind::I32,
        (TypeChar::Uint, 4) => NumberKind::U32,
        (TypeChar::Int, 8) => NumberKind::I64,
        (TypeChar::Uint, 8) => NumberKind::U64,
        (TypeChar::Float, 2) => NumberKind::F16,
        (TypeChar::Float, 4) => NumberKind::F32,
        (TypeChar::Float, 8) => NumberKind::F64,
        (TypeChar::Float, bytes) => {
            return Err(format!(
                "its floating-point numbers of {bytes} bytes differ between machines; save them as \
                 float64"
            ));
        }
        _ => return Err(no_number()),
    };
    Ok(StoredNumber::plain(kind, plain.endianness() == Endianness::Big))
}
