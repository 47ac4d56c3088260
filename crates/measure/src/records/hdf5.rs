//! HDF5: datasets of any program, and tables of results.

use crate::error::{MeasureError, Result, file_name};
use crate::records::arrays::{self, Arrays, Axes, INTERVALS, RATES, SampleTable};
use crate::records::files::{exclusive, persist};
use crate::records::mat::{DEEPEST, cell_name};
use crate::records::options::ReadOptions;
use crate::records::read::Raw;
use crate::records::record::{Samples, converter_range_v};
use crate::records::series;
use crate::records::stored::{NumberKind, StoredNumber};
use crate::records::text::volts;
use indexmap::{IndexMap, IndexSet};
use rust_hdf5::format::FormatContext;
use rust_hdf5::format::messages::attribute::AttributeMessage;
use rust_hdf5::{ByteOrder, DatatypeMessage, H5Dataset, H5File, H5Type, Hdf5Error, VarLenUnicode};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::rc::Rc;

const ABOUT: &str = "about";

/// Effort of the compression of tables: numbers that follow a curve lose a third of their bytes at
/// the lowest, and hardly more at the highest.
const DEFLATE: u32 = 1;

/// Rows of a table's chunk, which is compressed and read as one.
const CHUNK: usize = 1 << 16;

/// Endings of names, with units as CF conventions write them.
const UNITS: &[(&str, &str)] =
    &[("_m_s", "m s-1"), ("_s", "s"), ("_m", "m"), ("_n", "N"), ("_v", "V"), ("_j", "J")];

/// Opens a series of a virtual campaign, or the datasets of another program.
pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw> {
    let open =
        H5File::open(file).map_err(|e| MeasureError::malformed(file, "HDF5", damaged(&e)))?;
    if series::is_series(&open) {
        return series::open(file, &open, options);
    }
    let names = Names::of(&open).map_err(|e| MeasureError::malformed(file, "HDF5", damaged(&e)))?;
    let by_matlab = beginning(file, MATLAB.len() as u64);
    let by_matlab = by_matlab.is_ok_and(|bytes| bytes == MATLAB);
    match names.is_empty() {
        true if by_matlab => return Err(arrays::no_samples(file, &[])),
        true => return Err(MeasureError::empty(file_name(file))),
        false => {}
    }
    arrays::open(Rc::new(Datasets { file: file.to_owned(), open, names, by_matlab }), options)
}

/// How MATLAB's user block begins; its columns are HDF5's rows, its texts whole numbers.
const MATLAB: &[u8] = b"MATLAB 7.3";

