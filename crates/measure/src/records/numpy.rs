//! NumPy arrays, one in an NPY or several in an NPZ: headers by npyz, numbers raw.

use crate::error::{MeasureError, file_name};
use crate::records::arrays::{self, Arrays, Table, time_column};
use crate::records::interval::interval_s;
use crate::records::options::{ReadOptions, no_channel};
use crate::records::read::Raw;
use crate::records::record::Samples;
use crate::records::stream::{Cut, Head, Kind, MOST_SAMPLES, Number, RawNumbers, Stream};
use flate2::read::DeflateDecoder;
use npyz::{DType, Endianness, NpyHeader, Order, TypeChar};
use std::collections::HashMap;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom, Take};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use zip::{CompressionMethod, ZipArchive};

/// Most numbers of shots with alternating samples that are read together.
const MOST_TOGETHER: usize = 1 << 25;

/// Numbers of all shots with alternating samples that are read at a time.
const BLOCK: usize = 1 << 22;

/// Most bytes of a header: NumPy itself reads no longer ones, and a table's has a hundred.
const MOST_HEADER: usize = 10_000;

/// Most brackets within each other in a header.
const MOST_NESTED: usize = 16;

/// Bytes of magic, version, and length in the first version.
const FIXED: usize = 10;

fn malformed(file: &Path, detail: impl std::fmt::Display) -> MeasureError {
    MeasureError::malformed(file, "a NumPy array", detail)
}

/// Opens one array.
pub(crate) fn open_npy(file: &Path, options: &ReadOptions) -> Result<Raw, MeasureError> {
    let place = Place {
        file: file.to_owned(),
        start: 0,
        size: u64::MAX,
        deflated: false,
    };
    let array = Array::open(place.clone(), None)?;
    let look = |options: &ReadOptions| Array::open(place.clone(), None)?.records(1.0, options);
    let (read, stated_s, note) = match time_column(&array.shape, options, &look) {
        Some(times) => (times.options, times.interval_s, times.note),
        None => (options.clone(), None, None),
    };
    // That half a file is missing is reported before a rate is asked for.
    let interval_s =
        interval_s(file, stated_s, options).map_err(|error| array.cut_short().unwrap_or(error))?;
    let records = array.records(interval_s, &read)?;
    Ok(Box::new(records.map(move |record| {
        let mut record = record?;
        record.notes.extend(note.clone());
        Ok(record)
    })))
}

/// Opens an archive of arrays.
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
        let start = start.ok_or_else(|| refused(format!("{name} has no place in the file")))?;
        let place = Place {
            file: file.to_owned(),
            start,
            size: entry.compressed_size(),
            deflated: method == CompressionMethod::DEFLATE,
        };
        entries.push((name, place));
    }
    let names = entries.iter().enumerate().rev();
    let archive = Archive {
        file: file.to_owned(),
        by_name: names.map(|(at, entry)| (entry.0.clone(), at)).collect(),
        entries,
    };
    arrays::open(Rc::new(archive), options)
}

/// An archive of arrays, by name.
struct Archive {
    file: PathBuf,
    entries: Vec<(String, Place)>,
    /// Places in that list.
    by_name: HashMap<String, usize>,
}

impl Archive {
    fn array(&self, name: &str) -> Result<Array, MeasureError> {
        match self.by_name.get(name).map(|at| &self.entries[*at]) {
            Some((name, place)) => Array::open(place.clone(), Some(name.clone())),
            None => Err(no_channel(&self.file, name, &self.names())),
        }
    }
}

impl Arrays for Archive {
    fn file(&self) -> &Path {
        &self.file
    }

    fn names(&self) -> Vec<String> {
        self.entries.iter().map(|entry| entry.0.clone()).collect()
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
}

/// Where an array lies in a file.
#[derive(Clone, Debug)]
struct Place {
    file: PathBuf,
    start: u64,
    /// Bytes in the file.
    size: u64,
    deflated: bool,
}

/// The bytes of an array that are still to come.
enum Bytes {
    Plain(Take<BufReader<File>>),
    Deflated(DeflateDecoder<Take<BufReader<File>>>),
}

impl Place {
    fn open(&self) -> io::Result<Bytes> {
        let mut opened = File::open(&self.file)?;
        opened.seek(SeekFrom::Start(self.start))?;
        let bytes = BufReader::with_capacity(1 << 16, opened).take(self.size);
        Ok(match self.deflated {
            true => Bytes::Deflated(DeflateDecoder::new(bytes)),
            false => Bytes::Plain(bytes),
        })
    }
}

impl Bytes {
    /// Bytes left in the file, of what is not deflated.
    fn left(&self) -> Option<u64> {
        let Self::Plain(bytes) = self else {
            return None;
        };
        let inner = bytes.get_ref();
        let mut file = inner.get_ref();
        let (size, at) = (file.metadata().ok()?.len(), file.stream_position().ok()?);
        let left = size.saturating_sub(at) + inner.buffer().len() as u64;
        Some(left.min(bytes.limit()))
    }

