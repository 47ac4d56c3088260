//! Several arrays in a ZIP.

use super::array::Array;
use super::place::Place;
use crate::records::arrays::{self, Arrays};
use crate::records::channels;
use crate::records::error::RecordError;
use crate::records::options::ReadOptions;
use crate::records::read::Raw;
use std::collections::HashMap;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use zip::{CompressionMethod, ZipArchive};

/// An array in the file.
#[derive(Clone, Debug)]
struct Entry {
    name: String,
    place: Place,
}

/// An archive of arrays.
struct Archive {
    file: PathBuf,
    entries: Vec<Entry>,
    /// Places in that list.
    by_name: HashMap<String, usize>,
}

/// Opens an archive of arrays.
pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw, RecordError> {
    let entries = entries(file)?;
    let names = entries.iter().enumerate().rev();
    let archive = Archive {
        file: file.to_owned(),
        by_name: names.map(|(at, entry)| (entry.name.clone(), at)).collect(),
        entries,
    };
    arrays::open(Rc::new(archive), options)
}

impl Arrays for Archive {
    fn file(&self) -> &Path {
        &self.file
    }

    fn names(&self) -> Vec<String> {
        self.entries
            .iter()
            .map(|entry| entry.name.clone())
            .collect()
    }

    fn shape(&self, name: &str) -> Result<Vec<usize>, RecordError> {
        self.array(name).map(|array| array.shape)
    }

    fn values(&self, name: &str) -> Result<Vec<f64>, RecordError> {
        self.array(name)?.values()
    }

    fn records(
        &self,
        name: &str,
        interval_s: f64,
        options: &ReadOptions,
    ) -> Result<Raw, RecordError> {
        self.array(name)?.records(interval_s, options)
    }
}

impl Archive {
    fn array(&self, name: &str) -> Result<Array, RecordError> {
        let entry = self.by_name.get(name).and_then(|at| self.entries.get(*at));
        match entry {
            Some(entry) => Array::open(entry.place.clone(), Some(entry.name.clone())),
            None => Err(RecordError::NoChannel {
                file: crate::records::error::name(&self.file),
                wanted: name.to_owned(),
                there: channels::list(&self.names()),
            }),
        }
    }
}

fn entries(file: &Path) -> Result<Vec<Entry>, RecordError> {
    let opened = File::open(file).map_err(|cause| RecordError::reading(file, cause))?;
    let refused = |error: zip::result::ZipError| {
        RecordError::malformed(file, "NPZ", format!("cut short or damaged ({error})"))
    };
    let mut archive = ZipArchive::new(BufReader::new(opened)).map_err(refused)?;
    let mut entries = Vec::new();
    for index in 0..archive.len() {
        let entry = archive.by_index_raw(index).map_err(refused)?;
        let Some(name) = entry
            .name()
            .map_err(refused)?
            .strip_suffix(".npy")
            .map(str::to_owned)
        else {
            continue;
        };
        let deflated = match entry.compression() {
            CompressionMethod::Stored => false,
            method if method == CompressionMethod::DEFLATE => true,
            method => {
                let detail = format!("{name} is compressed by {method:?}; use savez_compressed");
                return Err(RecordError::malformed(file, "NPZ", detail));
            }
        };
        let start = entry.data_start().ok_or_else(|| {
            RecordError::malformed(file, "NPZ", format!("{name} has no place in the file"))
        })?;
        entries.push(Entry {
            name,
            place: Place {
                file: file.to_owned(),
                start,
                size: entry.compressed_size(),
                deflated,
            },
        });
    }
    Ok(entries)
}