fn beginning(file: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(file)?.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Bytes of a file in which attributes of groups are searched for.
const SEARCHED: u64 = 1 << 26;

/// The number that attributes of this name, in any case, have, whatever they are of, if it is one.
/// The library reads numbers of datasets only, so messages are searched for by the name: it stands
/// 8 bytes after a message's begin, 9 in version 3.
fn attribute_anywhere(bytes: &[u8], name: &str) -> Option<f64> {
    let ended = [name.as_bytes(), b"\0"].concat();
    let places = places_of(bytes, &ended);
    let value = |at: usize| {
        let message = |before| {
            let message = bytes.get(at.checked_sub(before)?..)?;
            let found = AttributeMessage::decode(message, &FormatContext::default_v3()).ok()?.0;
            found.name.eq_ignore_ascii_case(name).then(|| scalar(&found))?
        };
        message(8).or_else(|| message(9))
    };
    let mut values = places.filter_map(value);
    let first = values.next()?;
    values.all(|value| value == first).then_some(first)
}

/// Where a text is in bytes, in any case.
fn places_of<'a>(bytes: &'a [u8], wanted: &'a [u8]) -> impl Iterator<Item = usize> + 'a {
    let first = wanted.first().map(u8::to_ascii_lowercase);
    let is_first = move |byte: &u8| Some(byte.to_ascii_lowercase()) == first;
    let starts = bytes.iter().enumerate().filter(move |(_, byte)| is_first(byte));
    let there = |at: usize| bytes.get(at..at + wanted.len());
    starts
        .map(|(at, _)| at)
        .filter(move |at| there(*at).is_some_and(|it| it.eq_ignore_ascii_case(wanted)))
}

fn scalar(of: &AttributeMessage) -> Option<f64> {
    let (kind, order) = match of.datatype {
        DatatypeMessage::FloatingPoint { size: 4, byte_order, .. } => (NumberKind::F32, byte_order),
        DatatypeMessage::FloatingPoint { size: 8, byte_order, .. } => (NumberKind::F64, byte_order),
        DatatypeMessage::FixedPoint { size: 4, byte_order, .. } => (NumberKind::I32, byte_order),
        DatatypeMessage::FixedPoint { size: 8, byte_order, .. } => (NumberKind::I64, byte_order),
        _ => return None,
    };
    let number = StoredNumber::plain(kind, order == ByteOrder::BigEndian);
    number.scaled(&of.data).first().copied()
}

/// A dataset whose numbers are in this file. What lies in other files could be any file of the
/// machine: external links, external storage and virtual datasets are refused.
pub(crate) fn dataset(open: &H5File, name: &str) -> Result<H5Dataset, Hdf5Error> {
    dataset_of(open, name, open.dataset_names().iter().any(|known| known == name))
}

fn dataset_of(open: &H5File, name: &str, is_there: bool) -> Result<H5Dataset, Hdf5Error> {
    let refused = |why: &str| {
        Hdf5Error::InvalidState(format!(
            "{name:?} {why}, which are not read: copy its numbers into this file"
        ))
    };
    if !is_there {
        return Err(refused("is missing, or one of the links to other files"));
    }
    let dataset = open.dataset(name)?;
    if !dataset.external_files()?.is_empty() || !dataset.virtual_mappings()?.is_empty() {
        return Err(refused("has its numbers in other files"));
    }
    Ok(dataset)
}

pub(crate) fn column<T: H5Type>(
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

pub(crate) fn attribute(of: &H5Dataset, name: &str) -> Result<f64, Hdf5Error> {
    let attribute = of.attr(name)?;
    let value = match attribute.read_numeric_as::<f64>() {
        Ok(floats) => floats.first().copied(),
        Err(_) => {
            let whole = attribute.read_numeric_as::<u64>()?;
            whole.first().map(|whole| *whole as f64)
        }
    };
    value.ok_or_else(|| Hdf5Error::NotFound(name.to_owned()))
}

/// The library's message, after the likeliest reason.
pub(crate) fn damaged(error: &Hdf5Error) -> String {
    format!("cut short or damaged ({error})")
}

/// Writes what a dataset is, with the unit that its name ends in.
pub(crate) fn describe(of: &H5Dataset, what: &str, unit: &str) -> Result<(), Hdf5Error> {
    for (name, text) in [("long_name", what), ("units", unit)] {
        of.new_attr::<VarLenUnicode>().shape(()).create(name)?.write_string(text)?;
    }
    Ok(())
}

pub(crate) fn unit(name: &str) -> &'static str {
    let lower = name.to_ascii_lowercase();
    let found = UNITS.iter().find(|ending| lower.ends_with(ending.0));
    found.map_or("1", |ending| ending.1)
}

struct Datasets {
    file: PathBuf,
    open: H5File,
    /// Where the dataset of each name is.
    names: IndexMap<String, String>,
    by_matlab: bool,
}

impl Datasets {
    fn dataset(&self, name: &str) -> Result<H5Dataset> {
        let path = self.names.get(name);
        let found = dataset_of(&self.open, path.map_or(name, |path| path), path.is_some());
        found.map_err(|error| refused(&self.file, name, &error))
    }

    /// Axes in the order of the program that wrote them.
    fn axes(&self, mut shape: Vec<usize>) -> Vec<usize> {
        if self.by_matlab {
            shape.reverse();
        }
        shape
    }
}

fn refused(file: &Path, dataset: &str, error: &Hdf5Error) -> MeasureError {
    let detail = format!("dataset {dataset:?} is {}", damaged(error));
    MeasureError::malformed(file, "HDF5", detail)
}

impl Arrays for Datasets {
    fn file(&self) -> &Path {
        &self.file
    }

    fn names(&self) -> Vec<String> {
        self.names.keys().cloned().collect()
    }

    fn shape(&self, name: &str) -> Result<Vec<usize>> {
        self.dataset(name).map(|dataset| self.axes(dataset.shape()))
    }

    fn values(&self, name: &str) -> Result<Vec<f64>> {
        let dataset = self.dataset(name)?;
        let values = match dataset.datatype() {
            Ok(DatatypeMessage::FixedPoint { .. }) => {
                let whole = dataset.read_numeric_as::<i64>();
                whole.map(|whole| whole.into_iter().map(|number| number as f64).collect())
            }
            _ => dataset.read_numeric_as::<f64>(),
        };
        values.map_err(|error| refused(&self.file, name, &error))
    }

    fn records(&self, name: &str, interval_s: f64, options: &ReadOptions) -> Result<Raw> {
        let dataset = self.dataset(name)?;
        let shape = self.axes(dataset.shape());
        let part = Some(name.to_owned());
        let SampleTable { axes, chosen, head } =
            SampleTable::new(&self.file, part, &shape, interval_s, options)?;
        let number = |attr: &str| attribute(&dataset, attr).ok();
        let unit_v = self.unit(name).and_then(|unit| volts(&unit)).unwrap_or(1.0);
        let scale = (
            unit_v * number("scale_factor").unwrap_or(1.0),
            unit_v * number("add_offset").unwrap_or(0.0),
        );
        let (file, name, of) = (self.file.clone(), name.to_owned(), (axes, self.by_matlab));
        Ok(head.records(options.parts, move |row, from, count| {
            let one = |channel: &usize| slice(&dataset, of, scale, (row, *channel), (from, count));
            let taken: Result<_, _> = chosen.iter().map(one).collect();
            taken.map_err(|error| refused(&file, &name, &error))
        }))
    }

    fn unit(&self, name: &str) -> Option<String> {
        let dataset = self.dataset(name).ok()?;
        let mut names = dataset.attr_names().unwrap_or_default().into_iter();
        let name = names.find(|name| ["unit", "units"].contains(&&*name.to_lowercase()))?;
        dataset.attr(&name).ok()?.read_string().ok()
    }

    fn stated_s(&self, names: &[String]) -> [Vec<f64>; 2] {
        let of = |datasets: &[H5Dataset], names: &[&str]| -> Vec<f64> {
            let stated = |of: &H5Dataset| {
                let mut there = of.attr_names().unwrap_or_default();
                there.retain(|name| names.contains(&&*name.to_lowercase()));
                there.iter().find_map(|name| attribute(of, name).ok())
            };
            datasets.iter().filter_map(stated).collect()
        };
        let datasets = names.iter().filter_map(|name| self.dataset(name).ok());
        let datasets: Vec<H5Dataset> = datasets.collect();
        let rates = of(&datasets, RATES);
        [of(&datasets, INTERVALS), rates.into_iter().map(f64::recip).collect()]
    }

    fn stated_anywhere_s(&self) -> [Option<f64>; 2] {
        let bytes = beginning(&self.file, SEARCHED).unwrap_or_default();
        let first = |names: &[&str]| names.iter().find_map(|n| attribute_anywhere(&bytes, n));
        let stated = [first(INTERVALS), first(RATES).map(f64::recip)];
        stated.map(|step| step.filter(|step| step.is_finite() && *step > 0.0))
    }
}

/// Samples of a channel and a row from a sample on, and the range of whole numbers of 16 bits.
fn slice(
    dataset: &H5Dataset,
    (axes, by_matlab): (Axes, bool),
    (scale, offset): (f64, f64),
    (row, channel): (usize, usize),
    (from, count): (usize, usize),
) -> Result<Samples, Hdf5Error> {
    let rank = dataset.shape().len();
    let (mut starts, mut counts) = (vec![0; rank], vec![1; rank]);
    let places =
        [(axes.shots, row, 1), (axes.channels, channel, 1), (Some(axes.time), from, count)];
    for (axis, start, count) in places {
        if let Some(axis) = axis {
            let axis = if by_matlab { rank - 1 - axis } else { axis };
            (starts[axis], counts[axis]) = (start, count);
        }
    }
    Ok(match dataset.datatype()? {
        DatatypeMessage::FixedPoint { size, signed, .. } => {
            let whole = dataset.read_numeric_slice_as::<i64>(&starts, &counts)?;
            let volts: Vec<f64> =
                whole.into_iter().map(|number| number as f64 * scale + offset).collect();
            let range_v = (size == 2 && signed).then(|| converter_range_v(&volts, scale, offset));
            (volts, range_v)
        }
        _ => {
            let mut volts = dataset.read_numeric_slice_as::<f64>(&starts, &counts)?;
            volts.iter_mut().for_each(|value| *value = *value * scale + offset);
            (volts, None)
        }
    })
}

const CLASS: &str = "MATLAB_class";
/// Of an array without elements, whose dataset has its axes.
const EMPTY: &str = "MATLAB_empty";
const CELLS: &str = "cell";
/// MATLAB's classes that are no numbers, and groups for its own use.
const NO_NUMBERS: &[&str] = &["char", "struct", "logical", "function_handle"];
const INTERNAL: &[&str] = &["#refs#", "#subsystem#"];

/// Names of datasets as MATLAB has them, and where each is.
struct Names<'a> {
    open: &'a H5File,
    datasets: IndexSet<String>,
    found: IndexMap<String, String>,
    /// Cells and groups that were looked into: references can form circles.
    seen: IndexSet<String>,
}

