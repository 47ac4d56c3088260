//! Series of a virtual campaign: one HDF5 file a series. The reader never opens the true values
//! beside the samples, so that no analysis uses them by accident.

mod write;

pub use write::{SeriesChannels, SeriesInfo, SeriesWriter, ShotRow};

use crate::error::{MeasureError, Result, file_name};
use crate::records::hdf5::{attribute, column, damaged, dataset};
use crate::records::interval::interval_s;
use crate::records::options::{ReadOptions, chosen};
use crate::records::read::Raw;
use crate::records::record::{Channel, Record, SEPARATE, converter_range_v};
use crate::signal::Bandwidth;
use flate2::CrcReader;
use rust_hdf5::{H5Dataset, H5File, Hdf5Error};
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::Path;

const FORMAT: (&str, &str) = ("format", "hertzchain series");
/// Datasets of the converter's readings, shots × samples: of both sensors, or of one each.
const SUMMED: &[&str] = &["samples"];
/// Numbers of the shots; the scale of the first axis.
const SHOT: &str = "shot";
const PROGRAMMED: &str = "programmed_speed";
const MEASURED: &str = "measured_speed";
/// 1 if the trigger fired, 0 if the recorder gave up waiting for it.
const TRIGGERED: &str = "triggered";
/// Group of the true values, and in it the numbers of contacts.
const TRUTH: &str = "truth";
const CONTACT: &str = "contact";
/// Attributes of the samples: the library reads numbers of datasets only.
const INTERVAL: &str = "sampling_interval_s";
const VOLTS_PER_COUNT: &str = "volts_per_count";
const OFFSET: &str = "offset_v";
const PRETRIGGER: &str = "pretrigger_samples";
const CASE: &str = "case";
const EXPERIMENT: &str = "experiment";
/// Standard error of the measured speed in m/s, if the rig states it.
const SPEED_ERROR: &str = "measured_speed_error_m_s";
/// Corner of the amplifier's high-pass in Hz, if the rig states it.
const HIGH_PASS: &str = "high_pass_hz";
/// Corner of its low-pass in Hz, its order in words and its kind, if the rig states them.
const LOW_PASS: [&str; 3] = ["low_pass_hz", "low_pass_order", "low_pass_kind"];

fn malformed(file: &Path, what: impl std::fmt::Display) -> MeasureError {
    MeasureError::malformed(file, "a series", what)
}

pub(crate) fn is_series(open: &H5File) -> bool {
    text(open, FORMAT.0).as_deref() == Some(FORMAT.1)
}

pub(crate) fn open(file: &Path, open: &H5File, options: &ReadOptions) -> Result<Raw> {
    let foreign = |error: Hdf5Error| malformed(file, damaged(&error));
    let channels = channels(open).map_err(foreign)?;
    let names: Vec<String> = channels.iter().map(|one| one.0.to_owned()).collect();
    let samples = &channels[0].1;
    let number = |name: &str| attribute(samples, name).map_err(foreign);
    let shape = samples.shape();
    let &[shots, length] = shape.as_slice() else {
        let detail = format!("samples have the axes {shape:?}, not shots and samples");
        return Err(malformed(file, detail));
    };
    if let Some((name, other)) = channels.iter().find(|(_, other)| other.shape() != shape) {
        let detail = format!("`{name}` has the axes {:?}, not {shape:?}", other.shape());
        return Err(malformed(file, detail));
    }
    if shots == 0 || length == 0 {
        return Err(MeasureError::empty(file_name(file)));
    }
    let wanted = chosen(file, &names, options)?;
    let positive =
        |name, least: f64| number_text(open, name).filter(|n| n.is_finite() && *n >= least);
    let series = OpenSeries {
        // What all its records share.
        head: Record {
            pretrigger: Some(number(PRETRIGGER)? as usize),
            case: text(open, CASE),
            speed_error_m_s: number_text(open, SPEED_ERROR),
            low_pass: low_pass(open),
            high_pass_hz: positive(HIGH_PASS, 0.0),
            ..Record::new(
                file_name(file),
                file,
                interval_s(file, Some(number(INTERVAL)?), options)?,
                Vec::new(),
            )
        },
        volts_per_count: number(VOLTS_PER_COUNT)?,
        offset_v: number(OFFSET)?,
        numbers: column(open, SHOT, shots).map_err(foreign)?,
        speeds: column(open, MEASURED, shots).map_err(foreign)?,
        programmed: column(open, PROGRAMMED, shots).map_err(foreign)?,
        triggered: triggered(open, shots).map_err(foreign)?,
        channels: named(open, wanted.iter().map(|at| channels[*at].0)).map_err(foreign)?,
        length,
    };
    Ok(Box::new((0..shots).map(move |row| series.record(row))))
}

