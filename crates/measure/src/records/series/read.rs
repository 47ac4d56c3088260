//! Reading series, shot by shot. True values are not looked at.

use super::layout;
use crate::records::channels::chosen;
use crate::records::error::{RecordError, name};
use crate::records::hdf5::{damaged, dataset};
use crate::records::interval::interval_s;
use crate::records::options::ReadOptions;
use crate::records::read::Raw;
use crate::records::record::{Channel, LowPass, Record, Samples};
use rust_hdf5::{H5Dataset, H5File, Hdf5Error};
use std::path::{Path, PathBuf};

/// Whether an open file is a series of ours.
pub(crate) fn is_ours(open: &H5File) -> bool {
    attribute_text(open, layout::FORMAT.0).as_deref() == Some(layout::FORMAT.1)
}

/// Opens a series of ours.
pub(crate) fn open(file: &Path, open: &H5File, options: &ReadOptions) -> Result<Raw, RecordError> {
    let foreign = |error: Hdf5Error| RecordError::malformed(file, "a series", damaged(&error));
    let channels = channels(open).map_err(foreign)?;
    let names: Vec<String> = channels
        .iter()
        .map(|(name, _)| (*name).to_owned())
        .collect();
    let samples = &channels[0].1;
    let number = |name: &str| attribute_number(samples, name).map_err(foreign);
    let shape = samples.shape();
    let &[shots, length] = shape.as_slice() else {
        let detail = format!("samples have the axes {shape:?}, not shots and samples");
        return Err(RecordError::malformed(file, "a series", detail));
    };
    if let Some((name, other)) = channels.iter().find(|(_, other)| other.shape() != shape) {
        let detail = format!("`{name}` has the axes {:?}, not {shape:?}", other.shape());
        return Err(RecordError::malformed(file, "a series", detail));
    }
    if shots == 0 || length == 0 {
        return Err(RecordError::Empty {
            source_name: name(file),
        });
    }
    let wanted = chosen(file, &names, options)?;
    let shelf = Shelf {
        file: file.to_owned(),
        interval_s: interval_s(file, Some(number(layout::INTERVAL)?), options)?,
        volts_per_count: number(layout::VOLTS_PER_COUNT)?,
        offset_v: number(layout::OFFSET)?,
        pretrigger: number(layout::PRETRIGGER)? as usize,
        case: attribute_text(open, layout::CASE),
        speed_error_m_s: told(open, layout::SPEED_ERROR),
        low_pass: low_pass(open),
        high_pass_hz: told(open, layout::HIGH_PASS).filter(|hz| hz.is_finite() && *hz >= 0.0),
        numbers: column(open, layout::SHOT, shots).map_err(foreign)?,
        speeds: column(open, layout::MEASURED, shots).map_err(foreign)?,
        programmed: column(open, layout::PROGRAMMED, shots).map_err(foreign)?,
        triggered: triggered(open, shots).map_err(foreign)?,
        channels,
        wanted,
        length,
    };
    Ok(Box::new((0..shots).map(move |row| shelf.record(row))))
}

/// An open series.
struct Shelf {
    file: PathBuf,
    interval_s: f64,
    volts_per_count: f64,
    offset_v: f64,
    pretrigger: usize,
    case: Option<String>,
    speed_error_m_s: Option<f64>,
    high_pass_hz: Option<f64>,
    low_pass: Option<LowPass>,
    numbers: Vec<i64>,
    speeds: Vec<f64>,
    programmed: Vec<f64>,
    triggered: Vec<i64>,
    channels: Vec<(&'static str, H5Dataset)>,
    /// Which of them, in which order.
    wanted: Vec<usize>,
    length: usize,
}

impl Shelf {
    fn record(&self, row: usize) -> Result<Record, RecordError> {
        let shot = self.numbers.get(row).and_then(|n| u64::try_from(*n).ok());
        let told_shot = shot.map_or(row.to_string(), |shot| shot.to_string());
        let source = format!("{}, shot {told_shot}", name(&self.file));
        let channels: Result<Vec<Channel>, Hdf5Error> = self
            .wanted
            .iter()
            .filter_map(|at| self.channels.get(*at))
            .map(|(name, samples)| self.channel(name, samples, row))
            .collect();
        let channels =
            channels.map_err(|error| RecordError::truncated(source.clone(), damaged(&error)))?;
        let speed = self.speeds.get(row).copied();
        Ok(Record {
            shot,
            programmed_speed_m_s: self.programmed.get(row).copied(),
            speed_m_s: speed.filter(|speed| speed.is_finite()),
            speed_error_m_s: self.speed_error_m_s,
            triggered: self.triggered.get(row).map(|fired| *fired != 0),
            case: self.case.clone(),
            high_pass_hz: self.high_pass_hz,
            low_pass: self.low_pass,
            pretrigger: Some(self.pretrigger),
            ..Record::new(source, &self.file, self.interval_s, channels)
        })
    }

