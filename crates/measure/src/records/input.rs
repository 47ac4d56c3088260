//! What the user names as input: files, and pipes and devices, which are copied to files first.

use std::collections::HashMap;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::TempDir;

/// Most bytes of a table as text: 16 MiB.
const MOST_TEXT: u64 = 1 << 24;

/// Most bytes that are read from a pipe or device: 1 GiB.
const MOST_PIPED: u64 = 1 << 30;

/// Standard input.
const STDIN: &str = "-";

/// Copies that this program has made.
#[derive(Default)]
struct Copies {
    /// Those that were looked into and not read yet, by what they are copies of.
    unread: HashMap<PathBuf, PathBuf>,
    folders: Vec<TempDir>,
}

static COPIES: Mutex<Option<Copies>> = Mutex::new(None);

fn copies() -> MutexGuard<'static, Option<Copies>> {
    COPIES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The text of a table, of at most 16 MiB.
///
/// # Errors
/// What the system says; a longer text, or one that is not UTF-8.
pub fn text(path: &Path) -> io::Result<String> {
    let mut text = String::new();
    let file = peeked(path)?;
    let mut opened: Box<dyn Read> = match file == Path::new(STDIN) {
        true => Box::new(io::stdin()),
        false => Box::new(File::open(file)?),
    };
    opened
        .by_ref()
        .take(MOST_TEXT + 1)
        .read_to_string(&mut text)?;
    match text.len() as u64 > MOST_TEXT {
        true => Err(too_long("a table", MOST_TEXT)),
        false => Ok(text),
    }
}

/// A file that can be read more than once: the path itself, or of a pipe, a device or standard
/// input (`-`) a copy. It is made anew at every call, but for what [`peek`] has copied.
///
/// # Errors
/// What the system says; more than 1 GiB.
pub fn seekable(path: &Path) -> io::Result<PathBuf> {
    let peeked = peeked(path)?;
    match peeked == path && is_stream(path)? {
        true => copied(path),
        false => Ok(peeked),
    }
}

/// The same for what will be read by [`seekable`] or [`text`] afterwards.
///
/// # Errors
/// As [`seekable`].
pub fn peek(path: &Path) -> io::Result<PathBuf> {
    let file = seekable(path)?;
    if file != path {
        let unread = &mut copies();
        let unread = &mut unread.get_or_insert_default().unread;
        unread.insert(path.to_owned(), file.clone());
    }
    Ok(file)
}

/// Removes all copies, at the end of a program.
pub fn remove_copies() {
    copies().take();
}

/// A copy that [`peek`] has made, or the path itself.
fn peeked(path: &Path) -> io::Result<PathBuf> {
    let copy = copies().as_mut().and_then(|all| all.unread.remove(path));
    Ok(copy.unwrap_or_else(|| path.to_owned()))
}

/// Whether a path can be read only once.
fn is_stream(path: &Path) -> io::Result<bool> {
    if path == Path::new(STDIN) {
        return Ok(true);
    }
    let about = fs::metadata(path)?;
    Ok(!about.is_file() && !about.is_dir())
}

/// A copy, in a folder of its own, under the same name.
fn copied(path: &Path) -> io::Result<PathBuf> {
    let mut opened: Box<dyn Read> = match path == Path::new(STDIN) {
        true => Box::new(io::stdin()),
        false => Box::new(File::open(path)?),
    };
    let folder = tempfile::Builder::new().prefix("hertzchain-").tempdir()?;
    let name = match path == Path::new(STDIN) {
        true => OsStr::new("stdin"),
        false => path.file_name().unwrap_or(OsStr::new("pipe")),
    };
    let copy = folder.path().join(name);
    let mut file = File::create_new(&copy)?;
    let length = io::copy(&mut opened.by_ref().take(MOST_PIPED + 1), &mut file)?;
    if length > MOST_PIPED {
        return Err(too_long("what comes from a pipe or device", MOST_PIPED));
    }
    file.flush()?;
    copies().get_or_insert_default().folders.push(folder);
    Ok(copy)
}

fn too_long(what: &str, most: u64) -> io::Error {
    let detail = format!("it is longer than {} MiB, the most of {what}", most >> 20);
    io::Error::new(io::ErrorKind::FileTooLarge, detail)
}
