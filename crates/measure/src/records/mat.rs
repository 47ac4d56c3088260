//! MATLAB's files of the versions 4 and 5: headers here, numbers raw. Version 7.3 is HDF5.

use crate::error::{MeasureError, Result, file_name};
use crate::records::archive::{Archive, Packing, StoredArray, Stretch};
use crate::records::arrays;
use crate::records::options::ReadOptions;
use crate::records::read::Raw;
use crate::records::stored::{HeaderBytes, NumberKind, StoredNumber};
use indexmap::IndexMap;
use std::path::Path;
use std::rc::Rc;

/// Bytes of version 5 before its elements, and of the tag of one.
const PREAMBLE: u64 = 128;
const TAG: u64 = 8;
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
/// Classes of arrays of numbers, from double to the unsigned integer of 64 bits, and the flag of
/// complex ones.
const NUMBERS: std::ops::RangeInclusive<u32> = 6..=15;
const COMPLEX: u32 = 1 << 11;

/// Most bytes before the first number of an array: flags, axes and a name.
const MOST_HEADER: usize = 4096;
const MOST_ARRAYS: usize = 100_000;

/// Whether a file that begins so is of version 4 or 5.
pub(crate) fn is_mat(begins: &[u8]) -> bool {
    is_big_endian(begins).is_some() || Header4::parse(begins).is_some()
}

fn is_big_endian(begins: &[u8]) -> Option<bool> {
    match begins.get(124..128)? {
        [0, 1, b'I', b'M'] => Some(false),
        [1, 0, b'M', b'I'] => Some(true),
        _ => None,
    }
}

pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw> {
    let reading = |cause| MeasureError::reading(file, cause);
    let length = file.metadata().map_err(reading)?.len();
    let begins = beginning(file, 0, length, Packing::Plain)?;
    let mut arrays = IndexMap::new();
    let mut at = if is_big_endian(&begins).is_some() { PREAMBLE } else { 0 };
    while at < length && arrays.len() < MOST_ARRAYS {
        let next = match is_big_endian(&begins) {
            Some(big_endian) => element(file, (at, length), big_endian)?,
            None => variable(file, (at, length))?,
        };
        let cut_short = || {
            let detail = format!("no array ends after byte {at}");
            MeasureError::truncated(file_name(file), detail)
        };
        let (end, array) = next.filter(|next| next.0 > at).ok_or_else(cut_short)?;
        arrays.extend(array.map(|(name, array)| (name, Ok(array))));
        at = end;
    }
    if arrays.is_empty() {
        return Err(MeasureError::empty(file_name(file)));
    }
    arrays::open(Rc::new(Archive { file: file.to_owned(), arrays }), options)
}

fn beginning(file: &Path, start: u64, size: u64, packing: Packing) -> Result<Vec<u8>> {
    Stretch { start, size, packing }.beginning(file, MOST_HEADER)
}

/// The end of what begins at a byte, and the array that it holds, if it is one of real numbers;
/// `None` of what is cut short or no element.
type Next = Option<(u64, Option<(String, StoredArray)>)>;

fn element(file: &Path, (at, length): (u64, u64), big_endian: bool) -> Result<Next> {
    let tag = beginning(file, at, TAG, Packing::Plain)?;
    let mut bytes = HeaderBytes { left: &tag, big_endian };
    let (Some(kind), Some(size)) = (bytes.u32(), bytes.u32()) else {
        return Ok(None);
    };
    let (start, size) = (at + TAG, u64::from(size));
    let end = Some(start + size).filter(|end| *end <= length);
    let within = match kind {
        COMPRESSED => Stretch { start, size, packing: Packing::Zlib },
        // With its tag, as an inflated element has one.
        MATRIX => Stretch { start: at, size: TAG + size, packing: Packing::Plain },
        _ => return Ok(end.map(|end| (end, None))),
    };
    let header = within.beginning(file, MOST_HEADER)?;
    Ok(end.map(|end| (end, matrix(&header, within, big_endian))))
}

