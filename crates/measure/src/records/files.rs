//! Files of the user: written whole or not at all, and input that can be read only once.
//!
//! A file grows beside its place, under a hidden name with random letters that is created
//! exclusively, so that neither another program nor a link is ever written into. It is flushed to
//! the disk before it gets its name. What a killed program leaves is removed by the next one.

use crate::records::text::{as_text, decoded};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::{Builder, NamedTempFile, TempDir};

/// What stands between the name of the file and the random letters.
const MARK: &str = ".hertzchain-";

const ENDING: &str = ".part";

/// Random letters: 62¹² names.
const RANDOM: usize = 12;

/// Characters of a file's name that its temporary name has: systems allow 255 bytes.
const LONGEST: usize = 48;

/// Most attempts to create a file that no other program removes at once as a leftover.
const ATTEMPTS: usize = 8;

/// Variable that, if set, allows writers that lock nothing.
const LOCKING: &str = "HDF5_USE_FILE_LOCKING";

const MOST_TEXT: u64 = 1 << 24;

const MOST_PIPED: u64 = 1 << 30;

const STDIN: &str = "-";

/// Writes one file: whole, or not at all.
///
/// # Errors
/// What the system reports; nothing half-written stays.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    persist(written(path, write)?, path)
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
    /// Makes the folder if need be, removes what killed programs have left in it, and checks that
    /// it can be written to.
    ///
    /// # Errors
    /// What the system reports.
    pub fn within(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        remove_left_behind(folder, |_| true);
        locked(&folder.join("probe"))?.close()?;
        Ok(Self { folder: folder.to_owned(), parts: Vec::new() })
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Writes a file that has no name yet; the last one of a name counts.
    ///
    /// # Errors
    /// What the system reports.
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

    /// Gives all files their names, and returns their paths.
    ///
    /// # Errors
    /// The first file that cannot be renamed.
    pub fn finish(self) -> io::Result<Vec<PathBuf>> {
        let name = |(part, path): (NamedTempFile, PathBuf)| persist(part, &path).map(|()| path);
        self.parts.into_iter().map(name).collect()
    }
}

