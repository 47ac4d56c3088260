//! The text of a file, whatever the file turns out to be.

use std::io::{Error, Read};
use std::path::Path;

/// Larger files are a mistake.
const MOST_BYTES: u64 = 16 << 20;

/// Reads a text; what is none is an error that says what it is instead.
pub(crate) fn read(path: &Path) -> Result<String, Error> {
    if path.is_dir() {
        return Err(Error::other("it is a folder; expected an experiment file"));
    }
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path)?;
    // One byte more shows a file that is too large; an endless one ends.
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(Error::other("an experiment file has at most 16 MiB"));
    }
    if bytes.contains(&0) {
        return Err(Error::other(what_else(&bytes)));
    }
    String::from_utf8(bytes).map_err(|error| Error::other(what_else(error.as_bytes())))
}

/// What bytes are that are no text in UTF-8.
fn what_else(bytes: &[u8]) -> String {
    let valid = std::str::from_utf8(bytes).map_or_else(|error| error.valid_up_to(), str::len);
    let before = bytes.iter().take(valid);
    let line = 1 + before.filter(|byte| **byte == b'\n').count();
    match bytes {
        [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..] => {
            "it is written in UTF-16; save it as UTF-8".to_owned()
        }
        _ if bytes.contains(&0) => {
            "it is no text in UTF-8: it holds zero bytes; expected an experiment file".to_owned()
        }
        _ => format!("line {line} is not written in UTF-8; save the file as UTF-8"),
    }
}
