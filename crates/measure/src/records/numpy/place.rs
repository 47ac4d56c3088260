//! Where an array lies in a file, and its bytes from there, plain or deflated.

use flate2::read::DeflateDecoder;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom, Take};
use std::path::PathBuf;

/// An array's place.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub file: PathBuf,
    pub start: u64,
    /// Bytes in the file.
    pub size: u64,
    pub deflated: bool,
}

/// The bytes that are still to come.
pub(super) enum Bytes {
    Plain(Take<BufReader<File>>),
    Deflated(DeflateDecoder<Take<BufReader<File>>>),
}

impl Place {
    /// From the first byte on.
    pub(super) fn open(&self) -> io::Result<Bytes> {
        let mut opened = File::open(&self.file)?;
        opened.seek(SeekFrom::Start(self.start))?;
        let bytes = BufReader::with_capacity(1 << 16, opened).take(self.size);
        Ok(match self.deflated {
            true => Bytes::Deflated(DeflateDecoder::new(bytes)),
            false => Bytes::Plain(bytes),
        })
    }
}

impl Bytes {
    /// How many bytes are left in the file, of what is not deflated.
    pub(super) fn left(&self) -> Option<u64> {
        let Self::Plain(bytes) = self else {
            return None;
        };
        let inner = bytes.get_ref();
        let mut file = inner.get_ref();
        let (size, at) = (file.metadata().ok()?.len(), file.stream_position().ok()?);
        let left = size.saturating_sub(at) + inner.buffer().len() as u64;
        Some(left.min(bytes.limit()))
    }

    /// Leaves out what comes next; where it ends before, nothing comes any more.
    pub(super) fn skip(&mut self, count: u64) -> io::Result<()> {
        match self {
            Self::Plain(bytes) => {
                let count = count.min(bytes.limit());
                bytes.set_limit(bytes.limit() - count);
                let inner = bytes.get_mut();
                inner.seek_relative(i64::try_from(count).unwrap_or(i64::MAX))
            }
            Self::Deflated(bytes) => {
                io::copy(&mut bytes.by_ref().take(count), &mut io::sink()).map(|_| ())
            }
        }
    }
}

impl Read for Bytes {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Plain(bytes) => bytes.read(into),
            Self::Deflated(bytes) => bytes.read(into),
        }
    }
}
