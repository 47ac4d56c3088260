//! Writing a series: beside its place, shot by shot, renamed when complete.

use super::{
    CASE, CONTACT, EXPERIMENT, FORMAT, INTERVAL, MEASURED, OFFSET, PRETRIGGER, PROGRAMMED,
    SEPARATE, SHOT, SUMMED, TRIGGERED, TRUTH, VOLTS_PER_COUNT,
};
use crate::error::{MeasureError, Result, file_name};
use crate::records::files::{exclusive, persist};
use crate::records::hdf5::{describe, unit};
use rust_hdf5::{H5Dataset, H5File, H5Group, H5Type, Hdf5Error};
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Effort of the compression. Noise takes half of 16 bits whatever the effort, and time triples
/// from here to the highest.
const DEFLATE: u32 = 3;

/// What Unix systems call a full disk; the library keeps its text alone.
const NO_SPACE: i32 = 28;

/// Most samples in a chunk: chunks are read whole.
const MOST_IN_CHUNK: usize = 1 << 19;

/// The second axis, which has no numbers of its own.
const SAMPLE: &str = "sample";

/// Channels of a series: both sensors added up in one, or one each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeriesChannels {
    /// Both sensors added up in one.
    Summed,
    /// The bead's sensor in one, the wall's in another.
    Separate,
}

impl SeriesChannels {
    pub(super) fn names(self) -> &'static [&'static str] {
        match self {
            Self::Summed => SUMMED,
            Self::Separate => SEPARATE,
        }
    }
}

/// What all shots of a series share.
#[derive(Clone, Debug, PartialEq)]
pub struct SeriesInfo {
    /// Channels of its samples.
    pub channels: SeriesChannels,
    /// Time between samples in s.
    pub interval_s: f64,
    /// Size of the converter's step in V.
    pub volts_per_count: f64,
    /// Voltage of reading 0 in V.
    pub offset_v: f64,
    /// Samples before the trigger.
    pub pretrigger: usize,
    /// Samples of every shot in each channel.
    pub samples_per_shot: usize,
    /// Number of the series in its campaign.
    pub series: u64,
    /// Which section of the chain is wet and with what.
    pub case: String,
    /// The campaign's seed.
    pub seed: u64,
    /// The whole experiment file.
    pub experiment: String,
    /// Descriptions of the true values by their names.
    pub long_names: &'static [(&'static str, &'static str)],
    /// Further attributes: name, text. `measured_speed_error_m_s` is read back as the standard
    /// error of measured speeds.
    pub more: Vec<(String, String)>,
}

/// One shot of a series.
#[derive(Clone, Copy, Debug)]
pub struct ShotRow<'a> {
    /// Its number.
    pub shot: u64,
    /// Programmed speed of the striker in m/s.
    pub programmed_speed_m_s: f64,
    /// Speed by the photogate in m/s.
    pub measured_speed_m_s: f64,
    /// Whether the trigger fired; if not, where its record begins is the recorder's choice.
    pub triggered: bool,
    /// Readings of the converter, channel after channel.
    pub samples: &'a [i16],
    /// True values; the same names, whose endings are the units, for every shot of a series.
    pub truth: &'a [(&'static str, f64)],
    /// True values of every contact, from contact 1 on.
    pub contacts: &'a [(&'static str, &'a [f64])],
}

/// Writes the shots of one series into one HDF5 file.
///
/// The file grows beside its place, hidden, and gets its name when it is finished: what has its
/// name is whole, whenever the program is stopped. Several writers of one series, in one process
/// or many, do not meet: the last one's file stays. A writer that is dropped unfinished removes
/// its part.
pub struct SeriesWriter {
    path: PathBuf,
    part: NamedTempFile,
    /// Dropped, the library would complete a file that goes away and, on a full disk, complain of
    /// it to the terminal.
    open: ManuallyDrop<Open>,
    samples_per_shot: usize,
    columns: SeriesColumns,
}

struct Open {
    file: H5File,
    channels: Vec<H5Dataset>,
}

impl SeriesWriter {
    /// Starts the file of a series.
    ///
    /// # Errors
    /// [`MeasureError::Unwritable`]; [`MeasureError::Samples`] without samples.
    pub fn create(path: &Path, info: &SeriesInfo) -> Result<Self> {
        if info.samples_per_shot == 0 {
            return Err(MeasureError::empty(file_name(path)));
        }
        let part = exclusive(path).map_err(|error| unwritable(path, &error))?;
        let started = start(part.path(), info);
        let open = started.map_err(|error| unwritable(path, &error))?;
        Ok(Self {
            path: path.to_owned(),
            part,
            open: ManuallyDrop::new(open),
            samples_per_shot: info.samples_per_shot,
            columns: SeriesColumns { long_names: info.long_names, ..SeriesColumns::default() },
        })
    }

