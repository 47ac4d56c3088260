//! `live`: recordings of a folder, measured as they appear.

use crate::failure::Failure;
use crate::measure::{self, MeasureResult};
use crate::options::MeasureOptions;
use hertzchain_measure::{Measurement, Note, Options, ShotList};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Size of a file and when it last changed.
type Stamp = (u64, Option<SystemTime>);

/// Recordings of a folder, each measured once it has not changed between two updates, and again when
/// it or its line in the table of shots has changed.
///
/// It keeps nothing that the folder does not have: a new one over the same folder has the same shots.
///
/// ```
/// use hertzchain::live::LiveMeasurement;
/// use hertzchain::prelude::*;
///
/// let folder = std::env::temp_dir().join(format!("live-{}", std::process::id()));
/// std::fs::create_dir_all(&folder)?;
/// let mut live = LiveMeasurement::new(&folder, &MeasureOptions::default())?;
/// assert!(live.update()?.is_empty());
/// assert!(live.result().shots.shots.is_empty());
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct LiveMeasurement {
    folder: PathBuf,
    arguments: MeasureOptions,
    options: Options,
    list: Option<Stamp>,
    seen: BTreeMap<PathBuf, Stamp>,
    measured: BTreeMap<PathBuf, (Stamp, Measurement)>,
    /// What the folder has beside recordings.
    notes: Vec<Note>,
    /// Why the table of shots that is there now was not read, if so; the one before still holds.
    pub list_error: Option<String>,
}

impl LiveMeasurement {
    /// Starts on a folder, which may still be empty.
    ///
    /// # Errors
    /// Options that do not go together; a table of shots that can't be used.
    pub fn new(folder: &Path, arguments: &MeasureOptions) -> Result<Self, Failure> {
        Ok(Self {
            folder: folder.to_owned(),
            arguments: arguments.clone(),
            options: measure::options(arguments, measure::rig(arguments)?.as_ref())?,
            list: arguments.shots.as_deref().and_then(stamp),
            seen: BTreeMap::new(),
            measured: BTreeMap::new(),
            notes: Vec::new(),
            list_error: None,
        })
    }

    /// Measures what has appeared or changed, and returns these files and those that are gone.
    ///
    /// # Errors
    /// A folder that can't be read.
    pub fn update(&mut self) -> Result<Vec<PathBuf>, Failure> {
        self.update_list();
        let (files, mut others) = measure::recordings(&self.folder)?;
        let is_list = measure::is_list(self.arguments.shots.as_deref());
        let stamped = files.into_iter().filter(|file| !is_list(file));
        let found: BTreeMap<PathBuf, Stamp> =
            stamped.filter_map(|file| Some((file.clone(), stamp(&file)?))).collect();
        others.retain(|(other, _)| !is_list(other));
        self.notes = measure::passed_over(&self.folder, others);
        let gone = self.measured.extract_if(.., |file, _| !found.contains_key(file));
        let gone: Vec<PathBuf> = gone.map(|(file, _)| file).collect();
        let is_measured = |file: &PathBuf, stamp: &Stamp| {
            self.measured.get(file).is_some_and(|(measured, _)| measured == stamp)
        };
        let new = found.iter().filter(|(file, stamp)| {
            self.seen.get(*file) == Some(stamp) && !is_measured(file, stamp)
        });
        let new: Vec<(PathBuf, Stamp)> = new.map(|(file, stamp)| (file.clone(), *stamp)).collect();
        self.seen = found;
        for (file, stamp) in &new {
            let of_file = std::slice::from_ref(file);
            let measured = hertzchain_measure::measure(of_file, &self.options, &());
            self.measured.insert(file.clone(), (*stamp, measured));
        }
        Ok(new.into_iter().map(|(file, _)| file).chain(gone).collect())
    }

    /// Returns what came of a file, once it is measured.
    pub fn measured(&self, file: &Path) -> Option<&Measurement> {
        self.measured.get(file).map(|(_, measured)| measured)
    }

    /// Whether all recordings that the last update has seen are measured.
    pub(crate) fn is_complete(&self) -> bool {
        self.seen.keys().all(|file| self.measured.contains_key(file))
    }

    /// Returns all shots so far, in the order of their files' names, and their curves: what
    /// [`measure`](crate::measure()) returns for the folder.
    pub fn result(&self) -> MeasureResult {
        let files = self.measured.iter().map(|(file, (_, measured))| (file, measured));
        let mut shots = Measurement::of_files(files, self.options.list.as_ref());
        shots.notes.splice(0..0, self.notes.iter().cloned());
        let curves = shots.curves(&measure::grouping(&self.arguments));
        MeasureResult { shots, curves }
    }

    /// Reads the table of shots again if it has changed, and forgets the files of which it says
    /// something else now. One that can't be read, and may still be written, is tried again when it
    /// has changed.
    fn update_list(&mut self) {
        let Some(path) = self.arguments.shots.as_deref() else { return };
        let now = stamp(path);
        if now == self.list {
            return;
        }
        self.list = now;
        let list = match measure::list(path) {
            Ok(list) => list,
            Err(error) => {
                self.list_error = Some(error.to_string());
                return;
            }
        };
        self.list_error = None;
        let before = self.options.list.replace(list.clone());
        let agrees = |measured: &Measurement| {
            let same =
                |before: &ShotList| measured.shots.iter().all(|shot| list.agrees_on(before, shot));
            before.as_ref().is_some_and(same)
        };
        self.measured.retain(|_, (_, measured)| agrees(measured));
    }
}

fn stamp(file: &Path) -> Option<Stamp> {
    let metadata = fs::metadata(file).ok()?;
    Some((metadata.len(), metadata.modified().ok()))
}
