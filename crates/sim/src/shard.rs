//! Shards of a batch for several machines: files in a folder, gathered into one result.
//!
//! A shard's name is a hash of the batch's inputs, and its bits depend on nothing else.
//!
//! ```
//! use hertzchain_sim::{Batch, BatchOptions, BatchResult, Column, Shard};
//!
//! let hertz = hertzchain_experiment::preset("hertz")?;
//! let batch = Batch::new(&hertz, vec![0.2, 0.4, 0.8], BatchOptions::of(&hertz))?;
//! let folder = std::env::temp_dir().join(format!("hertzchain-shards-{}", std::process::id()));
//! for shard in Shard::all(2) {
//!     batch.run_into(&folder, shard, &|| {})?;
//! }
//! let whole = BatchResult::gather(&[&folder], None)?;
//! let alone = batch.run(Shard::WHOLE, &|| {});
//! assert_eq!(whole.rows.column(Column::Incident), alone.rows.column(Column::Incident));
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::batch::{Batch, BatchResult};
use crate::error::StudyError;
use crate::fingerprint::Fingerprint;
use crate::result::{COLUMNS, Failed, Rows, WarningSummary};
use crate::stop::stopped;
use hertzchain_experiment::Units;
use hertzchain_measure::records::ColumnFile;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{Display, Formatter, Result as Formatted};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// One of several parts of a batch or a campaign: shots or series are dealt out
/// like cards, so that parts take as long as each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Shard {
    number: usize,
    of: usize,
}

impl Shard {
    /// All of it.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// A shard by its number from 1.
    ///
    /// # Errors
    /// A number that is not among them.
    pub fn new(number: usize, of: usize) -> Result<Self, StudyError> {
        match (1..=of).contains(&number) {
            true => Ok(Self { number, of }),
            false => Err(no_shard(&format!("{number}/{of}"))),
        }
    }

    /// All shards of work that is cut into so many.
    pub fn all(of: usize) -> impl Iterator<Item = Self> {
        (1..=of).map(move |number| Self { number, of })
    }

    /// Which shard it is, from 1.
    pub fn number(self) -> usize {
        self.number
    }

    /// How many shards there are.
    pub fn of(self) -> usize {
        self.of
    }

    /// Whether a shot or a series, by its place from 0, is in this shard.
    pub(crate) fn holds(self, place: usize) -> bool {
        place % self.of == self.number - 1
    }

    /// The places from 0 of what is in this shard, of so many in all.
    pub(crate) fn places(self, count: usize) -> impl Iterator<Item = usize> {
        (self.number - 1..count).step_by(self.of)
    }
}

fn no_shard(text: &str) -> StudyError {
    StudyError::Refused(format!(
        "`{text}` is no part: expected i/n, such as 1/4 for the first of four"
    ))
}

impl Display for Shard {
    fn fmt(&self, f: &mut Formatter<'_>) -> Formatted {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = StudyError;

    fn from_str(text: &str) -> Result<Self, StudyError> {
        let numbers = text.split_once('/').and_then(|(number, of)| {
            let whole = |part: &str| part.trim().parse::<usize>().ok();
            Some((whole(number)?, whole(of)?))
        });
        let (number, of) = numbers.ok_or_else(|| no_shard(text))?;
        Self::new(number, of).map_err(|_| no_shard(text))
    }
}

/// A shard in a folder.
#[derive(Clone, Debug)]
pub struct StoredShard {
    /// Its file.
    pub path: PathBuf,
    /// Whether it was there before, whole.
    pub stored: bool,
    /// Its shots.
    pub result: BatchResult,
}

impl Batch {
    /// Computes a shard into a folder, which is made if need be; one that is there
    /// and whole is only read. `progress` is called after every shot, from any thread.
    ///
    /// A shot that fails is a row of the shard like any other, with its reason.
    ///
    /// # Errors
    /// A folder or a file that can't be written.
    pub fn run_into(
        &self,
        folder: &Path,
        shard: Shard,
        progress: &(dyn Fn() + Sync),
    ) -> Result<StoredShard, StudyError> {
        fs::create_dir_all(folder).map_err(|error| unusable(folder, &error))?;
        let path = folder.join(format!("{}{ENDING}", self.name(shard)));
        // The whole fingerprint: a name has a part of it.
        let same = |found: &BatchResult| found.batch == self.fingerprint() && found.shard == shard;
        // What is not whole is written anew.
        if let Some(result) = BatchResult::read(&path).ok().filter(same) {
            return Ok(StoredShard { path, stored: true, result });
        }
        let result = self.run(shard, progress);
        if stopped() {
            let why = "the shard was broken off";
            return Err(StudyError::Shards(why.to_owned()));
        }
        Ok(StoredShard { path: result.write(folder)?, stored: false, result })
    }
}

/// The format's name in a file.
const FORMAT: &str = "hertzchain sweep shard 1";

/// How names of shards begin and end.
const PREFIX: &str = "sweep-";
const ENDING: &str = ".h5";

#[derive(Serialize, Deserialize)]
struct Header {
    format: String,
    run: String,
    shard: usize,
    of: usize,
    shots: usize,
    title: String,
    dimensionless: bool,
    accuracy: f64,
    about: String,
    error_control: String,
    failed: Vec<Failed>,
    odd: Option<WarningSummary>,
    /// A hash of all the rest, numbers included.
    content: String,
}

impl Header {
    fn of(part: &BatchResult) -> Self {
        Self {
            format: FORMAT.to_owned(),
            run: part.batch.to_string(),
            shard: part.shard.number,
            of: part.shard.of,
            shots: part.shots,
            title: part.title.clone(),
            dimensionless: part.units == Units::Dimensionless,
            accuracy: part.accuracy,
            about: part.about.clone(),
            error_control: part.error_control.clone(),
            failed: part.rows.failed.clone(),
            odd: part.rows.warnings.clone(),
            content: String::new(),
        }
    }