    fn channel(&self, name: &str, samples: &H5Dataset, row: usize) -> Result<Channel, Hdf5Error> {
        Ok(Channel {
            name: name.to_owned(),
            samples: Samples::Counts {
                counts: samples.read_slice::<i16>(&[row, 0], &[1, self.length])?,
                volts_per_count: self.volts_per_count,
                offset_v: self.offset_v,
            },
        })
    }
}

/// The amplifier's low-pass, if it is one of those that [`LowPass`] has.
fn low_pass(open: &H5File) -> Option<LowPass> {
    let [corner, order, kind] = layout::LOW_PASS;
    let order = match (
        &*attribute_text(open, order)?,
        &*attribute_text(open, kind)?,
    ) {
        ("first", _) => 1,
        ("second", "butterworth") => 2,
        _ => return None,
    };
    let corner_hz = told(open, corner).filter(|hz| hz.is_finite() && *hz > 0.0)?;
    Some(LowPass { corner_hz, order })
}

/// The channels of a file, with their names: one, or one a sensor.
pub(super) fn channels(open: &H5File) -> Result<Vec<(&'static str, H5Dataset)>, Hdf5Error> {
    let named = |name: &'static str| Ok((name, dataset(open, name)?));
    let there = open.root_group().dataset_names()?;
    let separate = layout::SEPARATE
        .iter()
        .all(|name| there.iter().any(|n| n == name));
    let names = if separate {
        layout::SEPARATE
    } else {
        layout::SUMMED
    };
    names.iter().copied().map(named).collect()
}

/// How many shots of a series have no trigger: the recorder gave up waiting for their level.
///
/// # Errors
/// Files that are not series of ours.
pub fn untriggered(file: &Path) -> Result<usize, RecordError> {
    let count = || -> Result<usize, Hdf5Error> {
        let open = H5File::open(file)?;
        let shots = dataset(&open, layout::SHOT)?.shape().iter().product();
        let fired = triggered(&open, shots)?;
        Ok(fired.into_iter().filter(|fired| *fired == 0).count())
    };
    count().map_err(|error| RecordError::malformed(file, "a series", damaged(&error)))
}

/// Whether the trigger fired at each shot; of a file that does not say, nothing.
pub(super) fn triggered(open: &H5File, shots: usize) -> Result<Vec<i64>, Hdf5Error> {
    let there = open.root_group().dataset_names()?;
    match there.iter().any(|name| name == layout::TRIGGERED) {
        true => column(open, layout::TRIGGERED, shots),
        false => Ok(Vec::new()),
    }
}

pub(crate) fn column<T: rust_hdf5::H5Type>(
    open: &H5File,
    name: &str,
    count: usize,
) -> Result<Vec<T>, Hdf5Error> {
    let column = dataset(open, name)?.read_raw::<T>()?;
    match column.len() == count {
        true => Ok(column),
        false => Err(Hdf5Error::InvalidState(format!(
            "{name} has {} rows where samples have {count}",
            column.len()
        ))),
    }
}

/// A number that the file tells as text, if it does.
fn told(open: &H5File, name: &str) -> Option<f64> {
    attribute_text(open, name)?.trim().parse().ok()
}

pub(super) fn attribute_text(open: &H5File, name: &str) -> Option<String> {
    open.attr_string(name).ok()
}

pub(crate) fn attribute_number(of: &H5Dataset, name: &str) -> Result<f64, Hdf5Error> {
    let missing = || Hdf5Error::NotFound(name.to_owned());
    let attribute = of.attr(name)?;
    let floats = attribute.read_numeric_as::<f64>();
    let whole = || attribute.read_numeric_as::<u64>();
    let value = match floats {
        Ok(floats) => floats.first().copied(),
        Err(_) => whole()?.first().map(|whole| *whole as f64),
    };
    value.ok_or_else(missing)
}