    /// Writes one shot.
    ///
    /// # Errors
    /// [`MeasureError::Samples`] if it has not the series' samples or true values;
    /// [`MeasureError::Unwritable`], after which the series cannot be finished.
    pub fn push(&mut self, row: &ShotRow<'_>) -> Result<()> {
        if let Some(misfit) = self.misfit(row) {
            let detail = format!("shot {} does not fit the series: {misfit}", row.shot);
            return Err(MeasureError::Samples(file_name(&self.path), detail));
        }
        let at = self.columns.shots.len();
        let samples = row.samples.chunks_exact(self.samples_per_shot);
        for (channel, samples) in self.open.channels.iter().zip(samples) {
            let written = append(channel, at, samples);
            written.map_err(|error| unwritable(&self.path, &error))?;
        }
        self.columns.push(row);
        Ok(())
    }

    /// Completes the file and gives it its name.
    ///
    /// # Errors
    /// [`MeasureError::Samples`] without shots, [`MeasureError::Unwritable`].
    pub fn finish(self) -> Result<PathBuf> {
        if self.columns.shots.is_empty() {
            return Err(MeasureError::empty(file_name(&self.path)));
        }
        let Open { file, channels } = ManuallyDrop::into_inner(self.open);
        let written = self.columns.write(&file, &channels).and_then(|()| {
            drop(channels);
            file.close()
        });
        written.map_err(|error| unwritable(&self.path, &error))?;
        let sealed = super::append_checksum(self.part.as_file());
        let sealed = sealed.and_then(|()| persist(self.part, &self.path));
        sealed.map_err(|error| unwritable(&self.path, &error))?;
        Ok(self.path)
    }

    fn misfit(&self, row: &ShotRow<'_>) -> Option<String> {
        let all = self.open.channels.len() * self.samples_per_shot;
        let found = row.samples.len();
        if found != all {
            return Some(format!("{found} samples in place of {all}"));
        }
        if i64::try_from(row.shot).is_err() {
            return Some("its number is beyond all bounds".to_owned());
        }
        let (columns, shots) = (&self.columns, self.columns.shots.len());
        if shots == 0 {
            return None;
        }
        let truth = columns.truth.iter().map(|column| column.0);
        if !truth.eq(row.truth.iter().map(|value| value.0)) {
            return Some("other true values than before".to_owned());
        }
        let contacts = columns.contacts.iter();
        let contacts = contacts.map(|table| (table.0, table.1.len() / shots));
        let same = contacts.eq(row.contacts.iter().map(|of| (of.0, of.1.len())));
        (!same).then(|| "other true values of contacts than before".to_owned())
    }
}

#[derive(Default)]
struct SeriesColumns {
    shots: Vec<i64>,
    programmed: Vec<f64>,
    measured: Vec<f64>,
    triggered: Vec<i64>,
    truth: Vec<(&'static str, Vec<f64>)>,
    contacts: Vec<(&'static str, Vec<f64>)>,
    long_names: &'static [(&'static str, &'static str)],
}

impl SeriesColumns {
    fn push(&mut self, row: &ShotRow<'_>) {
        if self.shots.is_empty() {
            let truth = row.truth.iter().map(|value| (value.0, Vec::new()));
            self.truth = truth.collect();
            let contacts = row.contacts.iter().map(|values| (values.0, Vec::new()));
            self.contacts = contacts.collect();
        }
        self.shots.push(i64::try_from(row.shot).unwrap_or(i64::MAX));
        self.programmed.push(row.programmed_speed_m_s);
        self.measured.push(row.measured_speed_m_s);
        self.triggered.push(i64::from(row.triggered));
        for (column, value) in self.truth.iter_mut().zip(row.truth) {
            column.1.push(value.1);
        }
        for (table, values) in self.contacts.iter_mut().zip(row.contacts) {
            table.1.extend_from_slice(values.1);
        }
    }

    /// Description of a true value; its name again where there is none.
    fn long_name<'a>(&self, name: &'a str) -> &'a str {
        let known = self.long_names.iter().find(|(of, _)| *of == name);
        known.map_or(name, |(_, what)| what)
    }

    fn write(&self, file: &H5File, channels: &[H5Dataset]) -> Result<(), Hdf5Error> {
        let root = file.root_group();
        let shots = column(&root, SHOT, "number of the shot", "1", &self.shots)?;
        shots.set_scale(Some(SHOT))?;
        let length = channels.first().and_then(|c| c.shape().get(1).copied());
        let axis = sample_axis(file, length.unwrap_or(1))?;
        for channel in channels {
            channel.attach_scale(0, &shots)?;
            channel.attach_scale(1, &axis)?;
        }
        for (name, what, values) in [
            (PROGRAMMED, "programmed speed of the striker", &self.programmed),
            (MEASURED, "speed by the photogate", &self.measured),
        ] {
            column(&root, name, what, "m s-1", values)?.attach_scale(0, &shots)?;
        }
        let fired = "1 if the trigger fired, 0 if its level was never passed";
        column(&root, TRIGGERED, fired, "1", &self.triggered)?.attach_scale(0, &shots)?;
        let truth = file.create_group(TRUTH)?;
        truth.set_attr_string("comment", "known to the simulation, not to the rig")?;
        for (name, values) in &self.truth {
            let what = self.long_name(name);
            column(&truth, name, what, unit(name), values)?.attach_scale(0, &shots)?;
        }
        self.write_contacts(&truth, &shots)
    }

