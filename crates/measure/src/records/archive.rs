//! Arrays of numbers by name in one file: read row by row, inflated first if they are compressed.

use crate::error::{MeasureError, Result, file_name};
use crate::records::arrays::{Arrays, SampleTable};
use crate::records::options::{ReadOptions, no_channel};
use crate::records::read::Raw;
use crate::records::stored::{MOST_SAMPLES, StoredChannel, StoredNumber};
use flate2::read::{DeflateDecoder, ZlibDecoder};
use indexmap::IndexMap;
use std::fs::File;
use std::io::{self, BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Most bytes of shots with alternating samples that are held in memory.
const MOST_TOGETHER: u64 = 1 << 28;

/// Most bytes of a compressed array, which is inflated into a temporary file: 16 GiB.
pub(super) const MOST_INFLATED: u64 = 1 << 34;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Packing {
    Plain,
    Deflate,
    Zlib,
}

#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    pub start: u64,
    /// Bytes in the file.
    pub size: u64,
    pub packing: Packing,
    /// The temporary file that these are of, if it is not the recording.
    inflated: Option<Rc<File>>,
}

impl Stretch {
    pub(super) fn new(start: u64, size: u64, packing: Packing) -> Self {
        Self { start, size, packing, inflated: None }
    }

    /// The same without its first bytes, of what is not compressed.
    pub(super) fn after(&self, bytes: u64) -> Self {
        let (start, size) = (self.start.saturating_add(bytes), self.size.saturating_sub(bytes));
        Self { start, size, ..self.clone() }
    }

    /// The same, not compressed: at most so many bytes of what is go into a temporary file.
    pub(super) fn inflated(&self, file: &Path, most: u64) -> Result<Self> {
        if self.packing == Packing::Plain {
            return Ok(self.clone());
        }
        let copy = || {
            let mut copy = tempfile::tempfile()?;
            let size = io::copy(&mut self.bytes(file)?.take(most), &mut copy)?;
            Ok(Self { inflated: Some(Rc::new(copy)), ..Self::new(0, size, Packing::Plain) })
        };
        copy().map_err(|cause| MeasureError::reading(file, cause))
    }

    fn open(&self, file: &Path) -> io::Result<File> {
        self.inflated.as_ref().map_or_else(|| File::open(file), |copy| copy.try_clone())
    }

    fn bytes(&self, file: &Path) -> io::Result<Box<dyn Read>> {
        let mut opened = self.open(file)?;
        opened.seek(SeekFrom::Start(self.start))?;
        let bytes = BufReader::new(opened).take(self.size);
        Ok(match self.packing {
            Packing::Plain => Box::new(bytes),
            Packing::Deflate => Box::new(DeflateDecoder::new(bytes)),
            Packing::Zlib => Box::new(ZlibDecoder::new(bytes)),
        })
    }

    pub(super) fn beginning(&self, file: &Path, most: usize) -> Result<Vec<u8>> {
        let mut begins = Vec::new();
        let read = self.bytes(file).and_then(|it| it.take(most as u64).read_to_end(&mut begins));
        read.map_err(|cause| MeasureError::reading(file, cause))?;
        Ok(begins)
    }
}

/// Where the numbers of an array are, and how they are encoded.
#[derive(Clone, Debug)]
pub(crate) struct StoredArray {
    pub within: Stretch,
    pub shape: Vec<usize>,
    /// Whether the first axis is the one along which numbers lie side by side.
    pub fortran: bool,
    pub number: StoredNumber,
    /// Bytes before the first number, and of all numbers.
    pub start: u64,
    pub length: u64,
}

/// Arrays by name, or why one is not read; a single one may have none.
pub(crate) struct Archive {
    pub file: PathBuf,
    pub arrays: IndexMap<String, Result<StoredArray>>,
}

impl Archive {
    fn array(&self, name: &str) -> Result<&StoredArray> {
        match self.arrays.get(name) {
            Some(array) => array.as_ref().map_err(Clone::clone),
            None => Err(no_channel(&self.file, name, &self.names())),
        }
    }
}

impl Arrays for Archive {
    fn file(&self) -> &Path {
        &self.file
    }

    fn names(&self) -> Vec<String> {
        self.arrays.keys().cloned().collect()
    }

    fn shape(&self, name: &str) -> Result<Vec<usize>> {
        self.array(name).map(|array| array.shape.clone())
    }

    fn values(&self, name: &str) -> Result<Vec<f64>> {
        self.array(name)?.values(&self.file)
    }

