//! Writing a series: beside its place, shot by shot, renamed when complete.

use super::layout;
use crate::records::checksum;
use crate::records::error::{RecordError, name};
use crate::records::whole::{exclusive, named};
use rust_hdf5::{H5Dataset, H5File, H5Group, Hdf5Error};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Effort of the compression. Noise takes half of 16 bits whatever the effort,
/// and time triples from here to the highest.
const DEFLATE: u32 = 3;

/// What Unix systems call a full disk; the library keeps its text alone.
const NO_SPACE: i32 = 28;

/// Most samples in a chunk: chunks are read whole.
const MOST_IN_CHUNK: usize = 1 << 19;

/// In which channels both sensors of a shot are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// Added up in one.
    Summed,
    /// The bead's sensor in one, the wall's in another.
    Separate,
}

impl Channels {
    /// Names of the channels in a file.
    pub(super) fn names(self) -> &'static [&'static str] {
        match self {
            Self::Summed => layout::SUMMED,
            Self::Separate => layout::SEPARATE,
        }
    }
}

/// What all shots of a series share.
#[derive(Clone, Debug, PartialEq)]
pub struct SeriesInfo {
    /// In which channels its samples are.
    pub channels: Channels,
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
    /// What true values are, by their names, for people.
    pub long_names: &'static [(&'static str, &'static str)],
    /// Further attributes: name, text. `measured_speed_error_m_s` is read back as
    /// the standard error of measured speeds.
    pub more: Vec<(String, String)>,
}

/// One shot of a series.
#[derive(Clone, Copy, Debug)]
pub struct ShotRow<'a> {
    /// Its number.
    pub shot: u64,
    /// Speed that the striker was told, in m/s.
    pub programmed_speed_m_s: f64,
    /// Speed that the photogate measured, in m/s.
    pub measured_speed_m_s: f64,
    /// Whether the trigger fired; if not, where its record begins is the recorder's choice.
    pub triggered: bool,
    /// Readings of the converter, channel after channel.
    pub samples: &'a [i16],
    /// What only a simulation knows; the same names, whose endings are the units,
    /// for every shot of a series.
    pub truth: &'a [(&'static str, f64)],
    /// The same of every contact, from contact 1 on.
    pub contacts: &'a [(&'static str, &'a [f64])],
}

/// Writes the shots of one series into one HDF5 file.
///
/// The file grows beside its place, hidden and with the ending `.part`, and gets its
/// name when it is finished: what has its name is whole, whenever the program is
/// stopped. Several writers of one series, in one process or many, do not meet: the
/// last one's file stays. A writer that is dropped unfinished removes its part.
pub struct SeriesWriter {
    path: PathBuf,
    /// Removed when it is dropped.
    part: NamedTempFile,
    open: Growing,
    samples_per_shot: usize,
    table: Table,
}

/// The growing file.
struct Open {
    file: H5File,
    channels: Vec<H5Dataset>,
}

/// What is small and written last, a column each.
#[derive(Default)]
struct Table {
    shots: Vec<i64>,
    programmed: Vec<f64>,
    measured: Vec<f64>,
    triggered: Vec<i64>,
    truth: Vec<(&'static str, Vec<f64>)>,
    contacts: Vec<(&'static str, Vec<f64>)>,
    long_names: &'static [(&'static str, &'static str)],
}

impl std::fmt::Debug for SeriesWriter {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter
            .debug_struct("SeriesWriter")
            .field("path", &self.path)
            .field("shots", &self.table.shots.len())
            .finish_non_exhaustive()
    }
}

impl SeriesWriter {
    /// Starts the file of a series.
    ///
    /// # Errors
    /// [`RecordError::Unwritable`]; [`RecordError::Empty`] without samples.
    pub fn create(path: &Path, info: &SeriesInfo) -> Result<Self, RecordError> {
        if info.samples_per_shot == 0 {
            return Err(RecordError::Empty {
                source_name: name(path),
            });
        }
        let part = exclusive(path).map_err(|error| refused(path, &error))?;
        let started = start(part.path(), info);
        let open = started.map_err(|error| unwritable(path, &error))?;
        Ok(Self {
            path: path.to_owned(),
            part,
            open: Growing(Some(open)),
            samples_per_shot: info.samples_per_shot,
            table: Table {
                long_names: info.long_names,
                ..Table::default()
            },
        })
    }

    /// Writes one shot.
    ///
    /// # Errors
    /// [`RecordError::Misfit`] if it has not the series' samples or true values;
    /// [`RecordError::Unwritable`], after which the series cannot be finished.
    pub fn push(&mut self, row: &ShotRow<'_>) -> Result<(), RecordError> {
        self.fits(row)?;
        let at = self.table.shots.len();
        let open = self.open.0.as_ref().ok_or_else(|| self.lost())?;
        for (channel, samples) in open.channels.iter().zip(self.cut(row.samples)) {
            let written = append(channel, at, samples);
            written.map_err(|error| unwritable(&self.path, &error))?;
        }
        self.table.push(row);
        Ok(())
    }