    fn write_contacts(&self, truth: &H5Group, shots: &H5Dataset) -> Result<(), Hdf5Error> {
        let Some((_, first)) = self.contacts.first() else {
            return Ok(());
        };
        let across = first.len() / self.shots.len().max(1);
        let numbers: Vec<i64> = (1..).take(across).collect();
        let axis = column(truth, CONTACT, "number of the contact", "1", &numbers)?;
        axis.set_scale(Some(CONTACT))?;
        for (name, values) in &self.contacts {
            let shape = [self.shots.len(), across];
            let table = truth.new_dataset::<f64>().shape(shape).create(name)?;
            table.write_raw(values)?;
            describe(&table, self.long_name(name), unit(name))?;
            table.attach_scale(0, shots)?;
            table.attach_scale(1, &axis)?;
        }
        Ok(())
    }
}

/// The second axis as netCDF has dimensions without values.
fn sample_axis(file: &H5File, count: usize) -> Result<H5Dataset, Hdf5Error> {
    let axis = file
        .new_dataset::<f32>()
        .shape([count])
        .chunk(&[count])
        .shuffle_deflate(DEFLATE)
        .create(SAMPLE)?;
    let nothing = "This is a netCDF dimension but not a netCDF variable.";
    axis.set_scale(Some(&format!("{nothing}{count:10}")))?;
    Ok(axis)
}

fn column<T: H5Type>(
    group: &H5Group,
    name: &str,
    what: &str,
    unit: &str,
    values: &[T],
) -> Result<H5Dataset, Hdf5Error> {
    let new = group.new_dataset::<T>().shape([values.len()]);
    let column = new.create(name)?;
    column.write_raw(values)?;
    describe(&column, what, unit)?;
    Ok(column)
}

fn start(part: &Path, info: &SeriesInfo) -> Result<Open, Hdf5Error> {
    let file = H5File::create(part)?;
    file.set_attr_string(FORMAT.0, FORMAT.1)?;
    file.set_attr_numeric("format_version", &1_i64)?;
    file.set_attr_numeric("series", &info.series)?;
    file.set_attr_numeric("seed", &info.seed)?;
    file.set_attr_string(CASE, &info.case)?;
    file.set_attr_string(EXPERIMENT, &info.experiment)?;
    for (name, text) in &info.more {
        file.set_attr_string(name, text)?;
    }
    let names = info.channels.names().iter();
    let channels: Result<Vec<H5Dataset>, Hdf5Error> =
        names.map(|name| channel(&file, name, info)).collect();
    Ok(Open { channels: channels?, file })
}

/// An empty channel, with the attributes by which xarray and every reader of CF conventions turn
/// counts into V.
fn channel(file: &H5File, name: &str, info: &SeriesInfo) -> Result<H5Dataset, Hdf5Error> {
    let samples = file
        .new_dataset::<i16>()
        .shape([0, info.samples_per_shot])
        .chunk(&[1, info.samples_per_shot.min(MOST_IN_CHUNK)])
        .max_shape(&[None, Some(info.samples_per_shot)])
        .shuffle_deflate(DEFLATE)
        .create(name)?;
    let what = match info.channels {
        SeriesChannels::Summed => "voltage of the summed sensors".to_owned(),
        SeriesChannels::Separate => format!("voltage of the {name}"),
    };
    describe(&samples, &what, "V")?;
    for (name, value) in [
        (INTERVAL, info.interval_s),
        (VOLTS_PER_COUNT, info.volts_per_count),
        (OFFSET, info.offset_v),
        ("scale_factor", info.volts_per_count),
        ("add_offset", info.offset_v),
    ] {
        let attribute = samples.new_attr::<f64>().shape(()).create(name)?;
        attribute.write_numeric(&value)?;
    }
    let pretrigger = samples.new_attr::<u64>().shape(()).create(PRETRIGGER)?;
    pretrigger.write_numeric(&(info.pretrigger as u64))?;
    Ok(samples)
}

/// One row more, in chunks of which the last is filled up with zeros.
fn append(samples: &H5Dataset, at: usize, row: &[i16]) -> Result<(), Hdf5Error> {
    let chunk = row.len().min(MOST_IN_CHUNK);
    let chunks = row.len().div_ceil(chunk);
    for (number, part) in row.chunks(chunk).enumerate() {
        let mut bytes: Vec<u8> = part.iter().flat_map(|count| count.to_le_bytes()).collect();
        bytes.resize(2 * chunk, 0);
        samples.write_chunk(at * chunks + number, &bytes)?;
    }
    samples.extend(&[at + 1, row.len()])
}

fn unwritable(path: &Path, error: &dyn std::error::Error) -> MeasureError {
    let text = error.to_string();
    let full = std::io::Error::from_raw_os_error(NO_SPACE).to_string();
    let advice = match text.contains(&full) {
        true => "; make room and run again",
        false => "",
    };
    MeasureError::Unwritable(file_name(path), text + advice)
}