    fn text(&self) -> String {
        // Texts and numbers always have a form in JSON.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// A hash of all that a file contains, but for itself.
    fn content(&self, rows: &Rows) -> String {
        let mut bytes = self.text().into_bytes();
        for value in rows.columns.iter().flatten() {
            bytes.extend(value.to_bits().to_le_bytes());
        }
        Fingerprint::of_bytes(&bytes).to_string()
    }

    fn result(mut self, table: ColumnFile) -> Result<BatchResult, &'static str> {
        if self.format != FORMAT {
            return Err("it is of another format");
        }
        let batch = Fingerprint::from_hex(&self.run).ok_or("its run has no fingerprint")?;
        let shard = Shard::new(self.shard, self.of).map_err(|_| "there is no such shard")?;
        let mut rows =
            Rows { failed: self.failed.clone(), warnings: self.odd.clone(), ..Rows::default() };
        for (name, values) in table.columns {
            if let Some(at) = COLUMNS.iter().position(|column| *column == name) {
                rows.columns[at] = values;
            }
        }
        let count = shard.places(self.shots).count();
        if rows.columns.iter().any(|column| column.len() != count) {
            return Err("it has not as many shots as it should");
        }
        let written = std::mem::take(&mut self.content);
        if self.content(&rows) != written {
            return Err("its numbers are not those that were written");
        }
        Ok(BatchResult {
            batch,
            shard,
            shots: self.shots,
            title: self.title,
            units: match self.dimensionless {
                true => Units::Dimensionless,
                false => Units::Si,
            },
            accuracy: self.accuracy,
            about: self.about,
            error_control: self.error_control,
            rows,
        })
    }
}

/// The shards of a batch by their numbers from 1, each with its file.
type Found = BTreeMap<usize, (PathBuf, BatchResult)>;

impl BatchResult {
    /// Writes a shard into a folder, under its name: whole or not at all. Its bytes
    /// follow from the result alone.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, StudyError> {
        let path = folder.join(format!("{}{ENDING}", self.name()));
        let mut header = Header::of(self);
        header.content = header.content(&self.rows);
        let columns = COLUMNS.iter().zip(&self.rows.columns);
        let table = ColumnFile {
            about: header.text(),
            columns: columns.map(|(name, values)| ((*name).to_owned(), values.clone())).collect(),
        };
        let unwritable =
            |error: hertzchain_measure::MeasureError| StudyError::Unwritable(error.to_string());
        table.write(&path).map_err(unwritable)?;
        Ok(path)
    }

    /// Reads a shard and checks that it is whole.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        let read = || {
            let table = ColumnFile::read(path, &COLUMNS).map_err(|error| error.to_string())?;
            let header = serde_json::from_str::<Header>(&table.about);
            let header = header.map_err(|error| format!("its header is not ours ({error})"))?;
            header.result(table).map_err(str::to_owned)
        };
        read().map_err(|why| {
            StudyError::Shards(format!(
                "{} is no whole shard of a sweep: {why}; remove it and run its shard again",
                path.display()
            ))
        })
    }

    /// Gathers all shards of the one batch in these folders: the result of a
    /// batch that was never cut. Where one is named, shards of others are passed over.
    ///
    /// Where the batch was cut in several ways, one whole set of shards is enough.
    ///
    /// # Errors
    /// Missing shards; shards of several batches; two that should be the same and are not;
    /// no shards at all.
    pub fn gather(folders: &[&Path], only: Option<Fingerprint>) -> Result<Self, StudyError> {
        let mut damaged = Vec::new();
        let mut cuts: BTreeMap<(Fingerprint, usize), Found> = BTreeMap::new();
        for path in files(folders)? {
            let part = match Self::read(&path) {
                Ok(part) => part,
                Err(error) => {
                    damaged.push(error.to_string());
                    continue;
                }
            };
            if only.is_some_and(|only| only != part.batch) {
                continue;
            }
            let found = cuts.entry((part.batch, part.shard.of)).or_default();
            let number = part.shard.number;
            match found.get(&number) {
                Some((other, same)) if !same.equals(&part) => {
                    return Err(StudyError::Shards(format!(
                        "{} and {} are the same shard with other numbers: one of them is damaged, or was made \
                         on a machine whose mathematical library differs; remove one and run its shard again",
                        other.display(),
                        path.display()
                    )));
                }
                _ => found.insert(number, (path, part)),
            };
        }
        one_batch(&cuts)?;
        let fewest = cuts.into_iter().min_by_key(|((_, of), found)| of - found.len());
        fewest
            .ok_or_else(|| nothing(folders, &damaged))
            .and_then(|((_, of), found)| whole(of, found, &damaged))
    }

    fn equals(&self, other: &Self) -> bool {
        let bits = |part: &Self| {
            let values = part.rows.columns.iter().flatten();
            values.map(|value| value.to_bits()).collect::<Vec<u64>>()
        };
        bits(self) == bits(other)
            && self.rows.failed == other.rows.failed
            && self.error_control == other.error_control
    }
}

