//! A checksum at the end of a file, of all bytes before it.

use flate2::Crc;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};

/// What stands before the eight hexadecimal digits of a CRC-32.
const LABEL: &[u8] = b"\nhertzchain CRC-32 ";

/// Bytes of label and digits.
const LENGTH: usize = LABEL.len() + 8;

/// Bytes read at a time.
const PIECE: usize = 1 << 18;

/// Appends the checksum of a file and flushes it to the disk. Readers of HDF5 end at the length
/// that the file states, and do not see it.
///
/// # Errors
/// What the system says.
pub(crate) fn append(mut file: &File) -> io::Result<()> {
    file.seek(SeekFrom::Start(0))?;
    let sum = sum(file)?;
    file.seek(SeekFrom::End(0))?;
    file.write_all(&ending(sum))?;
    file.sync_all()
}

/// Whether a file ends with the checksum of what is before it; `None` where it ends with none.
///
/// # Errors
/// What the system says.
pub(crate) fn agrees(mut file: &File) -> io::Result<Option<bool>> {
    let Some(before) = file.metadata()?.len().checked_sub(LENGTH as u64) else {
        return Ok(None);
    };
    let mut found = [0; LENGTH];
    file.seek(SeekFrom::Start(before))?;
    file.read_exact(&mut found)?;
    if !found.starts_with(LABEL) {
        return Ok(None);
    }
    file.seek(SeekFrom::Start(0))?;
    Ok(Some(found == ending(sum(file.take(before))?)))
}

fn ending(sum: u32) -> [u8; LENGTH] {
    let mut ending = [0; LENGTH];
    let digits = format!("{sum:08x}");
    ending[..LABEL.len()].copy_from_slice(LABEL);
    ending[LABEL.len()..].copy_from_slice(digits.as_bytes());
    ending
}

fn sum(bytes: impl Read) -> io::Result<u32> {
    let mut reader = BufReader::with_capacity(PIECE, bytes);
    let mut crc = Crc::new();
    loop {
        let piece = reader.fill_buf()?;
        if piece.is_empty() {
            return Ok(crc.sum());
        }
        crc.update(piece);
        let count = piece.len();
        reader.consume(count);
    }
}
