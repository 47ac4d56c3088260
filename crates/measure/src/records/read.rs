//! Records of a file of any format, one by one.

use crate::ShotList;
use crate::error::{MeasureError, Result, file_name};
#[cfg(feature = "hdf5")]
use crate::records::hdf5::open as open_hdf5;
use crate::records::options::{Parts, ReadOptions};
use crate::records::record::{Channel, Record, SEPARATE};
use crate::records::stored::from_sample;
use crate::records::{mat, numpy, tdms, text, wav};
use crate::signal::{extremes, median};
use std::fs::File;
use std::io::Read;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

pub(crate) type Raw = Box<dyn Iterator<Item = Result<Record>>>;

/// Most records of a file: an array of more rows is one of something else.
const MOST_RECORDS: usize = 100_000;

const PROBE: u64 = 4096;

/// Most samples of a channel that are not finite, as a share.
const MOST_FILLED: f64 = 0.01;

/// Name of a format, whether a file that begins so has it, its extensions, and its reader.
type Format = (&'static str, fn(&[u8]) -> bool, &'static [&'static str], Open);
type Open = fn(&Path, &ReadOptions) -> Result<Raw>;

/// All formats; text, which no bytes begin, last.
#[rustfmt::skip]
const FORMATS: [Format; 7] = [
    ("HDF5", is_hdf5, &["h5", "hdf5", "hdf", "mat"], open_hdf5),
    ("a NumPy array", |it| it.starts_with(b"\x93NUMPY"), &["npy"], numpy::open_npy),
    ("a ZIP archive, as NPZ files are", |it| it.starts_with(b"PK\x03\x04"), &["npz"], numpy::open_npz),
    ("RIFF WAVE", |it| it.starts_with(b"RIFF"), &["wav", "wave"], wav::open),
    ("TDMS", |it| it.starts_with(b"TDSm"), &["tdms"], tdms::open),
    ("MATLAB's", mat::is_mat, &["mat"], mat::open),
    ("text", is_text, &["csv", "tsv", "txt", "asc", "prn", "lvm", "dat"], text::open),
];

/// Binary files of instruments that are not read: what is in their first bytes from one on, the
/// extension, and whose they are.
#[rustfmt::skip]
const VENDORS: [(usize, &[u8], &str, &str); 12] = [
    (2, b":WFM#", "wfm", "a Tektronix oscilloscope"),
    (0, b":WFM", "isf", "a Tektronix oscilloscope"),
    (0, b"BYT_N", "isf", "a Tektronix oscilloscope"),
    (11, b"WAVEDESC", "trc", "a LeCroy oscilloscope"),
    (0, b"WAVEDESC", "trc", "a LeCroy oscilloscope"),
    (0, b"AG", "bin", "a Keysight oscilloscope"),
    (0, b"RG0", "bin", "a Rigol oscilloscope"),
    (0, b"\xa5\xa5", "wfm", "a Rigol oscilloscope"),
    (0, b"\x01\xff\xff\xff", "wfm", "a Rigol oscilloscope"),
    (0, b"", "psdata", "PicoScope"),
    (0, b"", "wdf", "a Yokogawa oscilloscope"),
    (0, b"", "trc", "a LeCroy oscilloscope"),
];

/// Whether a file of a folder is a recording: by its extension, unless it is hidden or a table of shots.
///
/// # Errors
/// It is none; of an instrument's binary file with how it is exported.
pub fn is_recording(file: &Path) -> Result<(), Option<String>> {
    let extension = extension(file);
    let is_such = |format: &&Format| format.2.contains(&&*extension);
    let is_hidden = file.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
    let bytes = || probe(file).unwrap_or_default();
    match FORMATS.iter().find(is_such) {
        _ if is_hidden => Err(None),
        Some(("text", ..)) => {
            let begins = text::decoded(&bytes()).into_owned();
            let is_table = ShotList::is_begun_by(&String::from_utf8_lossy(&begins));
            if is_table { Err(None) } else { Ok(()) }
        }
        Some(_) => Ok(()),
        None if VENDORS.iter().any(|vendor| vendor.2 == extension) => {
            Err(vendor(&bytes(), &extension))
        }
        None => Err(None),
    }
}

fn probe(file: &Path) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let opened = File::open(file);
    let read = opened.and_then(|file| file.take(PROBE).read_to_end(&mut bytes));
    read.map_err(|cause| MeasureError::reading(file, cause))?;
    Ok(bytes)
}

#[cfg(not(feature = "hdf5"))]
fn open_hdf5(file: &Path, _options: &ReadOptions) -> Result<Raw> {
    let detail = "HDF5, which this build does not read: compile it with the feature `hdf5`";
    Err(MeasureError::malformed(file, "a recording", detail))
}

/// The records of a file, one at a time: a file larger than memory is never read whole.
///
/// A record that is of no use is an error in its place; the good ones follow.
pub struct Records {
    records: Raw,
    parts: Parts,
    are_chosen: bool,
    length: Option<usize>,
    file: PathBuf,
    count: usize,
}

/// Reads the records of a file: HDF5, MATLAB's, text, NPY, NPZ, WAV or TDMS, by its content.
///
/// A file that cannot be read at all gives one error and nothing else.
pub fn read(file: &Path, options: &ReadOptions) -> Records {
    let opened = format_of(file).and_then(|open| open(file, options));
    Records::new(file, or_error(opened), options)
}

/// Records that were opened, or the error alone.
pub(crate) fn or_error(opened: Result<Raw>) -> Raw {
    opened.unwrap_or_else(|error| Box::new(std::iter::once(Err(error))))
}

impl Iterator for Records {
    type Item = Result<Record>;

    fn next(&mut self) -> Option<Self::Item> {
        let record = match self.records.next() {
            // A file without records has a reason, too.
            None if self.count == 0 => Err(MeasureError::empty(file_name(&self.file))),
            found => found?,
        };
        self.count += 1;
        if self.count > MOST_RECORDS {
            self.records = Box::new(std::iter::empty());
            let detail = format!(
                "more than {MOST_RECORDS} records; --rows says what the rows of an array are, and \
                 parts of a file can be measured one by one"
            );
            return Some(Err(MeasureError::malformed(&self.file, "a recording", detail)));
        }
        Some(record.and_then(|record| self.checked(record)))
    }
}

impl Records {
    /// A record in memory, divided and checked as those of a file.
    pub(crate) fn of(record: Record, options: &ReadOptions) -> Self {
        let file = record.file.clone();
        Self::new(&file, Box::new(std::iter::once(Ok(record))), options)
    }

    fn new(file: &Path, records: Raw, options: &ReadOptions) -> Self {
        Self {
            records: match options.parts.most() {
                Some(most) => divided(records, most, options.parts),
                None => records,
            },
            parts: options.parts,
            are_chosen: !options.channels.is_empty(),
            length: None,
            file: file.to_owned(),
            count: 0,
        }
    }

    /// Rejects records without samples, with channels of different lengths, with many samples
    /// that are not finite, with channels that never change unless they are pieces, and shots
    /// that are not as long as the first. Fills single samples that are not finite.
    fn checked(&mut self, mut record: Record) -> Result<Record> {
        let length = record.len();
        if length == 0 {
            return Err(MeasureError::empty(record.source));
        }
        let is_piece = matches!(self.parts, Parts::Pieces(_));
        let mut gaps = Vec::new();
        for channel in &mut record.channels {
            gaps.extend(fill_gaps(&record.source, channel)?);
            if !is_piece {
                gaps.extend(fill_dropouts(&mut channel.volts));
            }
        }
        record.gaps = gaps;
        for channel in &record.channels {
            let found = channel.volts.len();
            if found != length {
                let why = "as in its first channel";
                return Err(MeasureError::lengths(record.source, found, length, why));
            }
            if !is_piece {
                reject_constant(&record.source, channel)?;
            }
        }
        if !self.are_chosen {
            record.notes.extend(two_channels(&record));
        }
        let expected = *self.length.get_or_insert(length);
        if length == expected || is_piece {
            return Ok(record);
        }
        let why = match self.parts == Parts::Shots(expected) {
            true => "what cutting left over is no shot",
            false => "as in the file's first record",
        };
        Err(MeasureError::lengths(record.source, length, expected, why))
    }
}

fn two_channels(record: &Record) -> Option<String> {
    let [sensor, wall] = record.channels.as_slice() else {
        return None;
    };
    let (sensor, wall) = (&sensor.name, &wall.name);
    (SEPARATE != [sensor.as_str(), wall.as_str()]).then(|| {
        format!(
            "{sensor:?} was taken for the sensor bead's channel, {wall:?} for the wall's; if it is \
             the other way round: --channel {wall:?} --channel {sensor:?}, if one sums both \
             sensors: --channel and its name alone"
        )
    })
}

/// Fills the samples that are not finite, and returns their runs.
fn fill_gaps(source: &str, channel: &mut Channel) -> Result<Vec<Range<usize>>> {
    let volts = &mut channel.volts;
    let bad = || (0..volts.len()).filter(|at| !volts[*at].is_finite());
    let Some(first) = bad().next() else {
        return Ok(Vec::new());
    };
    let (count, of) = (bad().count(), volts.len());
    if count as f64 > MOST_FILLED * of as f64 {
        let detail = format!(
            "{count} of {of} samples in {:?} are not finite numbers, the first is sample {}",
            channel.name,
            first + 1
        );
        return Err(MeasureError::Samples(source.to_owned(), detail));
    }
    let finite: Vec<f64> = volts.iter().copied().filter(|volt| volt.is_finite()).collect();
    let ends = extremes(&finite);
    let bad: Vec<usize> = bad().collect();
    let runs = bad.chunk_by(|one, next| one + 1 == *next);
    let gaps: Vec<Range<usize>> = runs.map(|run| run[0]..run[0] + run.len()).collect();
    gaps.iter().for_each(|gap| fill(volts, gap, ends));
    Ok(gaps)
}

/// Lengths of dropouts: of fewer samples they are spikes.
const DROPOUT: RangeInclusive<usize> = 3..=64;
/// Least step on either side of a dropout, as a share of the record's range, over the step beside it, and over the
/// usual step: the flanks of a pulse of six samples are not as steep, nor is a digitiser's step as high.
const ABRUPT: [f64; 3] = [0.25, 3.0, 16.0];
/// Samples from which the middle and the usual step are taken.
const LOOKED_AT: usize = 1 << 16;
/// Least distance from the middle of all samples of what is lost, as a share of the range.
const OFF_MIDDLE: f64 = 0.1;

/// Fills runs of one value that a signal jumps to and back from, as where samples were lost; returns them.
/// It jumps towards the baseline: what it jumps to from there is a clipped top or a square pulse.
fn fill_dropouts(volts: &mut [f64]) -> Vec<Range<usize>> {
    let ends = extremes(volts);
    let range = ends.1 - ends.0;
    let stride = volts.len().div_ceil(LOOKED_AT).max(1);
    let pairs = volts.windows(2).step_by(stride);
    let moves = pairs.map(|pair| (pair[1] - pair[0]).abs()).filter(|size| *size > 0.0);
    let moves: Vec<f64> = moves.collect();
    let some: Vec<f64> = volts.iter().step_by(stride).copied().collect();
    let (Some(middle), Some(usual)) = (median(&some), median(&moves)) else {
        return Vec::new();
    };
    let least = (ABRUPT[0] * range).max(ABRUPT[2] * usual);
    let is_dropout = |value: f64, [beside, next]: [f64; 2]| {
        let (step, off) = (beside - value, beside - middle);
        let steep = step.abs() > least.max(ABRUPT[1] * (next - beside).abs());
        Some(step).filter(|step| steep && step * off > 0.0 && off.abs() > OFF_MIDDLE * range)
    };
    let mut begin = 0;
    let runs = volts.chunk_by(|one, next| one == next).filter_map(|run| {
        let gap = begin..begin + run.len();
        begin = gap.end;
        let length = DROPOUT.contains(&run.len());
        let before = volts.get(gap.start.checked_sub(2)?..gap.start).filter(|_| length)?;
        let after = volts.get(gap.end..gap.end + 2)?;
        let [down, up] =
            [[before[1], before[0]], [after[0], after[1]]].map(|beside| is_dropout(run[0], beside));
        (down? * up? > 0.0).then_some(gap)
    });
    let dropouts: Vec<Range<usize>> = runs.collect();
    for gap in &dropouts {
        volts[gap.clone()].fill(f64::NAN);
        fill(volts, gap, ends);
    }
    dropouts
}

/// Fills a gap: with the record's extreme what was beyond a range, else between its neighbours.
fn fill(volts: &mut [f64], gap: &Range<usize>, (low, high): (f64, f64)) {
    let before = gap.start.checked_sub(1).map(|at| volts[at]);
    let after = volts.get(gap.end).copied();
    let from = before.or(after).unwrap_or(0.0);
    let to = after.unwrap_or(from);
    let steps = gap.len() as f64 + 1.0;
    for (number, volt) in volts[gap.clone()].iter_mut().enumerate() {
        *volt = match *volt {
            f64::INFINITY => high,
            f64::NEG_INFINITY => low,
            _ => from + (to - from) * (number as f64 + 1.0) / steps,
        };
    }
}

fn reject_constant(source: &str, channel: &Channel) -> Result<()> {
    let Channel { name, volts, .. } = channel;
    match volts.first() {
        Some(value) if volts.iter().all(|volt| volt == value) => {
            let of = volts.len();
            let detail =
                format!("all {of} samples in {name:?} are {value}; was the sensor connected?");
            Err(MeasureError::Samples(source.to_owned(), detail))
        }
        _ => Ok(()),
    }
}

/// Divides records that are longer than asked: rows of tables, which are read whole. Shots are
/// then numbered through the file.
fn divided(records: Raw, most: usize, parts: Parts) -> Raw {
    let mut shots = 0;
    Box::new(records.flat_map(move |record| -> Raw {
        let record = match record {
            Ok(record) if record.len() > most => record,
            other => return Box::new(std::iter::once(other)),
        };
        let count = record.len().div_ceil(most);
        let first = shots;
        shots += count as u64;
        Box::new((0..count).map(move |number| {
            let mut part = record.part(number * most, most);
            if let Parts::Pieces(_) = parts {
                part.first_sample = (number * most) as u64;
                part.source = from_sample(part.source, part.first_sample);
            } else {
                part.shot = Some(first + number as u64 + 1);
                part.source = format!("{}, part {}", part.source, number + 1);
            }
            Ok(part)
        }))
    }))
}

/// The reader of a file by its content, unless its extension promises another.
fn format_of(file: &Path) -> Result<Open> {
    let bytes = probe(file)?;
    if bytes.is_empty() {
        return Err(MeasureError::empty(file_name(file)));
    }
    let found = FORMATS.iter().find(|format| format.1(&bytes));
    let extension = extension(file);
    let promises = |format: &Format| format.2.contains(&&*extension);
    let is_promised = FORMATS.iter().any(promises);
    let foreign = vendor(&bytes, &extension).filter(|_| found.is_none());
    let detail = match (found, foreign) {
        (Some(found), _) if promises(found) || !is_promised => return Ok(found.3),
        (None, Some(detail)) => detail,
        (None, None) if !is_promised => {
            "is none of HDF5, MATLAB's, CSV or other text, NPY, NPZ, WAV and TDMS".to_owned()
        }
        (found, _) => {
            let content = found.map_or("something else", |found| found.0);
            format!("is called .{extension} but holds {content}; give it its right ending")
        }
    };
    Err(MeasureError::Format(file_name(file), detail))
}

fn extension(file: &Path) -> String {
    file.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

fn vendor(bytes: &[u8], extension: &str) -> Option<String> {
    let is_such = |(from, holds, ending, _): &&(usize, &[u8], &str, &str)| match holds.len() {
        0 => *ending == extension,
        _ => bytes.get(*from..).is_some_and(|bytes| bytes.starts_with(holds)),
    };
    let (.., ending, whose) = VENDORS.iter().find(is_such)?;
    Some(format!(
        "is a binary file (.{ending}) of {whose}, which is not read; save the waveform there as CSV, \
         or export it as MAT, HDF5 or NPY"
    ))
}

/// Also behind a user block, whose sizes are powers of 2.
fn is_hdf5(bytes: &[u8]) -> bool {
    let magic = b"\x89HDF\r\n\x1a\n";
    let mut blocks = [0, 512, 1024, 2048].into_iter();
    blocks.any(|at| bytes.get(at..).is_some_and(|bytes| bytes.starts_with(magic)))
}

fn is_text(bytes: &[u8]) -> bool {
    let text = text::decoded(bytes);
    let mut letters = text.iter();
    letters.all(|byte| !byte.is_ascii_control() || byte.is_ascii_whitespace())
}