impl<'a> Names<'a> {
    /// Those of a file.
    fn of(open: &'a H5File) -> Result<IndexMap<String, String>, Hdf5Error> {
        let datasets: IndexSet<String> = open.dataset_names().into_iter().collect();
        let mut names = Self { open, datasets, found: IndexMap::new(), seen: IndexSet::new() };
        let mut own: Vec<String> = names.datasets.iter().cloned().collect();
        own.retain(|path| !INTERNAL.iter().any(|group| relative(path).starts_with(group)));
        own.into_iter().try_for_each(|path| names.add(path.clone(), &path, 0))?;
        Ok(names.found)
    }

    /// Adds the numbers of an object: a dataset's own, those of its cells, or of a group's fields.
    fn add(&mut self, name: String, path: &str, depth: usize) -> Result<(), Hdf5Error> {
        if !self.datasets.contains(path) {
            return self.add_fields(&name, path, depth);
        }
        let Ok(dataset) = self.open.dataset(path) else {
            // What it is said to be is found out where it is read.
            self.found.insert(name, path.to_owned());
            return Ok(());
        };
        let class = dataset.attr(CLASS).and_then(|class| class.read_string()).unwrap_or_default();
        match dataset.datatype() {
            Ok(DatatypeMessage::FixedPoint { .. } | DatatypeMessage::FloatingPoint { .. })
                if !NO_NUMBERS.contains(&&*class) && dataset.attr(EMPTY).is_err() =>
            {
                self.found.insert(name, path.to_owned());
            }
            Ok(kind @ DatatypeMessage::Reference { .. }) if kind == own_reference() => {
                return self.add_cells((&name, path), &dataset, class == CELLS, depth);
            }
            _ => {}
        }
        Ok(())
    }

