//! Errors of reading, writing and measuring records.

use crate::signal::PulseKind;
use std::io;
use std::path::Path;

/// Why a file, a record, samples, points or a list of shots cannot be used: what, where and the
/// remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
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
    /// Fewer samples, the first number, than the computation needs.
    #[error("{0} samples are too few: at least {1} are needed")]
    TooShort(usize, usize),
    /// A sample, by its number from 0, is not a number, infinite, or so large that its square
    /// overflows.
    #[error(
        "sample {0} is {1}: not a finite number of sensible size; cut the record before it, or \
         repair it"
    )]
    NotFinite(usize, f64),
    /// All samples are equal.
    #[error("all samples equal {0}: nothing was recorded; is the channel connected?")]
    Constant(f64),
    /// The largest swing over the noise is too small, both after averaging over four samples.
    #[error("no pulse: the largest swing is {0:.1} times the noise, 6 are needed")]
    NoPulse(f64),
    /// Columns or channels of different lengths.
    #[error("{0}")]
    Lengths(String),
    /// An option, by its name, with its value and what is accepted.
    #[error("{0} is {1}: expected {2}")]
    Option(&'static str, f64, &'static str),
    /// A pulse that the computation needs was not found.
    #[error("the {0} pulse was not found")]
    Missing(PulseKind),
    /// The method found no maximum, or no crossing, where the pulse is.
    #[error("the {0} pulse has no {1} where it was looked for")]
    NoPick(PulseKind, &'static str),
    /// A pulse is not after the one before it, by so many s.
    #[error(
        "the {0} pulse is {2:.3e} s before the {1} pulse, so that a time of flight is not positive: \
         are skew and filter those of the record?"
    )]
    OutOfOrder(PulseKind, PulseKind, f64),
    /// A corner in Hz below the least, the second number, of an amplifier that pulses as short as the
    /// record's pass.
    #[error(
        "corner of the amplifier's low-pass is {0} Hz: pulses as short as the record's need \
         {1:.0} Hz or more"
    )]
    LowCorner(f64, f64),
    /// Fewer than two different abscissas.
    #[error("a power law needs at least two different abscissas")]
    TooFew,
    /// A point, by its number from 0, has no logarithm.
    #[error("point {0} is not positive and finite")]
    NotPositive(usize),
}

pub(crate) type Result<T, E = MeasureError> = std::result::Result<T, E>;

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
        Self::Format(file_name(file), format!("not readable as {format}: {detail}"))
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

    pub(crate) fn require(
        accepted: bool,
        name: &'static str,
        value: f64,
        expected: &'static str,
    ) -> Result<()> {
        let error = Self::Option(name, value, expected);
        accepted.then_some(()).ok_or(error)
    }

    pub(crate) fn positive(name: &'static str, value: f64) -> Result<()> {
        let accepted = value > 0.0 && value.is_finite();
        Self::require(accepted, name, value, "a positive, finite number")
    }

    pub(crate) fn enough(found: usize, needed: usize) -> Result<()> {
        (found >= needed).then_some(()).ok_or(Self::TooShort(found, needed))
    }
}

/// Rejects samples that are not finite numbers or whose squares, summed, would overflow.
pub(crate) fn all_finite(samples: &[f64]) -> Result<()> {
    let bad = samples.iter().position(|x| x.is_nan() || x.abs() >= 1e140);
    bad.map_or(Ok(()), |index| Err(MeasureError::NotFinite(index, samples[index])))
}

pub(crate) fn file_name(file: &Path) -> String {
    file.display().to_string()
}
