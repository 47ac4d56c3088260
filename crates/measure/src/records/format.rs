//! Which format a file is: by content, held against its name.

use crate::records::encoding::Encoding;
use crate::records::error::{RecordError, name};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Formats of recordings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// HDF5: series of a virtual campaign, and datasets of anybody.
    Hdf5,
    /// Columns of numbers as text.
    Text,
    /// One NumPy array.
    Npy,
    /// A ZIP of NumPy arrays.
    Npz,
    /// RIFF WAVE.
    Wav,
    /// LabVIEW's binary.
    Tdms,
}

/// How each binary format begins, and what such files are called.
const FORMATS: &[(Format, &[u8], &[&str], &str)] = &[
    (
        Format::Hdf5,
        b"\x89HDF\r\n\x1a\n",
        &["h5", "hdf5", "hdf"],
        "HDF5",
    ),
    (Format::Npy, b"\x93NUMPY", &["npy"], "a NumPy array"),
    (
        Format::Npz,
        b"PK\x03\x04",
        &["npz"],
        "a ZIP archive, as NPZ files are",
    ),
    (Format::Wav, b"RIFF", &["wav", "wave"], "RIFF WAVE"),
    (Format::Tdms, b"TDSm", &["tdms"], "TDMS"),
    (
        Format::Text,
        b"",
        &["csv", "tsv", "txt", "asc", "prn"],
        "text",
    ),
];

/// Bytes that tell text from other things.
const PROBE: usize = 4096;

impl Format {
    /// The format of a file: what its content is, unless its name promises
    /// another of these formats.
    ///
    /// # Errors
    /// Files that cannot be read, are empty, are none of the formats or are not
    /// what their extension says.
    pub fn of(file: &Path) -> Result<Self, RecordError> {
        let bytes = beginning(file).map_err(|cause| RecordError::reading(file, cause))?;
        if bytes.is_empty() {
            return Err(RecordError::Empty {
                source_name: name(file),
            });
        }
        let found = by_content(&bytes).ok_or_else(|| unknown(file))?;
        match promised(file) {
            Some((promised, extension)) if promised != found => Err(RecordError::NotWhatItSays {
                file: name(file),
                extension,
                found: found.text(),
            }),
            _ => Ok(found),
        }
    }

    /// What content of this format is called.
    #[must_use]
    pub fn text(self) -> &'static str {
        let row = FORMATS.iter().find(|row| row.0 == self);
        row.map_or("", |row| row.3)
    }
}

fn beginning(file: &Path) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(file)?
        .take(PROBE as u64)
        .read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn by_content(bytes: &[u8]) -> Option<Format> {
    let magic = FORMATS
        .iter()
        .find(|row| !row.1.is_empty() && bytes.starts_with(row.1));
    match magic {
        Some(row) => Some(row.0),
        None => is_text(bytes).then_some(Format::Text),
    }
}

/// Text has no control characters but spaces.
fn is_text(bytes: &[u8]) -> bool {
    let (text, _) = Encoding::of(bytes).decoded(bytes);
    !text
        .iter()
        .any(|byte| byte.is_ascii_control() && !byte.is_ascii_whitespace())
}

fn promised(file: &Path) -> Option<(Format, String)> {
    let extension = file.extension()?.to_str()?.to_ascii_lowercase();
    let row = FORMATS
        .iter()
        .find(|row| row.2.contains(&extension.as_str()))?;
    Some((row.0, extension))
}

/// No format at all: against its name, if that promises one.
fn unknown(file: &Path) -> RecordError {
    match promised(file) {
        Some((_, extension)) => RecordError::NotWhatItSays {
            file: name(file),
            extension,
            found: "something else",
        },
        None => RecordError::UnknownFormat { file: name(file) },
    }
}