    /// Completes the file and gives it its name.
    ///
    /// # Errors
    /// [`RecordError::Empty`] without shots, [`RecordError::Unwritable`].
    pub fn finish(mut self) -> Result<PathBuf, RecordError> {
        if self.table.shots.is_empty() {
            return Err(RecordError::Empty {
                source_name: name(&self.path),
            });
        }
        let open = self.open.0.take().ok_or_else(|| self.lost())?;
        let written = self.table.write(&open).and_then(|()| {
            let Open { file, channels } = open;
            drop(channels);
            file.close()
        });
        written.map_err(|error| unwritable(&self.path, &error))?;
        let sealed = checksum::append(self.part.as_file());
        let sealed = sealed.and_then(|()| named(self.part, &self.path));
        sealed.map_err(|error| refused(&self.path, &error))?;
        Ok(self.path)
    }

    /// The samples of each channel.
    fn cut<'a>(&self, samples: &'a [i16]) -> std::slice::ChunksExact<'a, i16> {
        samples.chunks_exact(self.samples_per_shot)
    }

    fn fits(&self, row: &ShotRow<'_>) -> Result<(), RecordError> {
        let misfit = |detail: String| RecordError::Misfit {
            file: name(&self.path),
            shot: row.shot,
            detail,
        };
        let channels = self.open.0.as_ref().map_or(1, |open| open.channels.len());
        let all = channels * self.samples_per_shot;
        if row.samples.len() != all {
            let found = row.samples.len();
            return Err(misfit(format!("{found} samples in place of {all}")));
        }
        if i64::try_from(row.shot).is_err() {
            return Err(misfit("its number is beyond all bounds".to_owned()));
        }
        let known = self.table.truth.iter().map(|column| column.0);
        if !self.table.shots.is_empty() && !known.eq(row.truth.iter().map(|value| value.0)) {
            return Err(misfit("other true values than before".to_owned()));
        }
        let across = |values: &(&'static str, &[f64])| (values.0, values.1.len());
        let shots = self.table.shots.len();
        let known = self.table.contacts.iter();
        let known = known.map(|table| (table.0, table.1.len() / shots.max(1)));
        if shots > 0 && !known.eq(row.contacts.iter().map(across)) {
            return Err(misfit(
                "other true values of contacts than before".to_owned(),
            ));
        }
        Ok(())
    }

    fn lost(&self) -> RecordError {
        RecordError::Unwritable {
            file: name(&self.path),
            detail: "it is closed".to_owned(),
        }
    }
}

/// `None` once finished.
struct Growing(Option<Open>);

impl Drop for Growing {
    fn drop(&mut self) {
        // Dropped, the library would complete a file that goes away and, on a full disk,
        // complain of it to the terminal.
        std::mem::forget(self.0.take());
    }
}

impl Table {
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

    /// What a true value is; its name again where nobody says.
    fn long_name<'a>(&self, name: &'a str) -> &'a str {
        let told = self.long_names.iter().find(|(of, _)| *of == name);
        told.map_or(name, |(_, what)| what)
    }

    fn write(&self, open: &Open) -> Result<(), Hdf5Error> {
        let Open { file, channels } = open;
        let root = file.root_group();
        let shots = column(&root, layout::SHOT, "number of the shot", "1", &self.shots)?;
        shots.set_scale(Some(layout::SHOT))?;
        let length = channels.first().and_then(|c| c.shape().get(1).copied());
        let axis = sample_axis(file, length.unwrap_or(1))?;
        for channel in channels {
            channel.attach_scale(0, &shots)?;
            channel.attach_scale(1, &axis)?;
        }
        for (name, what, values) in [
            (
                layout::PROGRAMMED,
                "speed told to the striker",
                &self.programmed,
            ),
            (layout::MEASURED, "speed by the photogate", &self.measured),
        ] {
            column(&root, name, what, "m s-1", values)?.attach_scale(0, &shots)?;
        }
        let fired = "1 if the trigger fired, 0 if its level was never passed";
        column(&root, layout::TRIGGERED, fired, "1", &self.triggered)?.attach_scale(0, &shots)?;
        let truth = file.create_group(layout::TRUTH)?;
        truth.set_attr_string("comment", "known to the simulation, not to the rig")?;
        for (name, values) in &self.truth {
            let what = self.long_name(name);
            column(&truth, name, what, unit(name), values)?.attach_scale(0, &shots)?;
        }
        self.write_contacts(&truth, &shots)
    }

    /// Tables of shots and contacts.
    fn write_contacts(&self, truth: &H5Group, shots: &H5Dataset) -> Result<(), Hdf5Error> {
        let Some((_, first)) = self.contacts.first() else {
            return Ok(());
        };
        let across = first.len() / self.shots.len().max(1);
        let numbers: Vec<i64> = (1..).take(across).collect();
        let axis = column(
            truth,
            layout::CONTACT,
            "number of the contact",
            "1",
            &numbers,
        )?;
        axis.set_scale(Some(layout::CONTACT))?;
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
        .create(layout::SAMPLE)?;
    let nothing = "This is a netCDF dimension but not a netCDF variable.";
    axis.set_scale(Some(&format!("{nothing}{count:10}")))?;
    Ok(axis)
}