/// A file with all its content, on the disk, that still has its temporary name.
fn written(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<NamedTempFile> {
    let part = locked(path)?;
    let mut buffer = BufWriter::new(part.as_file());
    write(&mut buffer)?;
    buffer.flush()?;
    drop(buffer);
    part.as_file().sync_all()?;
    Ok(part)
}

/// An empty file beside a path, locked as long as it is open.
fn locked(path: &Path) -> io::Result<NamedTempFile> {
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

/// An empty file beside a path, of a new name. It is not locked: a library that opens it by its
/// name locks it.
pub(crate) fn exclusive(path: &Path) -> io::Result<NamedTempFile> {
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let prefix: String = file.chars().take(LONGEST).collect();
    let prefix = format!(".{prefix}{MARK}");
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
pub(crate) fn persist(part: NamedTempFile, path: &Path) -> io::Result<()> {
    part.persist(path).map_err(|error| error.error)?;
    // The name is on the disk once its folder is; where folders cannot be flushed, when the
    // system likes.
    #[cfg(unix)]
    let _ = File::open(folder_of(path)).and_then(|folder| folder.sync_all());
    Ok(())
}

/// Removes the files that killed programs left unfinished in a folder, of those names that are
/// ours, and returns how many. A writer locks what it writes while it lives, whatever the machine:
/// what is locked, or cannot be, stays.
pub fn remove_left_behind(folder: &Path, is_ours: impl Fn(&str) -> bool) -> usize {
    if std::env::var_os(LOCKING).is_some() {
        return 0;
    }
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let is_part = |path: &PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str());
        name.and_then(final_name).is_some_and(&is_ours)
    };
    let parts = entries.map(|entry| entry.path()).filter(is_part);
    parts.filter(|path| removed(path)).count()
}

/// The name that a part will have, as far as its temporary name has it.
fn final_name(name: &str) -> Option<&str> {
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

struct Copies {
    /// Those that were peeked at and not read yet, by the path of their source.
    unread: BTreeMap<PathBuf, PathBuf>,
    folders: Vec<TempDir>,
}

static COPIES: Mutex<Copies> = Mutex::new(Copies { unread: BTreeMap::new(), folders: Vec::new() });

fn copies() -> MutexGuard<'static, Copies> {
    COPIES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The text of a table, of at most 16 MiB, in UTF-8, UTF-16 or Latin-1.
///
/// # Errors
/// What the system reports; a longer text.
pub fn text(path: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    let opened = opened(&peeked(path))?;
    opened.take(MOST_TEXT + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > MOST_TEXT {
        true => Err(too_long("a table", MOST_TEXT)),
        false => Ok(as_text(&decoded(&bytes))),
    }
}

/// A file that can be read more than once: the path itself, or of a pipe, a device or standard
/// input (`-`) a copy. It is made anew at every call, but for what [`peek`] has copied.
///
/// # Errors
/// What the system reports; more than 1 GiB.
pub fn seekable(path: &Path) -> io::Result<PathBuf> {
    let peeked = peeked(path);
    match peeked == path && is_stream(path)? {
        true => copied(path),
        false => Ok(peeked),
    }
}

/// A file that can be read more than once, of what [`seekable`] or [`text`] will read afterwards.
///
/// # Errors
/// As [`seekable`].
pub fn peek(path: &Path) -> io::Result<PathBuf> {
    let file = seekable(path)?;
    if file != path {
        copies().unread.insert(path.to_owned(), file.clone());
    }
    Ok(file)
}

/// Removes all copies, at the end of a program.
pub fn remove_copies() {
    copies().unread.clear();
    copies().folders.clear();
}

/// A copy that [`peek`] has made, or the path itself.
fn peeked(path: &Path) -> PathBuf {
    let copy = copies().unread.remove(path);
    copy.unwrap_or_else(|| path.to_owned())
}

fn opened(path: &Path) -> io::Result<Box<dyn Read>> {
    Ok(match path == Path::new(STDIN) {
        true => Box::new(io::stdin()),
        false => Box::new(File::open(path)?),
    })
}

fn is_stream(path: &Path) -> io::Result<bool> {
    if path == Path::new(STDIN) {
        return Ok(true);
    }
    let about = fs::metadata(path)?;
    Ok(!about.is_file() && !about.is_dir())
}

/// A copy, in a folder of its own, under the same name.
fn copied(path: &Path) -> io::Result<PathBuf> {
    let source = opened(path)?;
    let folder = Builder::new().prefix("hertzchain-").tempdir()?;
    let name = match path == Path::new(STDIN) {
        true => OsStr::new("stdin"),
        false => path.file_name().unwrap_or(OsStr::new("pipe")),
    };
    let copy = folder.path().join(name);
    let mut file = File::create_new(&copy)?;
    if io::copy(&mut source.take(MOST_PIPED + 1), &mut file)? > MOST_PIPED {
        return Err(too_long("what comes from a pipe or device", MOST_PIPED));
    }
    file.flush()?;
    copies().folders.push(folder);
    Ok(copy)
}

fn too_long(what: &str, most: u64) -> io::Error {
    let detail = format!("it is longer than {} MiB, the most of {what}", most >> 20);
    io::Error::new(io::ErrorKind::FileTooLarge, detail)
}

/// A text in which control characters but line ends and tabs are written as `\u001b`: those of a
/// file's name or a title could steer a terminal.
pub fn without_controls(text: &str) -> Cow<'_, str> {
    // Control characters beyond ASCII begin with the byte c2.
    let plain = |byte: &u8| matches!(byte, b' '..=b'~' | b'\n' | b'\t' | 0x80..=0xc1 | 0xc3..);
    // Without a way out in the middle of a part, vector instructions look at it.
    let all_plain = |part: &[u8]| part.iter().fold(true, |all, byte| all & plain(byte));
    if text.as_bytes().chunks(64).all(all_plain) {
        return Cow::Borrowed(text);
    }
    let steers = |letter: char| letter.is_control() && !matches!(letter, '\n' | '\t');
    if !text.contains(steers) {
        return Cow::Borrowed(text);
    }
    let mut plain = String::with_capacity(text.len() + 16);
    for letter in text.chars() {
        match steers(letter) {
            // Writing to a text cannot fail.
            true => drop(write!(plain, "\\u{:04x}", u32::from(letter))),
            false => plain.push(letter),
        }
    }
    Cow::Owned(plain)
}

/// The words of a table's cell, without control characters, that no spreadsheet takes for a formula:
/// those that begin as one, and are no number, stand after an apostrophe.
pub fn no_formula(words: &str) -> Cow<'_, str> {
    let words = without_controls(words);
    let formula = words.starts_with(['=', '+', '-', '@', '\t', '\r']);
    match formula && words.parse::<f64>().is_err() {
        true => Cow::Owned(format!("'{words}")),
        false => words,
    }
}

#[cfg(test)]
#[path = "tests/plain.rs"]
mod tests;
