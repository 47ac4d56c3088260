//! MATLAB's files of the versions 4 and 5: headers here, numbers raw. Version 7.3 is HDF5.

use crate::error::{MeasureError, Result, file_name};
use crate::records::archive::{Archive, MOST_INFLATED, Packing, StoredArray, Stretch};
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
/// Classes of cells, of structs, and of arrays of numbers, from double to the unsigned integer of
/// 64 bits, and the flag of complex ones.
const CELLS: u32 = 1;
const FIELDS: u32 = 2;
const NUMBERS: std::ops::RangeInclusive<u32> = 6..=15;
const COMPLEX: u32 = 1 << 11;

/// Most bytes before the first number of an array: flags, axes and a name.
const MOST_HEADER: usize = 4096;
const MOST_ARRAYS: usize = 100_000;

/// Most cells and structs in which an array is.
pub(super) const DEEPEST: usize = 8;

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
        let (end, found) = next.filter(|next| next.0 > at).ok_or_else(cut_short)?;
        arrays.extend(found.into_iter().map(|(name, array)| (name, Ok(array))));
        at = end;
    }
    if arrays.is_empty() {
        return Err(arrays::no_samples(file, &[]));
    }
    arrays::open(Rc::new(Archive { file: file.to_owned(), arrays }), options)
}

fn beginning(file: &Path, start: u64, size: u64, packing: Packing) -> Result<Vec<u8>> {
    Stretch::new(start, size, packing).beginning(file, MOST_HEADER)
}

/// The end of what begins at a byte, and the arrays of real numbers in it; `None` of what is cut short
/// or no element.
type Next = Option<(u64, Vec<(String, StoredArray)>)>;

fn element(file: &Path, (at, length): (u64, u64), big_endian: bool) -> Result<Next> {
    let tag = beginning(file, at, TAG, Packing::Plain)?;
    let mut bytes = HeaderBytes { left: &tag, big_endian };
    let (Some(kind), Some(size)) = (bytes.u32(), bytes.u32()) else {
        return Ok(None);
    };
    let (start, size) = (at + TAG, u64::from(size));
    let within = match kind {
        COMPRESSED => Stretch::new(start, size, Packing::Zlib),
        // With its tag, as an inflated element has one.
        MATRIX => Stretch::new(at, TAG + size, Packing::Plain),
        _ => return Ok(Some((start + size, Vec::new())).filter(|next| next.0 <= length)),
    };
    if start + size > length {
        return Ok(None);
    }
    let mut matrices = Matrices { file, big_endian, arrays: Vec::new() };
    matrices.add(&within, None, 0)?;
    Ok(Some((start + size, matrices.arrays)))
}

/// Arrays of real numbers as they are found in matrices of version 5, which may hold others.
struct Matrices<'a> {
    file: &'a Path,
    big_endian: bool,
    arrays: Vec<(String, StoredArray)>,
}

impl Matrices<'_> {
    /// Adds the array of the matrix with which a stretch begins, or those of its cells or fields, named
    /// as MATLAB names them but for `/` before a field. Returns the matrix's bytes.
    fn add(&mut self, within: &Stretch, name: Option<String>, depth: usize) -> Result<u64> {
        let begins = within.beginning(self.file, MOST_HEADER)?;
        let mut tag = HeaderBytes { left: &begins, big_endian: self.big_endian };
        let (Some(_), Some(size)) = (tag.u32(), tag.u32()) else {
            return Ok(u64::MAX);
        };
        let end = TAG + u64::from(size);
        let most = usize::try_from(end).unwrap_or(usize::MAX).min(begins.len());
        let header = &begins[..most];
        let Some(matrix) = Matrix::parse(header, self.big_endian) else {
            return Ok(end);
        };
        let name = name.unwrap_or_else(|| matrix.name.clone());
        let from = (header.len() - matrix.data.left.len()) as u64;
        match matrix.flags & 0xff {
            _ if name.is_empty() || depth > DEEPEST => {}
            CELLS => {
                let count = matrix.count();
                let cell = |at| cell_name(&name, &matrix.shape, at);
                self.add_all(within, (from, end), (count, &cell), depth + 1)?;
            }
            FIELDS => {
                let (fields, bytes) = matrix.fields().unwrap_or_default();
                let count = matrix.count().saturating_mul(fields.len());
                let field = |at| field_name(&name, &fields, (matrix.count(), at));
                self.add_all(within, (from + bytes, end), (count, &field), depth + 1)?;
            }
            _ => {
                let array = matrix.numbers(within, header.len());
                self.arrays.extend(array.map(|array| (name, array)));
            }
        }
        Ok(end)
    }

    /// Adds those of matrices that follow each other between two bytes.
    fn add_all(
        &mut self,
        within: &Stretch,
        (mut at, end): (u64, u64),
        (count, name): (usize, &dyn Fn(usize) -> String),
        depth: usize,
    ) -> Result<()> {
        let within = within.inflated(self.file, MOST_INFLATED)?;
        for number in 0..count {
            if at >= end || self.arrays.len() >= MOST_ARRAYS {
                break;
            }
            at = at.saturating_add(self.add(&within.after(at), Some(name(number)), depth)?);
        }
        Ok(())
    }
}