/// A column of numbers with its unit.
fn column<T: rust_hdf5::H5Type>(
    group: &H5Group,
    name: &str,
    what: &str,
    unit: &str,
    values: &[T],
) -> Result<H5Dataset, Hdf5Error> {
    let column = group
        .new_dataset::<T>()
        .shape([values.len()])
        .create(name)?;
    column.write_raw(values)?;
    describe(&column, what, unit)?;
    Ok(column)
}

pub(crate) fn describe(of: &H5Dataset, what: &str, unit: &str) -> Result<(), Hdf5Error> {
    for (name, text) in [("long_name", what), ("units", unit)] {
        of.new_attr::<rust_hdf5::VarLenUnicode>()
            .shape(())
            .create(name)?
            .write_string(text)?;
    }
    Ok(())
}

/// The unit that a name ends in, as CF conventions write it.
pub(crate) fn unit(name: &str) -> &'static str {
    const ENDINGS: &[(&str, &str)] = &[
        ("_m_s", "m s-1"),
        ("_s", "s"),
        ("_m", "m"),
        ("_n", "N"),
        ("_v", "V"),
        ("_j", "J"),
    ];
    let lower = name.to_ascii_lowercase();
    let found = ENDINGS.iter().find(|ending| lower.ends_with(ending.0));
    found.map_or("1", |ending| ending.1)
}

fn start(part: &Path, info: &SeriesInfo) -> Result<Open, Hdf5Error> {
    let file = H5File::create(part)?;
    attributes(&file, info)?;
    let names = info.channels.names().iter();
    let channels: Result<Vec<H5Dataset>, Hdf5Error> =
        names.map(|name| channel(&file, name, info)).collect();
    Ok(Open {
        channels: channels?,
        file,
    })
}

/// An empty channel.
fn channel(file: &H5File, name: &str, info: &SeriesInfo) -> Result<H5Dataset, Hdf5Error> {
    let samples = file
        .new_dataset::<i16>()
        .shape([0, info.samples_per_shot])
        .chunk(&[1, info.samples_per_shot.min(MOST_IN_CHUNK)])
        .max_shape(&[None, Some(info.samples_per_shot)])
        .shuffle_deflate(DEFLATE)
        .create(name)?;
    let what = match info.channels {
        Channels::Summed => "voltage of the summed sensors".to_owned(),
        Channels::Separate => format!("voltage of the {name}"),
    };
    describe(&samples, &what, "V")?;
    sampling(&samples, info)?;
    Ok(samples)
}

/// How samples were taken, with the sampling interval; what xarray and every
/// reader of CF conventions turn counts into V with.
fn sampling(samples: &H5Dataset, info: &SeriesInfo) -> Result<(), Hdf5Error> {
    for (name, value) in [
        (layout::INTERVAL, info.interval_s),
        (layout::VOLTS_PER_COUNT, info.volts_per_count),
        (layout::OFFSET, info.offset_v),
        ("scale_factor", info.volts_per_count),
        ("add_offset", info.offset_v),
    ] {
        let attribute = samples.new_attr::<f64>().shape(()).create(name)?;
        attribute.write_numeric(&value)?;
    }
    let pretrigger = samples.new_attr::<u64>().shape(());
    pretrigger
        .create(layout::PRETRIGGER)?
        .write_numeric(&(info.pretrigger as u64))
}

fn attributes(file: &H5File, info: &SeriesInfo) -> Result<(), Hdf5Error> {
    file.set_attr_string(layout::FORMAT.0, layout::FORMAT.1)?;
    file.set_attr_numeric(layout::VERSION.0, &layout::VERSION.1)?;
    file.set_attr_numeric(layout::SERIES, &info.series)?;
    file.set_attr_numeric(layout::SEED, &info.seed)?;
    file.set_attr_string(layout::CASE, &info.case)?;
    file.set_attr_string(layout::EXPERIMENT, &info.experiment)?;
    for (name, text) in &info.more {
        file.set_attr_string(name, text)?;
    }
    Ok(())
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

fn refused(path: &Path, error: &std::io::Error) -> RecordError {
    unwritable(path, error)
}

fn unwritable(path: &Path, error: &dyn std::error::Error) -> RecordError {
    let text = error.to_string();
    let full = std::io::Error::from_raw_os_error(NO_SPACE).to_string();
    let advice = match text.contains(&full) {
        true => "; make room and run again",
        false => "",
    };
    RecordError::Unwritable {
        file: name(path),
        detail: text + advice,
    }
}
