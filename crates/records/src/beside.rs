//! Where a file grows until it is whole.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

/// How many names this process has given.
static GIVEN: AtomicU64 = AtomicU64::new(0);

/// A hidden name beside a file that no other writer has, in this process, another,
/// or on another machine that shares the folder: whoever is killed leaves a part that
/// nobody takes for a file and nobody else writes into.
#[must_use]
pub fn beside(path: &Path) -> PathBuf {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let nanoseconds = now.map_or(0, |now| now.as_nanos());
    let given = GIVEN.fetch_add(1, Ordering::Relaxed);
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(
        ".{file}.{}-{nanoseconds:x}-{given}{ENDING}",
        std::process::id()
    ))
}

/// Ending of what grows.
const ENDING: &str = ".part";

/// Set, it may have writers that lock nothing.
const LOCKING: &str = "HDF5_USE_FILE_LOCKING";

/// Removes what killed writers have left beside those files of a folder, and tells how many. A
/// writer of HDF5 locks what it writes while it lives, whatever the machine: what is locked,
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

/// The file that a part becomes, by its name.
fn grows_to(name: &str) -> Option<&str> {
    let inner = name.strip_prefix('.')?.strip_suffix(ENDING)?;
    inner.rsplit_once('.').map(|(file, _)| file)
}

/// Nobody can lock it anew before it is gone.
fn removed(part: &Path) -> bool {
    let open = File::options().write(true).open(part);
    open.is_ok_and(|open| open.try_lock().is_ok() && fs::remove_file(part).is_ok())
}