struct OpenSeries {
    head: Record,
    volts_per_count: f64,
    offset_v: f64,
    numbers: Vec<i64>,
    speeds: Vec<f64>,
    programmed: Vec<f64>,
    triggered: Vec<i64>,
    channels: Vec<(&'static str, H5Dataset)>,
    length: usize,
}

impl OpenSeries {
    fn record(&self, row: usize) -> Result<Record> {
        let shot = self.numbers.get(row).and_then(|n| u64::try_from(*n).ok());
        let number = shot.unwrap_or(row as u64);
        let source = format!("{}, shot {number}", self.head.source);
        let channel = |(name, samples): &(&'static str, H5Dataset)| {
            let counts = samples.read_slice::<i16>(&[row, 0], &[1, self.length])?;
            let (scale, offset) = (self.volts_per_count, self.offset_v);
            let volts = counts.into_iter().map(|count| f64::from(count) * scale + offset);
            let volts: Vec<f64> = volts.collect();
            let range_v = Some(converter_range_v(&volts, scale, offset));
            Ok(Channel { name: (*name).to_owned(), volts, range_v })
        };
        let channels: Result<Vec<Channel>, Hdf5Error> = self.channels.iter().map(channel).collect();
        let channels =
            channels.map_err(|error| MeasureError::truncated(source.clone(), damaged(&error)))?;
        let speed = self.speeds.get(row).copied();
        Ok(Record {
            source,
            shot,
            channels,
            programmed_speed_m_s: self.programmed.get(row).copied(),
            speed_m_s: speed.filter(|speed| speed.is_finite()),
            triggered: self.triggered.get(row).map(|fired| *fired != 0),
            ..self.head.clone()
        })
    }
}

/// The amplifier's low-pass, if it is one of those that [`Bandwidth`] has.
fn low_pass(open: &H5File) -> Option<Bandwidth> {
    let [corner, order, kind] = LOW_PASS;
    let orders = ["first", "second", "third", "fourth"];
    let order = text(open, order)?;
    let order = orders.iter().position(|name| *name == order)? + 1;
    let bessel = match &*text(open, kind)? {
        "bessel" => order > 1,
        "butterworth" => false,
        _ if order == 1 => false,
        _ => return None,
    };
    let corner_hz = number_text(open, corner).filter(|hz| hz.is_finite() && *hz > 0.0)?;
    Some(Bandwidth { corner_hz, order, bessel })
}

/// The channels of a file, with their names: one, or one a sensor.
fn channels(open: &H5File) -> Result<Vec<(&'static str, H5Dataset)>, Hdf5Error> {
    let there = open.root_group().dataset_names()?;
    let has = |name: &&str| there.iter().any(|known| known == name);
    let names = match SEPARATE.iter().all(has) {
        true => SEPARATE,
        false => SUMMED,
    };
    named(open, names.iter().copied())
}

fn named(
    open: &H5File,
    names: impl Iterator<Item = &'static str>,
) -> Result<Vec<(&'static str, H5Dataset)>, Hdf5Error> {
    names.map(|name| Ok((name, dataset(open, name)?))).collect()
}

/// Whether the trigger fired at each shot; empty of a file that does not state it.
fn triggered(open: &H5File, shots: usize) -> Result<Vec<i64>, Hdf5Error> {
    let there = open.root_group().dataset_names()?;
    match there.iter().any(|name| name == TRIGGERED) {
        true => column(open, TRIGGERED, shots),
        false => Ok(Vec::new()),
    }
}

fn text(open: &H5File, name: &str) -> Option<String> {
    open.attr_string(name).ok()
}

fn number_text(open: &H5File, name: &str) -> Option<f64> {
    text(open, name)?.trim().parse().ok()
}

/// Number of shots of a series at which the trigger never fired.
///
/// # Errors
/// Files that are not series of a virtual campaign.
pub fn untriggered(file: &Path) -> Result<usize> {
    let count = || -> Result<usize, Hdf5Error> {
        let open = H5File::open(file)?;
        let shots = dataset(&open, SHOT)?.shape().iter().product();
        let fired = triggered(&open, shots)?;
        Ok(fired.into_iter().filter(|fired| *fired == 0).count())
    };
    count().map_err(|error| malformed(file, damaged(&error)))
}

/// The true values of a series by name, which only a simulation has; those of every contact, shot
/// after shot. For tests of analyses, never for an analysis.
///
/// # Errors
/// Files that are not series of a virtual campaign.
pub fn truth(file: &Path) -> Result<Vec<(String, Vec<f64>)>> {
    let columns = || -> Result<Vec<(String, Vec<f64>)>, Hdf5Error> {
        let open = H5File::open(file)?;
        let mut names = open.root_group().group(TRUTH)?.dataset_names()?;
        names.retain(|name| name != CONTACT);
        let column = |name: String| {
            let path = format!("{TRUTH}/{name}");
            Ok((name, dataset(&open, &path)?.read_raw::<f64>()?))
        };
        names.into_iter().map(column).collect()
    };
    columns().map_err(|error| malformed(file, error))
}

/// Opens a finished series and compares it with what a writer would write: every text of the
/// information, the shape of each channel, the numbers and the programmed speed of the shots, and
/// the checksum of the file.
///
/// # Errors
/// [`MeasureError::Format`] with what is damaged, missing or other than expected.
pub fn verify(
    file: &Path,
    info: &SeriesInfo,
    shots: usize,
    programmed_speed_m_s: f64,
) -> Result<()> {
    let reading = |cause| MeasureError::reading(file, cause);
    let opened = File::open(file).map_err(reading)?;
    let expected = (shots, programmed_speed_m_s);
    let difference = match has_checksum(&opened).map_err(reading)? {
        Some(true) => difference(file, info, expected).map_err(|error| damaged(&error)),
        Some(false) => Err("damaged: its bytes do not have its checksum".to_owned()),
        None => Err("cut short or damaged: its checksum is missing".to_owned()),
    };
    match difference {
        Ok(None) => Ok(()),
        Ok(Some(what)) | Err(what) => Err(MeasureError::malformed(file, "this series", what)),
    }
}

fn difference(
    file: &Path,
    info: &SeriesInfo,
    (shots, programmed_speed_m_s): (usize, f64),
) -> Result<Option<String>, Hdf5Error> {
    let open = H5File::open(file)?;
    let own = [FORMAT, (CASE, &*info.case), (EXPERIMENT, &*info.experiment)];
    let more = info.more.iter().map(|(name, text)| (&**name, &**text));
    let mut texts = own.into_iter().chain(more);
    if let Some((name, _)) = texts.find(|(name, own)| text(&open, name).as_deref() != Some(own)) {
        return Ok(Some(format!("its `{name}` is another")));
    }
    let channels = channels(&open)?;
    if !channels.iter().map(|one| &one.0).eq(info.channels.names()) {
        return Ok(Some("it has other channels".to_owned()));
    }
    let shape = [shots, info.samples_per_shot];
    if let Some((name, found)) = channels.iter().find(|(_, found)| found.shape() != shape) {
        let found = found.shape();
        return Ok(Some(format!("`{name}` has the axes {found:?}, not {shape:?}")));
    }
    let numbers = column::<i64>(&open, SHOT, shots)?;
    let speeds = column::<f64>(&open, PROGRAMMED, shots)?;
    Ok(if !numbers.into_iter().eq(0..shots as i64) {
        Some("it has other shots".to_owned())
    } else if speeds.iter().any(|speed| *speed != programmed_speed_m_s) {
        Some("it has another programmed speed".to_owned())
    } else {
        None
    })
}

/// What stands before the eight hexadecimal digits of a CRC-32 at the end of a file, of all bytes
/// before it. Readers of HDF5 end at the length that the file states, and do not see it.
const CHECKSUM: &[u8] = b"\nhertzchain CRC-32 ";

/// Appends the checksum of a file and flushes it to the disk.
fn append_checksum(mut file: &File) -> io::Result<()> {
    file.seek(SeekFrom::Start(0))?;
    let ending = checksum(file)?;
    file.write_all(&ending)?;
    file.sync_all()
}

/// Whether a file ends with the checksum of what is before it; `None` where it ends with none.
fn has_checksum(mut file: &File) -> io::Result<Option<bool>> {
    let length = CHECKSUM.len() as u64 + 8;
    let Some(before) = file.metadata()?.len().checked_sub(length) else {
        return Ok(None);
    };
    let mut found = Vec::new();
    file.seek(SeekFrom::Start(before))?;
    file.read_to_end(&mut found)?;
    if !found.starts_with(CHECKSUM) {
        return Ok(None);
    }
    file.seek(SeekFrom::Start(0))?;
    Ok(Some(found == checksum(file.take(before))?))
}

fn checksum(bytes: impl Read) -> io::Result<Vec<u8>> {
    let mut reader = CrcReader::new(BufReader::with_capacity(1 << 18, bytes));
    io::copy(&mut reader, &mut io::sink())?;
    let digits = format!("{:08x}", reader.crc().sum());
    Ok([CHECKSUM, digits.as_bytes()].concat())
}
