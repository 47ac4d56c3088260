//! What the targets share: input as a file, since readers take files.

use std::fs;
use std::path::Path;

/// Calls a reader with a file of this ending that holds these bytes.
pub fn with_file(ending: &str, bytes: &[u8], read: impl FnOnce(&Path)) {
    let file = tempfile::Builder::new().suffix(ending).tempfile().expect("a temporary file");
    fs::write(file.path(), bytes).expect("a temporary file takes its bytes");
    read(file.path());
}