fn files(folders: &[&Path]) -> Result<BTreeSet<PathBuf>, StudyError> {
    let mut files = BTreeSet::new();
    for folder in folders {
        for entry in fs::read_dir(folder).map_err(|error| unusable(folder, &error))? {
            files.insert(entry.map_err(|error| unusable(folder, &error))?.path());
        }
    }
    files.retain(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(PREFIX) && name.ends_with(ENDING) && name.contains("-of-")
    });
    Ok(files)
}

fn unusable(folder: &Path, error: &io::Error) -> StudyError {
    StudyError::Shards(format!("cannot use {}: {error}", folder.display()))
}

fn nothing(folders: &[&Path], damaged: &[String]) -> StudyError {
    let names = folders.iter().map(|folder| folder.display().to_string());
    let mut names = names.collect::<Vec<_>>().join(", ");
    if !damaged.is_empty() {
        names += &format!("\n{}", damaged.join("\n"));
    }
    StudyError::Shards(format!(
        "no shards in {names}: expected files that `hertzchain sweep --shard i/n --out DIR` has written"
    ))
}

fn one_batch(cuts: &BTreeMap<(Fingerprint, usize), Found>) -> Result<(), StudyError> {
    let mut batches: BTreeMap<Fingerprint, (usize, String)> = BTreeMap::new();
    for ((batch, _), found) in cuts {
        let about = found.values().next().map(|(_, part)| part.about.clone());
        let batch = batches.entry(*batch);
        batch.or_insert((0, about.unwrap_or_default())).0 += found.len();
    }
    if batches.len() < 2 {
        return Ok(());
    }
    let line = |(batch, (files, about)): (&Fingerprint, &(usize, String))| {
        format!("  {files} files sweep-{}-…: {about}\n", batch.short())
    };
    Err(StudyError::Shards(format!(
        "shards of {} different runs do not mix:\n{}give the folders of one run, or move the others' files away",
        batches.len(),
        batches.iter().map(line).collect::<String>()
    )))
}

fn whole(of: usize, found: Found, damaged: &[String]) -> Result<BatchResult, StudyError> {
    let missing: Vec<usize> = (1..=of).filter(|number| !found.contains_key(number)).collect();
    let parts: Vec<BatchResult> = found.into_values().map(|(_, part)| part).collect();
    let about = parts.first().map(|part| part.about.clone());
    match (parts.first(), missing.first()) {
        (Some(first), None) => {
            let rows: Vec<Rows> = parts.iter().map(|part| part.rows.clone()).collect();
            Ok(BatchResult { shard: Shard::WHOLE, rows: Rows::dealt(&rows), ..first.clone() })
        }
        (_, first) => Err(StudyError::Shards(format!(
            "{} of {of} shards are missing of {}: {}; run the same command with --shard {}/{of}{}{}",
            missing.len(),
            about.unwrap_or_default(),
            ranges(&missing),
            first.unwrap_or(&1),
            match missing.len() {
                0 | 1 => String::new(),
                _ => format!(" and so on, or in a Slurm array --array={}", ranges(&missing)),
            },
            match damaged {
                [] => String::new(),
                _ => format!("\nnot counted, as they are not whole:\n  {}\n", damaged.join("\n  ")),
            }
        ))),
    }
}

fn ranges(numbers: &[usize]) -> String {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for &number in numbers {
        match runs.last_mut() {
            Some((_, last)) if *last + 1 == number => *last = number,
            _ => runs.push((number, number)),
        }
    }
    let text = |(first, last): &(usize, usize)| match first == last {
        true => first.to_string(),
        false => format!("{first}-{last}"),
    };
    runs.iter().map(text).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
#[path = "tests/shard.rs"]
mod tests;
