//! NumPy arrays, one in an NPY or several in an NPZ: headers by npyz, numbers raw.

use crate::error::{MeasureError, file_name};
use crate::records::arrays::{self, Arrays, SampleTable};
use crate::records::options::{ReadOptions, no_channel};
use crate::records::read::Raw;
use crate::records::stored::{MOST_SAMPLES, NumberKind, StoredChannel, StoredNumber, StoredTable};
use flate2::read::DeflateDecoder;
use npyz::{DType, Endianness, NpyHeader, Order, TypeChar};
use std::fs::File;
use std::io::{self, BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use zip::{CompressionMethod, ZipArchive};

/// Most bytes of shots with alternating samples that are held in memory.
const MOST_TOGETHER: u64 = 1 << 28;

/// Most bytes of a compressed array, which is inflated into a temporary file: 16 GiB.
const MOST_INFLATED: u64 = 1 << 34;

/// Most bytes of a header, which NumPy itself enforces, and most brackets within each other.
const MOST_HEADER: usize = 10_000;
const MOST_NESTED: usize = 16;

pub(crate) fn open_npy(file: &Path, options: &ReadOptions) -> Result<Raw, MeasureError> {
    let entry = NpyEntry { name: String::new(), start: 0, size: u64::MAX, deflated: false };
    let archive = Archive { file: file.to_owned(), entries: vec![entry] };
    arrays::open(Rc::new(archive), options)
}

pub(crate) fn open_npz(file: &Path, options: &ReadOptions) -> Result<Raw, MeasureError> {
    let refused = |detail: String| MeasureError::malformed(file, "NPZ", detail);
    let damaged = |error: zip::result::ZipError| refused(format!("cut short or damaged ({error})"));
    let opened = File::open(file).map_err(|cause| MeasureError::reading(file, cause))?;
    let mut archive = ZipArchive::new(BufReader::new(opened)).map_err(damaged)?;
    let mut entries = Vec::new();
    for index in 0..archive.len() {
        let entry = archive.by_index_raw(index).map_err(damaged)?;
        let name = entry.name().map_err(damaged)?;
        let Some(name) = name.strip_suffix(".npy").map(str::to_owned) else {
            continue;
        };
        let method = entry.compression();
        if method != CompressionMethod::Stored && method != CompressionMethod::DEFLATE {
            let detail = format!("{name} is compressed by {method:?}; use savez_compressed");
            return Err(refused(detail));
        }
        let start = entry.data_start();
        entries.push(NpyEntry {
            start: start.ok_or_else(|| refused(format!("{name} has no place in the file")))?,
            name,
            size: entry.compressed_size(),
            deflated: method == CompressionMethod::DEFLATE,
        });
    }
    let file = file.to_owned();
    arrays::open(Rc::new(Archive { file, entries }), options)
}

/// Arrays by name; a single one has none.
struct Archive {
    file: PathBuf,
    entries: Vec<NpyEntry>,
}

struct NpyEntry {
    name: String,
    start: u64,
    /// Bytes in the file.
    size: u64,
    deflated: bool,
}

struct Array<'a> {
    file: &'a Path,
    entry: &'a NpyEntry,
    shape: Vec<usize>,
    fortran: bool,
    number: StoredNumber,
    /// Bytes before the first number, and of all numbers.
    start: u64,
    length: u64,
}

impl Archive {
    fn array(&self, name: &str) -> Result<Array<'_>, MeasureError> {
        let mut entries = self.entries.iter();
        match entries.find(|entry| entry.name == name) {
            Some(entry) => Array::open(&self.file, entry),
            None => Err(no_channel(&self.file, name, &self.names())),
        }
    }
}

impl Arrays for Archive {
    fn file(&self) -> &Path {
        &self.file
    }

    fn names(&self) -> Vec<String> {
        self.entries.iter().map(|entry| entry.name.clone()).collect()
    }