    /// Leaves out what comes next; where it ends before, nothing comes any more.
    fn skip(&mut self, count: u64) -> io::Result<()> {
        match self {
            Self::Plain(bytes) => {
                let count = count.min(bytes.limit());
                bytes.set_limit(bytes.limit() - count);
                let inner = bytes.get_mut();
                inner.seek_relative(i64::try_from(count).unwrap_or(i64::MAX))
            }
            Self::Deflated(bytes) => {
                io::copy(&mut bytes.by_ref().take(count), &mut io::sink()).map(|_| ())
            }
        }
    }
}

impl Read for Bytes {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Plain(bytes) => bytes.read(into),
            Self::Deflated(bytes) => bytes.read(into),
        }
    }
}

/// An array whose numbers are still to be read.
struct Array {
    place: Place,
    /// Its name in an NPZ.
    part: Option<String>,
    shape: Vec<usize>,
    fortran: bool,
    number: Number,
    /// Its numbers from the first on.
    bytes: Bytes,
}

impl Array {
    fn open(place: Place, part: Option<String>) -> Result<Self, MeasureError> {
        let (header, bytes) = opened(&place)?;
        let number = number(&header.dtype()).map_err(|detail| malformed(&place.file, detail))?;
        let sizes = header.shape().iter();
        let shape: Option<Vec<usize>> = sizes.map(|size| usize::try_from(*size).ok()).collect();
        let shape = shape.ok_or_else(|| malformed(&place.file, "an axis is beyond all bounds"))?;
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
    fn values(self) -> Result<Vec<f64>, MeasureError> {
        let mut sizes = self.shape.iter();
        let count = sizes.try_fold(1, |n: usize, axis| n.checked_mul(*axis));
        let count = count
            .filter(|count| *count <= MOST_SAMPLES)
            .ok_or_else(|| MeasureError::too_long(file_name(&self.place.file), MOST_SAMPLES))?;
        let samples = self.stream(vec![0], 1).take(count)?;
        Ok(samples.first().map(Samples::volts).unwrap_or_default())
    }

    /// Whether the file ends before its numbers do, as its header counts them.
    fn cut_short(&self) -> Option<MeasureError> {
        let sizes = self.shape.iter().map(|size| *size as u64);
        let bytes = sizes.fold(self.number.width() as u64, u64::saturating_mul);
        let there = self.bytes.left().filter(|there| *there < bytes)?;
        let detail = format!("{there} of {bytes} bytes of numbers are there");
        Some(MeasureError::truncated(file_name(&self.place.file), detail))
    }

    /// The records of an array of samples.
    fn records(self, interval_s: f64, options: &ReadOptions) -> Result<Raw, MeasureError> {
        let (place, shape) = (&self.place, &self.shape);
        let fortran = self.fortran && shape.len() > 1;
        if fortran && shape.len() > 2 {
            let detail = "its three axes are stored column by column; save it with order C";
            return Err(malformed(&place.file, detail));
        }
        let table = Table::of(&place.file, self.part.clone(), shape, interval_s, options)?;
        let (shots, channels) = (table.axes.shots, table.axes.channels);
        let head = table.head.clone().divided(options.parts);
        // Numbers of the last axis lie side by side; column by column those of the first.
        let adjacent = if fortran { 0 } else { 1 };
        if channels.is_none() && shots == Some(adjacent) {
            return match table.shots.saturating_mul(table.frames) <= MOST_TOGETHER {
                true => Ok(self.all_shots(table)),
                false => Ok(Box::new(Cut::new(head, self.passes(&table)))),
            };
        }
        let planar = channels.is_some_and(|axis| (axis == 0) != fortran || shots.is_some());
        Ok(match planar {
            true => Box::new(Cut::new(head, self.planes(&table)?)),
            false => Box::new(Cut::new(head, self.stream(table.chosen, table.stored))),
        })
    }

    /// Numbers of some channels that lie side by side.
    fn stream(self, chosen: Vec<usize>, stored: usize) -> RawNumbers<Bytes> {
        RawNumbers {
            reader: self.bytes,
            file: self.place.file,
            number: self.number,
            stored,
            chosen,
        }
    }

    /// Shots of which samples alternate, read together.
    fn all_shots(self, table: Table) -> Raw {
        let Table { shots, head, .. } = table;
        let shots = match self.stream((0..shots).collect(), shots).take(head.each) {
            Ok(shots) => shots,
            Err(error) => return Box::new(std::iter::once(Err(error))),
        };
        let record = move |(row, samples)| Ok(Head::record(&head, row * head.row, vec![samples]));
        Box::new(shots.into_iter().enumerate().map(record))
    }

    fn passes(self, table: &Table) -> Passes {
        Passes {
            place: self.place,
            number: self.number,
            shots: table.shots,
            frames: table.frames,
            at: 0,
            current: None,
        }
    }

    /// A place in the file for every channel that is wanted.
    fn planes(&self, table: &Table) -> Result<Planes, MeasureError> {
        let plane = (table.frames as u64).saturating_mul(self.number.width() as u64);
        let channel = |channel: &usize| {
            let mut numbers = numbers(&self.place, self.number, 0, 1)?;
            let skipped = numbers.reader.skip(plane.saturating_mul(*channel as u64));
            skipped.map_err(|cause| MeasureError::reading(&self.place.file, cause))?;
            Ok(numbers)
        };
        let channels: Result<_, MeasureError> = table.chosen.iter().map(channel).collect();
        Ok(Planes {
            channels: channels?,
            between: plane.saturating_mul(table.stored.saturating_sub(1) as u64),
            frames: table.frames,
            at: 0,
        })
    }
}

/// The numbers of an array from the first on: one of so many that alternate.
fn numbers(
    place: &Place,
    number: Number,
    chosen: usize,
    stored: usize,
) -> Result<RawNumbers<Bytes>, MeasureError> {
    Ok(RawNumbers {
        reader: opened(place)?.1,
        file: place.file.clone(),
        number,
        stored,
        chosen: vec![chosen],
    })
}

/// Channels of which each is stored in one stretch a shot, with a place in the file for each.
struct Planes {
    /// One that begins with its own first sample for each channel.
    channels: Vec<RawNumbers<Bytes>>,
    /// Bytes from the end of a channel's stretch to where its next one begins.
    between: u64,
    /// Samples of a stretch.
    frames: usize,
    /// Samples that are read.
    at: usize,
}

impl Stream for Planes {
    fn take(&mut self, count: usize) -> Result<Vec<Samples>, MeasureError> {
        let between = match self.at > 0 && self.at.is_multiple_of(self.frames) {
            true => self.between,
            false => 0,
        };
        self.at += count;
        let mut taken = Vec::new();
        for channel in &mut self.channels {
            let skipped = channel.reader.skip(between);
            skipped.map_err(|cause| MeasureError::reading(&channel.file, cause))?;
            taken.extend(channel.take(count)?);
        }
        Ok(taken)
    }
}

/// Shots whose samples alternate, too many to be read together: one pass over the file for each.
struct Passes {
    place: Place,
    number: Number,
    shots: usize,
    /// Samples of a shot.
    frames: usize,
    /// Samples that are read, of one shot after the other.
    at: usize,
    current: Option<RawNumbers<Bytes>>,
}

impl Stream for Passes {
    fn take(&mut self, count: usize) -> Result<Vec<Samples>, MeasureError> {
        let mut shot = match self.current.take() {
            Some(shot) if !self.at.is_multiple_of(self.frames) => shot,
            _ => numbers(&self.place, self.number, self.at / self.frames, self.shots)?,
        };
        let block = (BLOCK / self.shots).max(1);
        let mut all: Option<Samples> = None;
        for start in (0..count).step_by(block) {
            for part in shot.take(block.min(count - start))? {
                match &mut all {
                    Some(all) => all.append(part),
                    None => all = Some(part),
                }
            }
        }
        self.at += count;
        self.current = Some(shot);
        Ok(all.into_iter().collect())
    }
}

/// An array's header, and its numbers after it.
fn opened(place: &Place) -> Result<(NpyHeader, Bytes), MeasureError> {
    let reading = |cause| MeasureError::reading(&place.file, cause);
    let mut bytes = place.open().map_err(reading)?;
    let mut begins = Vec::new();
    let mut take = |count: usize| {
        let mut limited = bytes.by_ref().take(count as u64);
        limited.read_to_end(&mut begins).map_err(reading)?;
        Ok(begins.clone())
    };
    let more = header_length(&take(FIXED)?).unwrap_or(0).min(MOST_HEADER);
    let begins = take(more)?;
    if let Some(detail) = hostile(&begins) {
        return Err(malformed(&place.file, detail));
    }
    let header = NpyHeader::from_reader(begins.chain(&mut bytes));
    let header = header.map_err(|error| match error.kind() {
        io::ErrorKind::UnexpectedEof => reading(error),
        _ => malformed(&place.file, error),
    })?;
    Ok((header, bytes))
}

/// Bytes of the header after the first ten, as these state it.
fn header_length(begins: &[u8]) -> Option<usize> {
    let (version, low) = (begins.get(6)?, begins.get(8..10)?);
    let low = usize::from(u16::from_le_bytes(low.try_into().ok()?));
    match version {
        1 => Some(low),
        // The other two bytes of the length follow; a length in them is beyond all bounds.
        _ => Some(low + 2),
    }
}

/// Why a header is not parsed: it claims too many bytes, or would nest too deep.
fn hostile(begins: &[u8]) -> Option<String> {
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
            return Some(format!(
                "its header has more than {MOST_NESTED} brackets within each other"
            ));
        }
    }
    None
}

/// How items are stored, or why they are not read.
fn number(dtype: &DType) -> Result<Number, String> {
    let DType::Plain(plain) = dtype else {
        return Err(no_number(dtype));
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
        (TypeChar::Float, bytes) => {
            return Err(format!(
                "its items are floating-point numbers of {bytes} bytes, of which every machine \
                 has others; save them as float64"
            ));
        }
        _ => return Err(no_number(dtype)),
    };
    let big_endian = plain.endianness() == Endianness::Big;
    Ok(Number::plain(kind, big_endian))
}

fn no_number(dtype: &DType) -> String {
    let items = dtype.descr();
    format!("its items are {items}, not real numbers; save a plain array")
}
