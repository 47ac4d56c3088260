//! Where a file grows until it is whole.

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
        ".{file}.{}-{nanoseconds:x}-{given}.part",
        std::process::id()
    ))
}
