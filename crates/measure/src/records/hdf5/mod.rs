//! HDF5: series of ours, and other programs' files of datasets.

mod foreign;

use crate::records::error::RecordError;
use crate::records::options::ReadOptions;
use crate::records::read::Raw;
use crate::records::series;
use rust_hdf5::{H5Dataset, H5File, Hdf5Error};
use std::path::Path;

/// Opens a file of either.
pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw, RecordError> {
    let open = H5File::open(file)
        .map_err(|error| RecordError::malformed(file, "HDF5", damaged(&error)))?;
    match series::is_ours(&open) {
        true => series::open(file, &open, options),
        false => foreign::open(file, open, options),
    }
}

/// A dataset whose numbers are in this file. What lies in other files could be any file of the
/// machine: external links, external storage and virtual datasets are refused.
pub(crate) fn dataset(open: &H5File, name: &str) -> Result<H5Dataset, Hdf5Error> {
    let elsewhere = |how: &str| {
        let detail = format!("{name:?} {how}, which are not read: copy its numbers into this file");
        Hdf5Error::InvalidState(detail)
    };
    if !open.dataset_names().iter().any(|known| known == name) {
        let how = "is missing, or a link to another file";
        return Err(Hdf5Error::InvalidState(format!("{name:?} {how}")));
    }
    let dataset = open.dataset(name)?;
    if !dataset.external_files()?.is_empty() || !dataset.virtual_mappings()?.is_empty() {
        return Err(elsewhere("has its numbers in other files"));
    }
    Ok(dataset)
}

/// What the library says, after the likeliest reason.
pub(crate) fn damaged(error: &Hdf5Error) -> String {
    format!("cut short or damaged ({error})")
}