/// Of a table of cells, rows are shots.
pub(super) fn cell_name(name: &str, shape: &[usize], at: usize) -> String {
    match *shape {
        [rows, columns] if rows > 1 && columns > 1 => {
            format!("{name}{{{}}}/{}", at % rows + 1, at / rows + 1)
        }
        _ => format!("{name}{{{}}}", at + 1),
    }
}

fn field_name(name: &str, fields: &[String], (structs, at): (usize, usize)) -> String {
    let field = &fields[at % fields.len()];
    match structs {
        1 => format!("{name}/{field}"),
        _ => format!("{name}({})/{field}", at / fields.len() + 1),
    }
}

/// The header of a matrix, and what follows: numbers, cells, or names of fields and fields.
struct Matrix<'a> {
    flags: u32,
    shape: Vec<usize>,
    name: String,
    data: HeaderBytes<'a>,
}

impl<'a> Matrix<'a> {
    fn parse(header: &'a [u8], big_endian: bool) -> Option<Self> {
        let mut bytes = HeaderBytes { left: header, big_endian };
        bytes.take(TAG as usize)?;
        let flags = HeaderBytes { left: part(&mut bytes)?.1, big_endian }.u32()?;
        let axes = part(&mut bytes)?.1;
        let kind = StoredNumber::plain(NumberKind::U32, big_endian);
        let shape = kind.scaled(axes).iter().map(|axis| *axis as usize).collect();
        let name = String::from_utf8_lossy(part(&mut bytes)?.1).into_owned();
        Some(Self { flags, shape, name, data: bytes })
    }

    fn count(&self) -> usize {
        self.shape.iter().fold(1, |all, size| all.saturating_mul(*size))
    }

    /// Names of the fields of structs, and the bytes that they take.
    fn fields(&self) -> Option<(Vec<String>, u64)> {
        let mut bytes = HeaderBytes { left: self.data.left, big_endian: self.data.big_endian };
        let length = HeaderBytes { left: part(&mut bytes)?.1, ..bytes }.u32()? as usize;
        let names = part(&mut bytes)?.1.chunks(Some(length).filter(|length| *length > 0)?);
        let name = |padded: &[u8]| {
            let name = padded.split(|byte| *byte == 0).next().unwrap_or_default();
            String::from_utf8_lossy(name).into_owned()
        };
        let names = names.map(name).collect();
        Some((names, (self.data.left.len() - bytes.left.len()) as u64))
    }

    /// Where its numbers are, if it has real ones, behind a header of so many bytes at most.
    fn numbers(mut self, within: &Stretch, header: usize) -> Option<StoredArray> {
        if !NUMBERS.contains(&(self.flags & 0xff)) || self.flags & COMPLEX != 0 {
            return None;
        }
        let (code, size, is_small) = sub_tag(&mut self.data)?;
        // The data of a small element are in its tag.
        let before = header - self.data.left.len() - if is_small { 4 } else { 0 };
        Some(StoredArray {
            within: within.clone(),
            shape: self.shape,
            fortran: true,
            number: StoredNumber::plain(number_kind(code)?, self.data.big_endian),
            start: before as u64,
            length: size as u64,
        })
    }
}

fn number_kind(code: u32) -> Option<NumberKind> {
    Some(match code {
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
    })
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
    let within = Stretch::new(at, length - at, Packing::Plain);
    let array = StoredArray { within, shape, fortran: true, number, start, length: count };
    let end = at.saturating_add(start).saturating_add(count);
    let end = Some(end).filter(|end| *end <= length);
    let array = is_numbers.then_some((name, array)).into_iter();
    Ok(end.map(|end| (end, array.collect())))
}
