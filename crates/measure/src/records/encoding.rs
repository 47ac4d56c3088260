//! How a text's letters are stored.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

/// Bytes that tell an encoding without a mark.
const PROBE: usize = 64;

/// One of the ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// UTF-8, or one of those with a byte a letter.
    Bytes,
    /// UTF-16, lower byte first.
    Utf16Little,
    /// UTF-16, upper byte first.
    Utf16Big,
}

impl Encoding {
    /// By the mark at the beginning; without one by the zeros that every other byte of Latin
    /// letters and digits is in UTF-16.
    pub(super) fn of(beginning: &[u8]) -> Self {
        let probe = beginning.get(..PROBE).unwrap_or(beginning);
        let zeros = |from: usize| {
            let mut bytes = probe.iter().skip(from).step_by(2);
            probe.len() >= 8 && bytes.all(|byte| *byte == 0)
        };
        match beginning {
            [0xff, 0xfe, ..] => Self::Utf16Little,
            [0xfe, 0xff, ..] => Self::Utf16Big,
            _ if zeros(1) => Self::Utf16Little,
            _ if zeros(0) => Self::Utf16Big,
            _ => Self::Bytes,
        }
    }

    /// UTF-8 of bytes, as far as they are whole, with how many bytes that took.
    pub(super) fn decoded(self, bytes: &[u8]) -> (Vec<u8>, usize) {
        let unit: fn([u8; 2]) -> u16 = match self {
            Self::Bytes => return (bytes.to_vec(), bytes.len()),
            Self::Utf16Little => u16::from_le_bytes,
            Self::Utf16Big => u16::from_be_bytes,
        };
        let (pairs, _) = bytes.as_chunks::<2>();
        let mut units: Vec<u16> = pairs.iter().map(|pair| unit(*pair)).collect();
        // The first half of a letter waits for its other half.
        let waits = units
            .last()
            .is_some_and(|last| (0xd800..0xdc00).contains(last));
        units.truncate(units.len() - usize::from(waits));
        let text = String::from_utf16_lossy(&units);
        let marked = text.strip_prefix('\u{feff}').unwrap_or(&text);
        (marked.as_bytes().to_vec(), 2 * units.len())
    }
}

/// A file of text as UTF-8, whatever it is stored as.
pub(crate) struct Decoded {
    file: BufReader<File>,
    encoding: Encoding,
    /// Bytes of the file that are not decoded yet.
    raw: Vec<u8>,
    /// Bytes of UTF-8 that are not handed out yet, and how many are.
    ready: (Vec<u8>, usize),
}

/// Bytes of a file that are decoded together.
const CHUNK: u64 = 1 << 16;

impl Decoded {
    /// # Errors
    /// A file that cannot be read.
    pub(super) fn open(file: &Path) -> io::Result<Self> {
        let mut file = BufReader::with_capacity(CHUNK as usize, File::open(file)?);
        let mut raw = Vec::new();
        file.by_ref().take(PROBE as u64).read_to_end(&mut raw)?;
        Ok(Self {
            file,
            encoding: Encoding::of(&raw),
            raw,
            ready: (Vec::new(), 0),
        })
    }

    /// Whether the file has more.
    fn decode(&mut self) -> io::Result<bool> {
        let read = self.file.by_ref().take(CHUNK).read_to_end(&mut self.raw)?;
        let (utf_8, taken) = self.encoding.decoded(&self.raw);
        self.raw.drain(..taken);
        self.ready = (utf_8, 0);
        // Half a letter at the end is none.
        Ok(read > 0)
    }
}

impl Read for Decoded {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        while self.ready.1 == self.ready.0.len() {
            if !self.decode()? && self.ready.0.is_empty() {
                return Ok(0);
            }
        }
        let left = self.ready.0.get(self.ready.1..).unwrap_or_default();
        let count = left.len().min(into.len());
        into[..count].copy_from_slice(&left[..count]);
        self.ready.1 += count;
        Ok(count)
    }
}

#[cfg(test)]
#[path = "tests/encoding.rs"]
mod tests;