    /// Adds what the elements of a dataset refer to: cells, or one field of several structs.
    fn add_cells(
        &mut self,
        (name, path): (&str, &str),
        of: &H5Dataset,
        are_cells: bool,
        depth: usize,
    ) -> Result<(), Hdf5Error> {
        if !self.is_new(path, depth) {
            return Ok(());
        }
        let mut shape = of.shape();
        shape.reverse();
        for (at, cell) in of.read_references()?.iter().enumerate() {
            let own = match name.rsplit_once('/') {
                Some((group, field)) if !are_cells => format!("{group}({})/{field}", at + 1),
                _ => cell_name(name, &shape, at),
            };
            if let Some(path) = cell.path() {
                self.add(own, relative(path), depth + 1)?;
            }
        }
        Ok(())
    }

    fn is_new(&mut self, path: &str, depth: usize) -> bool {
        depth <= DEEPEST && self.seen.insert(path.to_owned())
    }

    fn add_fields(&mut self, name: &str, group: &str, depth: usize) -> Result<(), Hdf5Error> {
        if !self.is_new(group, depth) {
            return Ok(());
        }
        let within = |path: &String| Some(path.strip_prefix(group)?.strip_prefix('/')?.to_owned());
        let fields: Vec<String> = self.datasets.iter().filter_map(within).collect();
        fields.into_iter().try_for_each(|field| {
            self.add(format!("{name}/{field}"), &format!("{group}/{field}"), depth + 1)
        })
    }
}

