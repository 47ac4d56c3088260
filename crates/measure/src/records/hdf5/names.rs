//! Datasets of numbers in an HDF5 file, by name; in MATLAB's also those that cells refer to.

use crate::records::mat::{DEEPEST, cell_name};
use indexmap::{IndexMap, IndexSet};
use rust_hdf5::{DatatypeMessage, H5Dataset, H5File, Hdf5Error};

const CLASS: &str = "MATLAB_class";
/// Of an array without elements, whose dataset has its axes.
const EMPTY: &str = "MATLAB_empty";
const CELLS: &str = "cell";
/// MATLAB's classes that are no numbers, and groups for its own use.
const NO_NUMBERS: &[&str] = &["char", "struct", "logical", "function_handle"];
const INTERNAL: &[&str] = &["#refs#", "#subsystem#"];

/// Names of datasets as MATLAB has them, and where each is.
pub(super) struct Names<'a> {
    open: &'a H5File,
    datasets: IndexSet<String>,
    found: IndexMap<String, String>,
    /// Cells and groups that were looked into: references can form circles.
    seen: IndexSet<String>,
}

impl<'a> Names<'a> {
    /// Those of a file.
    pub(super) fn of(open: &'a H5File) -> Result<IndexMap<String, String>, Hdf5Error> {
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
    DatatypeMessage::object_reference(&rust_hdf5::format::FormatContext::default_v3())
}

fn relative(path: &str) -> &str {
    path.trim_start_matches('/')
}