/// The array of real numbers whose element begins so, with its name.
fn matrix(header: &[u8], within: Stretch, big_endian: bool) -> Option<(String, StoredArray)> {
    let mut bytes = HeaderBytes { left: header, big_endian };
    bytes.take(TAG as usize)?;
    let mut flags = HeaderBytes { left: part(&mut bytes)?.1, big_endian };
    let flags = flags.u32()?;
    let axes = part(&mut bytes)?.1;
    let kind = StoredNumber::plain(NumberKind::U32, big_endian);
    let shape: Vec<usize> = kind.scaled(axes).iter().map(|axis| *axis as usize).collect();
    let name = String::from_utf8_lossy(part(&mut bytes)?.1).into_owned();
    if !NUMBERS.contains(&(flags & 0xff)) || flags & COMPLEX != 0 || name.is_empty() {
        return None;
    }
    let (code, size, is_small) = sub_tag(&mut bytes)?;
    let kind = match code {
        1 => NumberKind::I8,
        2 => NumberKind::U8,
        3 => NumberKind::I16,
        4 => NumberKind::U16,
        5 => NumberKind::I32,
        6 => NumberKind::U32,
        7 => NumberKind::F32,
        9 => NumberKind::F64,
        12 => NumberKind::I64,
        13 => NumberKind::U64,
        _ => return None,
    };
    // The data of a small element are in its tag.
    let before = header.len() - bytes.left.len() - if is_small { 4 } else { 0 };
    let array = StoredArray {
        within,
        shape,
        fortran: true,
        number: StoredNumber::plain(kind, big_endian),
        start: before as u64,
        length: size as u64,
    };
    Some((name, array))
}

/// Type and size of a part of an element, and whether its four bytes follow in the tag itself.
fn sub_tag(bytes: &mut HeaderBytes<'_>) -> Option<(u32, usize, bool)> {
    let first = bytes.u32()?;
    let second = bytes.u32()?;
    Some(match first >> 16 {
        0 => (first, second as usize, false),
        size => (first & 0xffff, size as usize, true),
    })
}

fn part<'a>(bytes: &mut HeaderBytes<'a>) -> Option<(u32, &'a [u8])> {
    let before = bytes.left;
    let (kind, size, is_small) = sub_tag(bytes)?;
    if is_small {
        return Some((kind, before.get(4..4 + size.min(4))?));
    }
    let padded = bytes.take(size.checked_next_multiple_of(8)?)?;
    Some((kind, &padded[..size]))
}

struct Header4 {
    number: StoredNumber,
    is_numbers: bool,
    shape: Vec<usize>,
    name: String,
}

impl Header4 {
    const BYTES: usize = 20;
    const MOST: usize = 64;

    fn parse(begins: &[u8]) -> Option<Self> {
        let of = |big_endian| {
            let mut bytes = HeaderBytes { left: begins, big_endian };
            let code = bytes.u32()?;
            let (order, kind, class) = (code / 1000, code / 10 % 10, code % 10);
            let shape = vec![bytes.u32()? as usize, bytes.u32()? as usize];
            let is_complex = bytes.u32()?;
            let size = bytes.u32()? as usize;
            let name = bytes.take(Some(size).filter(|size| (2..=Self::MOST).contains(size))?)?;
            let name = std::str::from_utf8(name.strip_suffix(b"\0")?).ok()?;
            let is_word = name.chars().all(|letter| letter.is_alphanumeric() || letter == '_');
            let sound = order == u32::from(big_endian) && code / 100 % 10 == 0 && is_word;
            let kinds = [
                NumberKind::F64,
                NumberKind::F32,
                NumberKind::I32,
                NumberKind::I16,
                NumberKind::U16,
                NumberKind::U8,
            ];
            let kind = kinds.get(kind as usize).filter(|_| sound && class < 3 && is_complex < 2)?;
            Some(Self {
                number: StoredNumber::plain(*kind, big_endian),
                is_numbers: class == 0 && is_complex == 0,
                shape,
                name: name.to_owned(),
            })
        };
        of(false).or_else(|| of(true))
    }
}

fn variable(file: &Path, (at, length): (u64, u64)) -> Result<Next> {
    let header = beginning(file, at, length - at, Packing::Plain)?;
    let Some(Header4 { number, is_numbers, shape, name }) = Header4::parse(&header) else {
        return Ok(None);
    };
    let start = Header4::BYTES as u64 + name.len() as u64 + 1;
    let count = shape.iter().fold(number.width() as u64, |all, n| all.saturating_mul(*n as u64));
    let within = Stretch { start: at, size: length - at, packing: Packing::Plain };
    let array = StoredArray { within, shape, fortran: true, number, start, length: count };
    let end = at.saturating_add(start).saturating_add(count);
    let end = Some(end).filter(|end| *end <= length);
    Ok(end.map(|end| (end, is_numbers.then_some((name, array)))))
}