    fn shape(&self, name: &str) -> Result<Vec<usize>, MeasureError> {
        self.array(name).map(|array| array.shape)
    }

    fn values(&self, name: &str) -> Result<Vec<f64>, MeasureError> {
        self.array(name)?.values()
    }

    fn records(
        &self,
        name: &str,
        interval_s: f64,
        options: &ReadOptions,
    ) -> Result<Raw, MeasureError> {
        self.array(name)?.records(interval_s, options)
    }

    fn cut_short(&self) -> Option<MeasureError> {
        match self.entries.as_slice() {
            [one] if one.name.is_empty() => Array::open(&self.file, one).ok()?.cut_short(),
            _ => None,
        }
    }
}

impl NpyEntry {
    fn bytes(&self, file: &Path) -> io::Result<Box<dyn Read>> {
        let mut opened = File::open(file)?;
        opened.seek(SeekFrom::Start(self.start))?;
        let bytes = BufReader::new(opened).take(self.size);
        Ok(match self.deflated {
            true => Box::new(DeflateDecoder::new(bytes)),
            false => Box::new(bytes),
        })
    }
}

impl<'a> Array<'a> {
    fn open(file: &'a Path, entry: &'a NpyEntry) -> Result<Self, MeasureError> {
        let reading = |cause| MeasureError::reading(file, cause);
        let malformed = |detail: String| MeasureError::malformed(file, "a NumPy array", detail);
        let mut begins = Vec::new();
        let limited = entry.bytes(file).map_err(reading)?;
        let mut limited = limited.take(MOST_HEADER as u64);
        limited.read_to_end(&mut begins).map_err(reading)?;
        let start = header_length(&begins).unwrap_or(begins.len());
        if start > MOST_HEADER {
            let detail = format!("its header claims more than {MOST_HEADER} bytes");
            return Err(malformed(detail));
        }
        begins.truncate(start);
        if nested(&begins) > MOST_NESTED {
            let detail =
                format!("its header has more than {MOST_NESTED} brackets within each other");
            return Err(malformed(detail));
        }
        let header = NpyHeader::from_reader(begins.as_slice());
        let header = header.map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => reading(error),
            _ => malformed(error.to_string()),
        })?;
        let number = number(&header.dtype()).map_err(malformed)?;
        let sizes = header.shape();
        let length = sizes.iter().fold(number.width() as u64, |all, n| all.saturating_mul(*n));
        let sizes = sizes.iter().map(|size| usize::try_from(*size).ok());
        let shape: Option<Vec<usize>> = sizes.collect();
        Ok(Self {
            file,
            entry,
            shape: shape.ok_or_else(|| malformed("an axis is beyond all bounds".to_owned()))?,
            fortran: header.order() == Order::Fortran,
            number,
            start: start as u64,
            length,
        })
    }

    /// The file that holds the numbers, inflated if need be, and where they begin in it.
    fn numbers(&self) -> Result<(File, u64), MeasureError> {
        let reading = |cause| MeasureError::reading(self.file, cause);
        let end = self.start.saturating_add(self.length);
        if self.entry.deflated && end > MOST_INFLATED {
            let detail = "a compressed array of more than 16 GiB; save it with numpy.savez";
            return Err(MeasureError::malformed(self.file, "NPZ", detail));
        }
        if self.entry.deflated {
            let bytes = self.entry.bytes(self.file).map_err(reading)?;
            let mut inflated = tempfile::tempfile().map_err(reading)?;
            io::copy(&mut bytes.take(end), &mut inflated).map_err(reading)?;
            return Ok((inflated, self.start));
        }
        if end > self.entry.size {
            let detail = format!("{} of {end} bytes of an array", self.entry.size);
            return Err(MeasureError::truncated(file_name(self.file), detail));
        }
        let opened = File::open(self.file).map_err(reading)?;
        Ok((opened, self.entry.start + self.start))
    }

    /// All numbers of a small array, in the order in which they are stored.
    fn values(&self) -> Result<Vec<f64>, MeasureError> {
        let wide = self.number.width();
        let count = self.length / wide as u64;
        if count > MOST_SAMPLES as u64 {
            return Err(MeasureError::too_long(file_name(self.file), MOST_SAMPLES));
        }
        let (mut reader, start) = self.numbers()?;
        let count = count as usize;
        let all = StoredChannel::run(self.number, start, count, wide);
        let values = all.read(&mut reader, 0, 0..count);
        values.map_err(|cause| MeasureError::reading(self.file, cause))
    }

    /// Whether the file ends before its numbers do, as its header counts them.
    fn cut_short(&self) -> Option<MeasureError> {
        let there = self.file.metadata().ok()?.len().saturating_sub(self.start);
        let detail = format!("{there} of {} bytes of numbers are there", self.length);
        (there < self.length).then(|| MeasureError::truncated(file_name(self.file), detail))
    }

    fn records(&self, interval_s: f64, options: &ReadOptions) -> Result<Raw, MeasureError> {
        let part = Some(self.entry.name.clone()).filter(|name| !name.is_empty());
        let table = SampleTable::new(self.file, part, &self.shape, interval_s, options)?;
        let strides = self.strides();
        let stride = |axis: Option<usize>| axis.map_or(0, |axis| strides[axis]);
        let (frames, wide) = (table.head.frames, self.number.width());
        let between = strides[table.axes.time];
        let (mut reader, start) = self.numbers()?;
        let file = self.file.to_owned();
        let alternating = table.axes.channels.is_none() && stride(table.axes.shots) < between;
        if table.head.rows > 1 && alternating && self.length <= MOST_TOGETHER {
            let mut bytes = Vec::new();
            let read = reader.seek(SeekFrom::Start(start));
            let read = read.and_then(|_| reader.take(self.length).read_to_end(&mut bytes));
            let read = read.map_err(|cause| MeasureError::reading(self.file, cause))? as u64;
            if read < self.length {
                let detail = format!("{read} of {} bytes of numbers are there", self.length);
                return Err(MeasureError::truncated(file_name(self.file), detail));
            }
            let transposed = StoredTable {
                file,
                reader: Cursor::new(transposed(&bytes, wide, table.head.rows)),
                channels: vec![StoredChannel::run(self.number, 0, frames, wide)],
                row_bytes: (frames * wide) as u64,
            };
            return Ok(table.head.records(options.parts, transposed));
        }
        let channel = |at: &usize| {
            let skipped = (*at as u64).saturating_mul(stride(table.axes.channels) as u64);
            let first = start.saturating_add(skipped);
            StoredChannel::run(self.number, first, frames, between)
        };
        let stored = StoredTable {
            file,
            reader,
            channels: table.chosen.iter().map(channel).collect(),
            row_bytes: stride(table.axes.shots) as u64,
        };
        Ok(table.head.records(options.parts, stored))
    }

    /// Bytes from a number to the next along each axis.
    fn strides(&self) -> Vec<usize> {
        let mut strides = vec![0; self.shape.len()];
        let mut stride = self.number.width();
        let mut set = |axis: usize| {
            strides[axis] = stride;
            stride = stride.saturating_mul(self.shape[axis]);
        };
        match self.fortran {
            true => (0..self.shape.len()).for_each(&mut set),
            false => (0..self.shape.len()).rev().for_each(&mut set),
        }
        strides
    }
}

/// Numbers of shots whose samples alternate, shot by shot.
fn transposed(bytes: &[u8], wide: usize, shots: usize) -> Vec<u8> {
    let frames = bytes.len() / (wide * shots);
    let mut turned = Vec::with_capacity(bytes.len());
    for shot in 0..shots {
        let places = (0..frames).map(|frame| (frame * shots + shot) * wide);
        places.for_each(|at| turned.extend_from_slice(&bytes[at..at + wide]));
    }
    turned
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

/// How items are stored, or why they are not read.
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