    fn records(&self, name: &str, interval_s: f64, options: &ReadOptions) -> Result<Raw> {
        let part = Some(name.to_owned()).filter(|name| !name.is_empty());
        let array = self.array(name)?;
        let table = SampleTable::new(&self.file, part, &array.shape, interval_s, options)?;
        array.records(&self.file, table, options)
    }

    fn cut_short(&self) -> Option<MeasureError> {
        let (name, array) = self.arrays.first()?;
        array.as_ref().ok()?.cut_short(&self.file).filter(|_| name.is_empty())
    }
}

impl StoredArray {
    /// The file that holds the numbers, inflated if need be, and where they begin in it.
    fn numbers(&self, file: &Path) -> Result<(File, u64)> {
        let reading = |cause| MeasureError::reading(file, cause);
        let end = self.start.saturating_add(self.length);
        let is_plain = self.within.packing == Packing::Plain;
        if is_plain && end > self.within.size {
            let detail = format!("{} of {end} bytes of an array", self.within.size);
            return Err(MeasureError::truncated(file_name(file), detail));
        }
        if !is_plain && end > MOST_INFLATED {
            let detail = "a compressed array of more than 16 GiB; save it uncompressed";
            return Err(MeasureError::malformed(file, "an archive", detail));
        }
        let plain = self.within.inflated(file, end)?;
        Ok((plain.open(file).map_err(reading)?, plain.start + self.start))
    }

    /// All numbers of a small array, in the order in which they are stored.
    fn values(&self, file: &Path) -> Result<Vec<f64>> {
        let wide = self.number.width();
        let count = self.length / wide as u64;
        if count > MOST_SAMPLES as u64 {
            return Err(MeasureError::too_long(file_name(file), MOST_SAMPLES));
        }
        let (mut reader, start) = self.numbers(file)?;
        let count = count as usize;
        let all = StoredChannel::run(self.number, start, count, wide);
        let values = all.read(&mut reader, 0, 0..count);
        values.map_err(|cause| MeasureError::reading(file, cause))
    }

    /// Whether the file ends before its numbers do, as its header counts them.
    fn cut_short(&self, file: &Path) -> Option<MeasureError> {
        let there = file.metadata().ok()?.len().saturating_sub(self.start);
        let detail = format!("{there} of {} bytes of numbers are there", self.length);
        (there < self.length).then(|| MeasureError::truncated(file_name(file), detail))
    }

    fn records(&self, file: &Path, table: SampleTable, options: &ReadOptions) -> Result<Raw> {
        let strides = self.strides();
        let stride = |axis: Option<usize>| axis.map_or(0, |axis| strides[axis]);
        let (frames, wide) = (table.head.frames, self.number.width());
        let between = strides[table.axes.time];
        let (mut reader, start) = self.numbers(file)?;
        let alternating = table.axes.channels.is_none() && stride(table.axes.shots) < between;
        if table.head.rows > 1 && alternating && self.length <= MOST_TOGETHER {
            let mut bytes = Vec::new();
            let read = reader.seek(SeekFrom::Start(start));
            let read = read.and_then(|_| reader.take(self.length).read_to_end(&mut bytes));
            let read = read.map_err(|cause| MeasureError::reading(file, cause))? as u64;
            if read < self.length {
                let detail = format!("{read} of {} bytes of numbers are there", self.length);
                return Err(MeasureError::truncated(file_name(file), detail));
            }
            let transposed = Cursor::new(transposed(&bytes, wide, table.head.rows));
            let channels = vec![StoredChannel::run(self.number, 0, frames, wide)];
            let row_bytes = (frames * wide) as u64;
            return Ok(table.head.stored(options.parts, transposed, channels, row_bytes));
        }
        let channel = |at: &usize| {
            let skipped = (*at as u64).saturating_mul(stride(table.axes.channels) as u64);
            let first = start.saturating_add(skipped);
            StoredChannel::run(self.number, first, frames, between)
        };
        let channels = table.chosen.iter().map(channel).collect();
        Ok(table.head.stored(options.parts, reader, channels, stride(table.axes.shots) as u64))
    }

    fn strides(&self) -> Vec<usize> {
        let mut strides = vec![0; self.shape.len()];
        let mut stride = self.number.width();
        for nth in 0..self.shape.len() {
            let axis = if self.fortran { nth } else { self.shape.len() - 1 - nth };
            strides[axis] = stride;
            stride = stride.saturating_mul(self.shape[axis]);
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
