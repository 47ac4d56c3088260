//! NumPy arrays, one in an NPY or several in an NPZ: headers as NumPy writes them, numbers raw.

use crate::error::{MeasureError, Result};
use crate::records::archive::{Archive, Packing, StoredArray, Stretch};
use crate::records::arrays;
use crate::records::options::ReadOptions;
use crate::records::read::Raw;
use crate::records::stored::{NumberKind, StoredNumber};
use indexmap::IndexMap;
use std::fs::File;
use std::io::{BufReader, ErrorKind};
use std::path::Path;
use std::rc::Rc;
use zip::{CompressionMethod, ZipArchive};

/// Most bytes of a header, which NumPy itself enforces.
const MOST_HEADER: usize = 10_000;

pub(crate) fn open_npy(file: &Path, options: &ReadOptions) -> Result<Raw> {
    let whole = Stretch::new(0, u64::MAX, Packing::Plain);
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
        let within = Stretch::new(start, entry.compressed_size(), packing);
        arrays.insert(name, array(file, within));
    }
    arrays::open(Rc::new(Archive { file: file.to_owned(), arrays }), options)
}

fn array(file: &Path, within: Stretch) -> Result<StoredArray> {
    let malformed = |detail: String| MeasureError::malformed(file, "a NumPy array", detail);
    let begins = within.beginning(file, MOST_HEADER)?;
    let start = header_length(&begins).unwrap_or(begins.len() + 1);
    if start > MOST_HEADER {
        let detail = format!("its header claims more than {MOST_HEADER} bytes");
        return Err(malformed(detail));
    }
    let whole = begins.get(..start);
    let whole =
        whole.ok_or_else(|| MeasureError::reading(file, ErrorKind::UnexpectedEof.into()))?;
    let header = ArrayHeader::parse(&String::from_utf8_lossy(whole)).ok_or_else(|| {
        malformed("its header is not a dictionary of descr, fortran_order and shape".to_owned())
    })?;
    let number = number(&header.items).map_err(malformed)?;
    let length = header.shape.iter().fold(number.width() as u64, |all, n| all.saturating_mul(*n));
    let sizes = header.shape.iter().map(|size| usize::try_from(*size).ok());
    let shape: Option<Vec<usize>> = sizes.collect();
    Ok(StoredArray {
        within,
        shape: shape.ok_or_else(|| malformed("an axis is beyond all bounds".to_owned()))?,
        fortran: header.fortran,
        number,
        start: start as u64,
        length,
    })
}

/// The entries of a header.
struct ArrayHeader {
    items: String,
    fortran: bool,
    shape: Vec<u64>,
}

impl ArrayHeader {
    /// From the text of a dictionary of Python, with the three keys in any order.
    fn parse(text: &str) -> Option<Self> {
        let text = text.replace('"', "'");
        let entry = |key: &str| {
            let (_, rest) = text.split_once(&format!("'{key}'"))?;
            Some(rest.trim_start().strip_prefix(':')?.trim_start())
        };
        let items = entry("descr")?;
        let items = match items.strip_prefix('\'') {
            Some(rest) => rest.split('\'').next()?,
            // Several fields an item, in brackets.
            None => &items[..=items.rfind(']')?],
        };
        let order = entry("fortran_order")?;
        let fortran = order.starts_with("True");
        let (shape, _) = entry("shape")?.strip_prefix('(')?.split_once(')')?;
        let sizes = shape.split(',').map(str::trim).filter(|size| !size.is_empty());
        let shape = sizes.map(|size| size.parse().ok()).collect::<Option<_>>()?;
        let is_order = fortran || order.starts_with("False");
        is_order.then(|| Self { items: items.to_owned(), fortran, shape })
    }
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

/// How items are stored, or why they are not read: byte order, kind and bytes, as in `<f8`.
fn number(items: &str) -> Result<StoredNumber, String> {
    let no_number = || format!("its items are {items}, not real numbers; save a plain array");
    let (order, plain) = items.split_at_checked(1).ok_or_else(no_number)?;
    let kind = match plain {
        "i1" => NumberKind::I8,
        "u1" => NumberKind::U8,
        "i2" => NumberKind::I16,
        "u2" => NumberKind::U16,
        "i4" => NumberKind::I32,
        "u4" => NumberKind::U32,
        "i8" => NumberKind::I64,
        "u8" => NumberKind::U64,
        "f2" => NumberKind::F16,
        "f4" => NumberKind::F32,
        "f8" => NumberKind::F64,
        _ if plain.starts_with('f') => {
            let bytes = &plain[1..];
            return Err(format!(
                "its floating-point numbers of {bytes} bytes differ between machines; save them as \
                 float64"
            ));
        }
        _ => return Err(no_number()),
    };
    match order {
        "<" | "|" | "=" => Ok(StoredNumber::plain(kind, false)),
        ">" => Ok(StoredNumber::plain(kind, true)),
        _ => Err(no_number()),
    }
}
