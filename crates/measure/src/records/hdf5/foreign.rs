//! Datasets of numbers that another program wrote.

use super::{damaged, dataset};
use crate::records::arrays::{self, Arrays, Axes, INTERVALS, RATES, Table};
use crate::records::cut::{Cut, Stream};
use crate::records::error::{RecordError, name};
use crate::records::options::ReadOptions;
use crate::records::read::Raw;
use crate::records::record::Samples;
use crate::records::series::attribute_number;
use rust_hdf5::{DatatypeMessage, H5Dataset, H5File, Hdf5Error};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// An open file and the paths of its datasets of numbers.
struct Datasets {
    file: PathBuf,
    open: H5File,
    names: Vec<String>,
}

/// Opens a file by its datasets.
pub(super) fn open(file: &Path, open: H5File, options: &ReadOptions) -> Result<Raw, RecordError> {
    let mut names = open.dataset_names();
    names.retain(|name| {
        let kind = open.dataset(name).and_then(|dataset| dataset.datatype());
        matches!(
            kind,
            Ok(DatatypeMessage::FixedPoint { .. } | DatatypeMessage::FloatingPoint { .. })
        )
    });
    if names.is_empty() {
        return Err(RecordError::Empty {
            source_name: name(file),
        });
    }
    let datasets = Datasets {
        file: file.to_owned(),
        open,
        names,
    };
    arrays::open(Rc::new(datasets), options)
}

impl Datasets {
    fn dataset(&self, name: &str) -> Result<H5Dataset, RecordError> {
        let refused = |error| refused(&self.file, name, &error);
        dataset(&self.open, name).map_err(refused)
    }
}

fn refused(file: &Path, dataset: &str, error: &Hdf5Error) -> RecordError {
    let detail = format!("dataset {dataset:?} is {}", damaged(error));
    RecordError::malformed(file, "HDF5", detail)
}

impl Arrays for Datasets {
    fn file(&self) -> &Path {
        &self.file
    }

    fn names(&self) -> Vec<String> {
        self.names.clone()
    }

    fn shape(&self, name: &str) -> Result<Vec<usize>, RecordError> {
        self.dataset(name).map(|dataset| dataset.shape())
    }

    fn values(&self, name: &str) -> Result<Vec<f64>, RecordError> {
        let values = self.dataset(name)?.read_numeric_as::<f64>();
        values.map_err(|error| refused(&self.file, name, &error))
    }

    fn records(
        &self,
        name: &str,
        interval_s: f64,
        options: &ReadOptions,
    ) -> Result<Raw, RecordError> {
        let dataset = self.dataset(name)?;
        let (file, shape) = (self.file.clone(), dataset.shape());
        let table = Table::of(&file, Some(name.to_owned()), &shape, interval_s, options)?;
        let rows = Rows {
            file,
            name: name.to_owned(),
            dataset,
            axes: table.axes,
            chosen: table.chosen,
            frames: table.frames,
            at: 0,
        };
        Ok(Box::new(Cut::new(table.head.divided(options.parts), rows)))
    }

    fn stated_s(&self) -> Option<f64> {
        let number = |names: &[&str]| {
            let datasets = self.names.iter().filter_map(|name| self.dataset(name).ok());
            let mut found = datasets.flat_map(|dataset| {
                let values = names.iter().map(|name| attribute_number(&dataset, name));
                values.filter_map(Result::ok).collect::<Vec<f64>>()
            });
            found.next()
        };
        number(INTERVALS).or_else(|| number(RATES).map(f64::recip))
    }
}

/// A dataset, read shot by shot or piece by piece.
struct Rows {
    file: PathBuf,
    name: String,
    dataset: H5Dataset,
    axes: Axes,
    chosen: Vec<usize>,
    frames: usize,
    at: usize,
}

impl Rows {
    /// The next samples of one channel.
    fn channel(&self, channel: usize, count: usize) -> Result<Samples, Hdf5Error> {
        let rank = self.dataset.shape().len();
        let (mut starts, mut counts) = (vec![0; rank], vec![1; rank]);
        let mut select = |axis: Option<usize>, start, count| {
            if let Some(axis) = axis {
                starts[axis] = start;
                counts[axis] = count;
            }
        };
        select(self.axes.shots, self.at / self.frames, 1);
        select(self.axes.channels, channel, 1);
        select(Some(self.axes.time), self.at % self.frames, count);
        numbers(&self.dataset, &starts, &counts)
    }
}

impl Stream for Rows {
    fn take(&mut self, count: usize) -> Result<Vec<Samples>, RecordError> {
        let channels = self.chosen.iter();
        let taken: Result<Vec<Samples>, Hdf5Error> = channels
            .map(|channel| self.channel(*channel, count))
            .collect();
        self.at += count;
        taken.map_err(|error| refused(&self.file, &self.name, &error))
    }
}

/// Part of a dataset, whatever numbers it holds.
fn numbers(dataset: &H5Dataset, starts: &[usize], counts: &[usize]) -> Result<Samples, Hdf5Error> {
    Ok(match dataset.datatype()? {
        DatatypeMessage::FixedPoint {
            size: 2,
            signed: true,
            ..
        } => Samples::Counts {
            counts: dataset.read_slice::<i16>(starts, counts)?,
            volts_per_count: 1.0,
            offset_v: 0.0,
        },
        DatatypeMessage::FixedPoint { .. } => {
            let whole = dataset.read_numeric_slice_as::<i64>(starts, counts)?;
            Samples::Volts(whole.into_iter().map(|number| number as f64).collect())
        }
        _ => Samples::Volts(dataset.read_numeric_slice_as::<f64>(starts, counts)?),
    })
}
