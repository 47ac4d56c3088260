//! Errors of reading, writing and measuring records.

use std::io;
use std::path::Path;

/// Why a file, a record or a list of shots cannot be used: what, where and the remedy.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeasureError {
    /// The operating system cannot read the file.
    #[error("{0}: cannot be read: {1}")]
    Unreadable(String, String),
    /// The operating system cannot write the file.
    #[error("{0}: cannot be written: {1}; files finished before are intact")]
    Unwritable(String, String),
    /// The file or record is shorter than it states.
    #[error("{0}: ends too early: {1}; copy or export it again")]
    Truncated(String, String),
    /// The file has no known format, or breaks the rules of its format.
    #[error("{0}: {1}")]
    Format(String, String),
    /// The sampling rate is missing, contradictory, impossible or not constant.
    #[error("{0}: {1}")]
    Rate(String, String),
    /// The channels cannot be chosen.
    #[error("{0}: {1}")]
    Channels(String, String),
    /// There are no samples, or samples of no use.
    #[error("{0}: {1}")]
    Samples(String, String),
    /// A recording cannot be cut into shots, or these do not match its speeds.
    #[error("{0}: {1}")]
    Shots(String, String),
    /// A list of shots is malformed.
    #[error("{0}")]
    List(String),
}

impl MeasureError {
    /// What the system reports while a file is read.
    pub(crate) fn reading(file: &Path, cause: io::Error) -> Self {
        match cause.kind() {
            io::ErrorKind::UnexpectedEof => {
                Self::truncated(file_name(file), "fewer bytes than its header promises")
            }
            _ => Self::Unreadable(file_name(file), cause.to_string()),
        }
    }

    pub(crate) fn truncated(source: String, detail: impl Into<String>) -> Self {
        Self::Truncated(source, detail.into())
    }

    pub(crate) fn malformed(file: &Path, format: &str, detail: impl std::fmt::Display) -> Self {
        Self::Format(
            file_name(file),
            format!("not readable as {format}: {detail}"),
        )
    }

    pub(crate) fn empty(source: String) -> Self {
        Self::Samples(source, "holds no samples".to_owned())
    }

    pub(crate) fn lengths(source: String, found: usize, expected: usize, why: &str) -> Self {
        let detail = format!("has {found} samples where {expected} were expected ({why})");
        Self::Samples(source, detail)
    }

    pub(crate) fn too_long(source: String, most: usize) -> Self {
        let detail = format!(
            "more than {most} samples in one record; cut it into shots with --level, a single \
             recording also with --shot-samples"
        );
        Self::Samples(source, detail)
    }
}

/// A path in messages.
pub(crate) fn file_name(file: &Path) -> String {
    file.display().to_string()
}
