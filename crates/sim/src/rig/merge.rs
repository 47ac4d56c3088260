//! Parts of a campaign, from several folders, put together in one.

use crate::rig::error::RigError;
use crate::rig::keep::{Folder, fingerprint};
use crate::rig::plan::{Plan, Series};
use crate::rig::recording;
use hertzchain_measure::records::write_whole;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// What a merged campaign is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Merged {
    /// Its series.
    pub series: usize,
    /// Files copied now; the others were there.
    pub copied: usize,
    /// Bytes of all recordings.
    pub bytes: u64,
}

/// Copies the series of a campaign from folders into one, which then has the
/// files of a campaign that was never cut. Nothing is copied before all series are
/// found, opened and compared with what the campaign would write.
///
/// # Errors
/// [`RigError::Missing`] with the series that no folder has; a folder of another
/// campaign; recordings that are damaged or another's; what the system refuses.
pub fn merge(plan: &Plan, folders: &[&Path], out: &Path) -> Result<Merged, RigError> {
    let folders: Vec<Folder> = folders
        .iter()
        .map(|path| Folder::of(path, plan))
        .collect::<Result<_, _>>()?;
    let inputs = fingerprint(plan).short();
    let (mut found, mut missing) = (Vec::new(), Vec::new());
    for series in &plan.series {
        match only(&folders, series)? {
            Some(file) => {
                recording::verify(plan, series, &file, &inputs)?;
                found.push((series, file));
            }
            None => missing.push(series.name.clone()),
        }
    }
    if !missing.is_empty() {
        let of = plan.series.len();
        return Err(RigError::Missing { of, missing });
    }
    let whole = Folder::open(out, plan)?;
    let (mut copied, mut bytes) = (0, 0);
    for (series, file) in &found {
        let place = whole.file(series);
        match only(std::slice::from_ref(&whole), series)? {
            Some(there) => same(&there, file)?,
            None => {
                copy(file, &place).map_err(|error| RigError::folder(&place, error))?;
                copied += 1;
            }
        }
        bytes += place.metadata().map_or(0, |data| data.len());
    }
    Ok(Merged {
        series: found.len(),
        copied,
        bytes,
    })
}

/// The one recording of a series: where several folders have it, it is the same.
fn only(folders: &[Folder], series: &Series) -> Result<Option<PathBuf>, RigError> {
    let mut files = folders.iter().filter(|folder| folder.has(series));
    let Some(first) = files.next().map(|folder| folder.file(series)) else {
        return Ok(None);
    };
    for other in files {
        same(&first, &other.file(series))?;
    }
    Ok(Some(first))
}

fn same(one: &Path, other: &Path) -> Result<(), RigError> {
    let read = |path: &Path| fs::read(path).map_err(|error| RigError::folder(path, error));
    match read(one)? == read(other)? {
        true => Ok(()),
        false => Err(RigError::Differ {
            one: one.display().to_string(),
            other: other.display().to_string(),
        }),
    }
}

fn copy(from: &Path, to: &Path) -> io::Result<()> {
    let mut bytes = File::open(from)?;
    write_whole(to, |file| io::copy(&mut bytes, file).map(|_| ()))
}
