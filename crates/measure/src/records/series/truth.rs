//! What only a simulation knows of its shots: for tests of analyses, never for
//! an analysis.

use super::layout;
use crate::records::error::RecordError;
use crate::records::hdf5::dataset;
use rust_hdf5::{H5File, Hdf5Error};
use std::path::Path;

/// The columns of true values of a series, by name; what is told of every contact, shot after
/// shot.
///
/// Records that [`read`](crate::records::read) gives do not have them.
///
/// # Errors
/// Files that are not series of ours.
pub fn truth(file: &Path) -> Result<Vec<(String, Vec<f64>)>, RecordError> {
    columns(file).map_err(|error| RecordError::malformed(file, "a series", error))
}

fn columns(file: &Path) -> Result<Vec<(String, Vec<f64>)>, Hdf5Error> {
    let open = H5File::open(file)?;
    let names = open.root_group().group(layout::TRUTH)?.dataset_names()?;
    let column = |name: String| {
        let path = format!("{}/{name}", layout::TRUTH);
        Ok((name, dataset(&open, &path)?.read_raw::<f64>()?))
    };
    let told = names.into_iter().filter(|name| name != layout::CONTACT);
    told.map(column).collect()
}
