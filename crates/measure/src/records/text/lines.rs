//! Lines of a text in any encoding, whatever they end with.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read as _};
use std::path::Path;

/// Bytes that show an encoding without a mark.
const PROBE: usize = 64;

/// Bytes of a file that are decoded together.
const CHUNK: u64 = 1 << 16;

/// Most bytes of a line: 16 MiB, a row of a million samples of sixteen letters.
const MOST: usize = 1 << 24;

/// How letters are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// UTF-8, or an encoding with a byte a letter.
    Bytes,
    Utf16Little,
    Utf16Big,
}

impl Encoding {
    /// By the mark at the beginning; without one by the zeros that every other byte of Latin
    /// letters and digits is in UTF-16.
    pub(crate) fn of(beginning: &[u8]) -> Self {
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

    /// UTF-8 of bytes, as far as they are whole letters, and how many bytes that took.
    pub(crate) fn decoded(self, bytes: &[u8]) -> (Vec<u8>, usize) {
        let unit: fn([u8; 2]) -> u16 = match self {
            Self::Bytes => return (bytes.to_vec(), bytes.len()),
            Self::Utf16Little => u16::from_le_bytes,
            Self::Utf16Big => u16::from_be_bytes,
        };
        let (pairs, _) = bytes.as_chunks::<2>();
        let mut units: Vec<u16> = pairs.iter().map(|pair| unit(*pair)).collect();
        // The first half of a letter waits for its other half.
        units.pop_if(|last| (0xd800..0xdc00).contains(last));
        let text = String::from_utf16_lossy(&units);
        let marked = text.strip_prefix('\u{feff}').unwrap_or(&text);
        (marked.as_bytes().to_vec(), 2 * units.len())
    }
}

/// Bytes as text without its mark; those that are not UTF-8 are Latin-1, as oscilloscopes write µ.
pub(super) fn text(bytes: &[u8]) -> String {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    }
}

/// A file of text as UTF-8.
struct Decoded {
    file: File,
    encoding: Encoding,
    /// Bytes that are not decoded yet.
    raw: Vec<u8>,
    ready: Cursor<Vec<u8>>,
}

impl io::Read for Decoded {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        loop {
            let count = self.ready.read(into)?;
            if count > 0 || into.is_empty() {
                return Ok(count);
            }
            let mut limited = io::Read::by_ref(&mut self.file).take(CHUNK);
            let read = limited.read_to_end(&mut self.raw)?;
            let (utf_8, taken) = self.encoding.decoded(&self.raw);
            self.raw.drain(..taken);
            // Half a letter at the end is none.
            if read == 0 && utf_8.is_empty() {
                return Ok(0);
            }
            self.ready = Cursor::new(utf_8);
        }
    }
}

/// Lines that end with LF, CR LF or CR alone; as many CR as there are before one LF are one end.
pub(super) struct Lines {
    reader: BufReader<Decoded>,
    /// Empty lines that were read and not returned yet.
    blank: usize,
}

/// How a line was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Read {
    /// With its end.
    Whole,
    /// The file ended first.
    Begun,
    /// Nothing is left.
    Nothing,
}

impl Lines {
    pub(super) fn open(file: &Path) -> io::Result<Self> {
        let (mut file, mut raw) = (File::open(file)?, Vec::new());
        io::Read::by_ref(&mut file)
            .take(PROBE as u64)
            .read_to_end(&mut raw)?;
        let decoded = Decoded {
            file,
            encoding: Encoding::of(&raw),
            raw,
            ready: Cursor::default(),
        };
        Ok(Self {
            reader: BufReader::with_capacity(CHUNK as usize, decoded),
            blank: 0,
        })
    }

    /// Reads the next line without its end.
    pub(super) fn next(&mut self, line: &mut Vec<u8>) -> io::Result<Read> {
        line.clear();
        if self.blank > 0 {
            self.blank -= 1;
            return Ok(Read::Whole);
        }
        loop {
            let buffer = self.reader.fill_buf()?;
            if buffer.is_empty() {
                return Ok(match line.is_empty() {
                    true => Read::Nothing,
                    false => Read::Begun,
                });
            }
            let end = buffer.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            let part = end.unwrap_or(buffer.len());
            line.extend_from_slice(&buffer[..part]);
            let returns = buffer.get(part) == Some(&b'\r');
            self.reader.consume(part + usize::from(end.is_some()));
            if line.len() > MOST {
                let detail = format!("a line of it is longer than {} MiB", MOST >> 20);
                return Err(io::Error::new(io::ErrorKind::InvalidData, detail));
            }
            if returns {
                self.blank = self.returns()?;
            }
            if end.is_some() {
                return Ok(Read::Whole);
            }
        }
    }

    /// Empty lines after a CR: none if LF ends what are only CR until there.
    fn returns(&mut self) -> io::Result<usize> {
        let mut more = 0;
        loop {
            match self.reader.fill_buf()?.first() {
                Some(b'\r') => more += 1,
                Some(b'\n') => {
                    self.reader.consume(1);
                    return Ok(0);
                }
                _ => return Ok(more),
            }
            self.reader.consume(1);
        }
    }
}

#[cfg(test)]
#[path = "../tests/encoding.rs"]
mod tests;
