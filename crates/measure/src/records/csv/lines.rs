//! Lines of a text, whatever they end with.

use crate::records::encoding::Decoded;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

/// Lines that end with LF, CR LF or CR alone; as many CR as there are before one LF are one end.
pub(super) struct Lines {
    reader: BufReader<Decoded>,
    /// Empty lines that were read and not given yet.
    blank: usize,
}

/// Most bytes of a line: 16 MiB, a row of a million samples of sixteen letters.
const MOST: usize = 1 << 24;

/// What was read of a line.
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
    /// # Errors
    /// A file that cannot be read.
    pub(super) fn open(file: &Path) -> io::Result<Self> {
        Ok(Self {
            reader: BufReader::with_capacity(1 << 16, Decoded::open(file)?),
            blank: 0,
        })
    }

    /// The next line without its end.
    ///
    /// # Errors
    /// A file that cannot be read on.
    pub(super) fn next(&mut self, line: &mut Vec<u8>) -> io::Result<Read> {
        line.clear();
        if self.blank > 0 {
            self.blank -= 1;
            return Ok(Read::Whole);
        }
        loop {
            let buffer = self.reader.fill_buf()?;
            if buffer.is_empty() {
                return Ok(if line.is_empty() {
                    Read::Nothing
                } else {
                    Read::Begun
                });
            }
            let end = buffer.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            let Some(end) = end else {
                let count = buffer.len();
                line.extend_from_slice(buffer);
                self.reader.consume(count);
                if line.len() > MOST {
                    return Err(too_long());
                }
                continue;
            };
            line.extend_from_slice(buffer.get(..end).unwrap_or_default());
            let returns = buffer.get(end) == Some(&b'\r');
            self.reader.consume(end + 1);
            if returns {
                self.blank = self.returns()?;
            }
            return Ok(Read::Whole);
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

fn too_long() -> io::Error {
    let detail = format!("a line of it is longer than {} MiB", MOST >> 20);
    io::Error::new(io::ErrorKind::InvalidData, detail)
}
