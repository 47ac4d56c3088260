//! What can be wrong with recordings, told to people.

use std::io;
use std::path::Path;

/// Why a recording, or one record in it, cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The operating system refuses to read.
    #[error("{file}: cannot be read: {cause}")]
    Unreadable {
        /// Which file.
        file: String,
        /// What the system says.
        cause: io::Error,
    },
    /// The operating system refuses to write.
    #[error("{file}: cannot be written: {detail}; files finished before are intact")]
    Unwritable {
        /// Which file.
        file: String,
        /// What the system says, and what to do.
        detail: String,
    },
    /// Nothing in it.
    #[error("{source_name}: holds no samples")]
    Empty {
        /// Which file or record.
        source_name: String,
    },
    /// Shorter than it says itself.
    #[error("{source_name}: ends too early: {detail}; copy or export it again")]
    Truncated {
        /// Which file or record.
        source_name: String,
        /// What is missing.
        detail: String,
    },
    /// A name that promises another format than the content's.
    #[error("{file}: is called .{extension} but holds {found}; give it its right ending")]
    NotWhatItSays {
        /// Which file.
        file: String,
        /// The name's ending.
        extension: String,
        /// What the content is.
        found: &'static str,
    },
    /// None of the formats.
    #[error("{file}: is none of HDF5, CSV or other text, NPY, NPZ, WAV and TDMS")]
    UnknownFormat {
        /// Which file.
        file: String,
    },
    /// Breaks the rules of its format, or uses a part of it that is not read.
    #[error("{file}: not readable as {format}: {detail}")]
    Malformed {
        /// Which file.
        file: String,
        /// Which format.
        format: &'static str,
        /// What and where.
        detail: String,
    },
    /// Nothing says how fast was sampled.
    #[error("{file}: does not say how fast it was sampled; give the rate, such as --rate 1MHz")]
    NoRate {
        /// Which file.
        file: String,
    },
    /// File and option disagree.
    #[error(
        "{file}: was sampled at {stated_hz} Hz by its own account, not at {given_hz} Hz; leave \
         the rate out, or insist on yours with --trust-rate"
    )]
    WrongRate {
        /// Which file.
        file: String,
        /// The file's rate in Hz.
        stated_hz: f64,
        /// The option's rate in Hz.
        given_hz: f64,
    },
    /// A rate that no sampling has.
    #[error(
        "{file}: a sampling interval of {interval_s:e} s is impossible: recorders have 1 ps to 1000 s"
    )]
    ImpossibleRate {
        /// Which file.
        file: String,
        /// What was found, in s.
        interval_s: f64,
    },
    /// Times that do not go in equal steps.
    #[error(
        "{source_name}: its times are not evenly spaced: from sample {sample}, at {time_s} s, to \
         the next they go on by {:.4} µs where steps of {:.4} µs are usual; were samples lost? If \
         not, --rate with --trust-rate leaves times aside",
        .step_s * 1e6, .usual_s * 1e6
    )]
    UnevenTimes {
        /// Which file or record.
        source_name: String,
        /// Which sample, from 1.
        sample: usize,
        /// Its time in s.
        time_s: f64,
        /// From there to the next in s.
        step_s: f64,
        /// The usual step in s.
        usual_s: f64,
    },
    /// Times of too few digits.
    #[error(
        "{file}: its times go by steps of {:.3} µs, too coarse to tell how fast it was sampled; give the \
         rate, such as --rate 1MHz", .even_to_s * 1e6
    )]
    CoarseTimes {
        /// Which file.
        file: String,
        /// What one of their last digit is in s.
        even_to_s: f64,
    },
    /// No channel of that name.
    #[error("{file}: has no channel {wanted:?}; it has {there}")]
    NoChannel {
        /// Which file.
        file: String,
        /// What was asked for.
        wanted: String,
        /// What there is.
        there: String,
    },
    /// More channels than anybody can tell apart without being told.
    #[error(
        "{file}: has {count} channels ({there}); say which with --channel: one that sums both \
         sensors, or two, the sensor bead's first; of an array of which each column is a shot, \
         --rows moments"
    )]
    WhichChannel {
        /// Which file.
        file: String,
        /// How many.
        count: usize,
        /// Their names.
        there: String,
    },
    /// Samples that are no numbers.
    #[error(
        "{source_name}: {count} of {of} samples in {channel:?} are not finite numbers, the first \
         is sample {first}"
    )]
    NotFinite {
        /// Which record.
        source_name: String,
        /// Which channel.
        channel: String,
        /// How many samples.
        count: usize,
        /// Of how many.
        of: usize,
        /// Which is the first, from 1.
        first: usize,
    },
    /// No signal at all.
    #[error(
        "{source_name}: all {of} samples in {channel:?} are {value}; was the sensor connected?"
    )]
    Constant {
        /// Which record.
        source_name: String,
        /// Which channel.
        channel: String,
        /// How many samples.
        of: usize,
        /// Their value.
        value: f64,
    },
    /// Records or channels of one file that do not match.
    #[error("{source_name}: has {found} samples where {expected} were expected ({why})")]
    MixedLengths {
        /// Which record.
        source_name: String,
        /// How many it has.
        found: usize,
        /// How many it should have.
        expected: usize,
        /// What it was compared with.
        why: &'static str,
    },
    /// More samples in one piece than a shot can have.
    #[error(
        "{source_name}: more than {most} samples in one record; cut it into shots with --level, a \
         single recording also with --shot-samples"
    )]
    TooLong {
        /// Which record.
        source_name: String,
        /// The limit.
        most: usize,
    },
    /// Input of the writer that does not fit together.
    #[error("{file}: shot {shot} does not fit the series: {detail}")]
    Misfit {
        /// Which file.
        file: String,
        /// Which shot.
        shot: u64,
        /// What is wrong.
        detail: String,
    },
}

impl RecordError {
    /// What the system said while a file was read; its end before its time is
    /// told as such.
    pub(crate) fn reading(file: &Path, cause: io::Error) -> Self {
        match cause.kind() {
            io::ErrorKind::UnexpectedEof => {
                Self::truncated(name(file), "fewer bytes than its header promises")
            }
            _ => Self::Unreadable {
                file: name(file),
                cause,
            },
        }
    }

    pub(crate) fn truncated(source_name: String, detail: impl Into<String>) -> Self {
        Self::Truncated {
            source_name,
            detail: detail.into(),
        }
    }

    pub(crate) fn malformed(file: &Path, format: &'static str, detail: impl ToString) -> Self {
        Self::Malformed {
            file: name(file),
            format,
            detail: detail.to_string(),
        }
    }
}

/// A path as it is told.
pub(crate) fn name(file: &Path) -> String {
    file.display().to_string()
}