/// References within one file, as MATLAB writes them; others may name another file.
fn own_reference() -> DatatypeMessage {
    DatatypeMessage::object_reference(&FormatContext::default_v3())
}

fn relative(path: &str) -> &str {
    path.trim_start_matches('/')
}

/// Columns of numbers with a text about them, as a file: for results that many processes write
/// and one puts together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnFile {
    /// What the numbers are; in the file a dataset of bytes, UTF-8.
    pub about: String,
    /// Columns of one length, by names whose endings are the units.
    pub columns: Vec<(String, Vec<f64>)>,
}

impl ColumnFile {
    /// Writes the table whole or not at all. Several processes may write one table at once; the
    /// last one stays. The bytes follow from the table alone.
    ///
    /// # Errors
    /// [`MeasureError::Unwritable`].
    pub fn write(&self, path: &Path) -> Result<()> {
        let failed =
            |error: &dyn ToString| MeasureError::Unwritable(file_name(path), error.to_string());
        let part = exclusive(path).map_err(|error| failed(&error))?;
        self.put(part.path()).map_err(|error| failed(&error))?;
        persist(part, path).map_err(|error| failed(&error))
    }

    fn put(&self, part: &Path) -> Result<(), Hdf5Error> {
        let file = H5File::create(part)?;
        let about = file.new_dataset::<u8>().shape([self.about.len()]);
        about.create(ABOUT)?.write_raw(self.about.as_bytes())?;
        for (name, values) in self.columns.iter().filter(|column| !column.1.is_empty()) {
            let column = file
                .new_dataset::<f64>()
                .shape([values.len()])
                .chunk(&[values.len().min(CHUNK)])
                .shuffle_deflate(DEFLATE)
                .create(name)?;
            column.write_raw(values)?;
            describe(&column, name, unit(name))?;
        }
        file.close()
    }

    /// Reads the text of a table and those of the columns that it has; columns without rows are
    /// not in the file.
    ///
    /// # Errors
    /// [`MeasureError::Format`] with what is damaged or missing.
    pub fn read(path: &Path, columns: &[&str]) -> Result<Self> {
        let found = || {
            let open = H5File::open(path)?;
            let about = dataset(&open, ABOUT)?.read_raw::<u8>()?;
            let about = String::from_utf8(about)
                .map_err(|_| Hdf5Error::InvalidState("its text is not UTF-8".to_owned()))?;
            let there = open.dataset_names();
            let mut read = Vec::new();
            for name in columns.iter().copied() {
                if there.iter().any(|known| known == name) {
                    let rows = dataset(&open, name)?.shape().iter().product();
                    read.push((name.to_owned(), column::<f64>(&open, name, rows)?));
                }
            }
            Ok(Self { about, columns: read })
        };
        found().map_err(|e: Hdf5Error| MeasureError::malformed(path, "a table", damaged(&e)))
    }
}
