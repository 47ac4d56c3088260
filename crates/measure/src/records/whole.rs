//! Files that are there whole or not at all.
//!
//! A file grows beside its place, under a hidden name with random letters that is created
//! exclusively, so that neither another program nor a link is ever written into. It is flushed to
//! the disk before it gets its name. What a killed program leaves is removed by the next one.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// What stands between the name of the file and the random letters.
const MARK: &str = ".hertzchain-";

/// Ending of what grows.
const ENDING: &str = ".part";

/// Random letters: 62¹² names.
const RANDOM: usize = 12;

/// Characters of a file's name that its temporary name keeps: systems allow 255 bytes.
const KEPT: usize = 48;

/// Most attempts to create a file that no other program removes at once as a leftover.
const ATTEMPTS: usize = 8;

/// Set, it may have writers that lock nothing.
const LOCKING: &str = "HDF5_USE_FILE_LOCKING";

/// Writes one file: whole, or not at all.
///
/// # Errors
/// What the system says; nothing half-written stays.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    named(written(path, write)?, path)
}

/// Files of one folder that get their names together: none before all are written, so that a
/// full disk leaves the folder as it was.
#[derive(Debug)]
pub struct Files {
    folder: PathBuf,
    /// Open, as their locks keep other programs from removing them.
    parts: Vec<(NamedTempFile, PathBuf)>,
}

impl Files {
    /// Makes the folder if need be, removes what killed programs have left in it, and checks
    /// that it can be written to.
    ///
    /// # Errors
    /// What the system says.
    pub fn within(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        remove_left_behind(folder, |_| true);
        created(&folder.join("probe"))?.close()?;
        Ok(Self {
            folder: folder.to_owned(),
            parts: Vec::new(),
        })
    }

    /// The folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Writes a file that has no name yet; the last one of a name counts.
    ///
    /// # Errors
    /// What the system says.
    pub fn write(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let path = self.folder.join(name);
        let part = written(&path, write)?;
        self.parts.retain(|(_, other)| *other != path);
        self.parts.push((part, path));
        Ok(())
    }

    /// Names of the files.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let names = self.parts.iter();
        names.filter_map(|(_, path)| path.strip_prefix(&self.folder).ok()?.to_str())
    }

    /// Gives all files their names, and returns them.
    ///
    /// # Errors
    /// The first file that can't be renamed.
    pub fn finish(self) -> io::Result<Vec<PathBuf>> {
        let name = |(part, path): (NamedTempFile, PathBuf)| named(part, &path).map(|()| path);
        self.parts.into_iter().map(name).collect()
    }
}

/// A file with all its content, on the disk, that still has its temporary name.
fn written(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<NamedTempFile> {
    let part = created(path)?;
    let mut buffer = BufWriter::new(part.as_file());
    write(&mut buffer)?;
    buffer.flush()?;
    drop(buffer);
    part.as_file().sync_all()?;
    Ok(part)
}

/// An empty file beside a path, locked as long as it is open.
fn created(path: &Path) -> io::Result<NamedTempFile> {
    for _ in 0..ATTEMPTS {
        let part = exclusive(path)?;
        // Where the system has no locks, nothing is removed as a leftover either.
        let taken = matches!(part.as_file().try_lock(), Err(fs::TryLockError::WouldBlock));
        if !taken && part.path().exists() {
            return Ok(part);
        }
    }
    let detail = "its temporary files are removed by another program";
    Err(io::Error::other(detail))
}

/// An empty file beside a path, of a name that there was not. It is not locked: a library that
/// opens it by its name locks it.
///
/// # Errors
/// What the system says.
pub(crate) fn exclusive(path: &Path) -> io::Result<NamedTempFile> {
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let kept: String = file.chars().take(KEPT).collect();
    let prefix = format!(".{kept}{MARK}");
    let mut builder = Builder::new();
    builder.prefix(&prefix).suffix(ENDING).rand_bytes(RANDOM);
    // As other programs make files: the user's mask decides who may read them.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder_of(path))
}

fn folder_of(path: &Path) -> &Path {
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    folder.unwrap_or(Path::new("."))
}

/// Gives a file that is complete, and on the disk, its name.
pub(crate) fn named(part: NamedTempFile, path: &Path) -> io::Result<()> {
    part.persist(path).map_err(|error| error.error)?;
    // The name is on the disk once its folder is; where folders cannot be flushed, when the
    // system likes.
    #[cfg(unix)]
    let _ = File::open(folder_of(path)).and_then(|folder| folder.sync_all());
    Ok(())
}

/// Removes what killed programs have left beside those files of a folder, and returns how many.
/// A writer locks what it writes while it lives, whatever the machine: what is locked,
/// or cannot be, stays.
pub fn remove_left_behind(folder: &Path, is_ours: impl Fn(&str) -> bool) -> usize {
    let Some(entries) = fs::read_dir(folder)
        .ok()
        .filter(|_| std::env::var_os(LOCKING).is_none())
    else {
        return 0;
    };
    let part = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str());
        name.and_then(grows_to).is_some_and(&is_ours)
    };
    let paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
    paths.filter(part).filter(|path| removed(path)).count()
}

/// The file that a part becomes, by its name, as far as that is kept.
fn grows_to(name: &str) -> Option<&str> {
    let inner = name.strip_prefix('.')?.strip_suffix(ENDING)?;
    let (file, random) = inner.rsplit_once(MARK)?;
    (random.len() == RANDOM).then_some(file)
}

/// No other program can lock it anew before it is removed.
fn removed(part: &Path) -> bool {
    // A link is not of this program, and is not followed.
    let is_file = fs::symlink_metadata(part).is_ok_and(|about| about.is_file());
    let open = File::options().write(true).open(part);
    is_file && open.is_ok_and(|open| open.try_lock().is_ok() && fs::remove_file(part).is_ok())
}
