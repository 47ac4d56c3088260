//! Tables of numbers as HDF5, each with a text that tells what they are: for
//! results that many processes write and one puts together.

use crate::records::error::{RecordError, name};
use crate::records::hdf5::{damaged, dataset};
use crate::records::series::{column, describe, unit};
use crate::records::whole::{exclusive, named};
use rust_hdf5::{H5File, Hdf5Error};
use std::path::Path;

/// Name of the text's dataset.
const ABOUT: &str = "about";

/// Effort of the compression: numbers that follow a curve lose a third of their
/// bytes at the lowest, and hardly more at the highest.
const DEFLATE: u32 = 1;

/// Rows of a chunk, which is compressed and read as one.
const CHUNK: usize = 1 << 16;

/// Columns of numbers with a text about them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// What the numbers are; in the file a dataset of bytes, UTF-8.
    pub about: String,
    /// Columns of one length, by names whose endings are the units.
    pub columns: Vec<(String, Vec<f64>)>,
}

impl Table {
    /// Writes the table beside its place and renames it: what has the name is
    /// whole. Several processes may write one table at once; the last one stays.
    /// The bytes follow from the table alone.
    ///
    /// # Errors
    /// [`RecordError::Unwritable`].
    pub fn write(&self, path: &Path) -> Result<(), RecordError> {
        let failed = |error: &dyn std::error::Error| RecordError::Unwritable {
            file: name(path),
            detail: error.to_string(),
        };
        let part = exclusive(path).map_err(|error| failed(&error))?;
        self.put(part.path()).map_err(|error| failed(&error))?;
        named(part, path).map_err(|error| failed(&error))
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

    /// Reads the text of a table and those columns of it that are asked for;
    /// columns without rows are not in the file.
    ///
    /// # Errors
    /// [`RecordError::Malformed`] with what is damaged or missing.
    pub fn read(path: &Path, columns: &[&str]) -> Result<Self, RecordError> {
        let found = Self::found(path, columns);
        found.map_err(|error| RecordError::malformed(path, "a table", damaged(&error)))
    }

    fn found(path: &Path, columns: &[&str]) -> Result<Self, Hdf5Error> {
        let open = H5File::open(path)?;
        let about = dataset(&open, ABOUT)?.read_raw::<u8>()?;
        let about = String::from_utf8(about)
            .map_err(|_| Hdf5Error::InvalidState("its text is not UTF-8".to_owned()))?;
        let there = open.dataset_names();
        let mut read = Vec::new();
        for name in columns
            .iter()
            .filter(|name| there.iter().any(|n| n == *name))
        {
            let rows = dataset(&open, name)?.shape().iter().product();
            read.push(((*name).to_owned(), column::<f64>(&open, name, rows)?));
        }
        Ok(Self {
            about,
            columns: read,
        })
    }
}
