//! Columns of numbers as text: any delimiter, decimal commas, preambles, in any encoding.

mod dialect;
mod header;
mod rows;
mod times;

use crate::error::{MeasureError, Result};
use crate::records::interval::{SampleInterval, interval_s, seconds_assumed};
use crate::records::options::{ReadOptions, chosen};
use crate::records::read::Raw;
use dialect::Dialect;
use header::TextHeader;
pub(crate) use header::{seconds, volts};
use rows::{RowPlan, Segments};
use std::borrow::Cow;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek};
use std::path::Path;

const PROBE: usize = 64;

/// Most bytes of a text in UTF-16, which is decoded as a whole: 1 GiB.
const MOST_DECODED: u64 = 1 << 30;

/// Most bytes of a line: 16 MiB, a row of a million samples of sixteen letters.
const MOST_LINE: usize = 1 << 24;

pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw> {
    let reading = |cause| MeasureError::reading(file, cause);
    let malformed = |detail: &str| MeasureError::malformed(file, "text", detail);
    let beginning = dialect::beginning(file).map_err(reading)?;
    let dialect = Dialect::of(&beginning);
    let dialect = dialect.ok_or_else(|| malformed("no columns of numbers were found"))?;
    let header = TextHeader::of(&beginning, &dialect, options.time_unit_s.is_some());
    let needs_unit = options.time_unit_s.is_none() && options.trusted_rate_hz().is_none();
    if let Some(unit) = header.strange_unit.as_ref().filter(|_| needs_unit) {
        return Err(malformed(&format!(
            "its times, {:?}, are in {unit:?}, which is no unit of time that is known here, as s, \
             ms, us and ns are; say with --time-unit what they are in",
            header.time_name
        )));
    }
    let picked = chosen(file, &header.names, options)?.into_iter();
    let name = |index: usize| (header.names[index].clone(), header.scales[index]);
    let picked = picked.map(|index| (name(index), header.channels[index]));
    let (names, columns) = picked.unzip();
    let unit_s = header.time.map(|time| time.1);
    let interval = match header.time {
        // Follows from the times.
        Some(_) => SampleInterval::exact(f64::NAN),
        None => SampleInterval::exact(interval_s(file, header.interval_s, options)?),
    };
    let before = beginning.lines().take(dialect.first_row);
    let plan = RowPlan {
        names,
        columns,
        time: header.time.map(|(column, unit_s)| {
            let unit_s = unit_s.or(options.time_unit_s);
            (column, unit_s.unwrap_or(1.0))
        }),
        stated_s: header.interval_s,
        interval,
        note: unit_s.and_then(|unit_s| seconds_assumed(&header.time_name, unit_s, options)),
        separators: before.map(str::to_owned).collect(),
        dialect,
        options: options.clone(),
    };
    Ok(Box::new(Segments::open(file, plan).map_err(reading)?))
}

/// UTF-8 of bytes in UTF-16, by the mark at the beginning, without one by the zeros that every
/// other byte of Latin letters and digits is; other bytes as they are.
pub(crate) fn decoded(bytes: &[u8]) -> Cow<'_, [u8]> {
    let probe = bytes.get(..PROBE).unwrap_or(bytes);
    let zeros = |from: usize| {
        let mut bytes = probe.iter().skip(from).step_by(2);
        probe.len() >= 8 && bytes.all(|byte| *byte == 0)
    };
    let unit: fn([u8; 2]) -> u16 = match bytes {
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        _ if zeros(1) => u16::from_le_bytes,
        _ if zeros(0) => u16::from_be_bytes,
        _ => return Cow::Borrowed(bytes),
    };
    let units = bytes.as_chunks::<2>().0.iter().map(|pair| unit(*pair));
    let text = String::from_utf16_lossy(&units.collect::<Vec<_>>());
    Cow::Owned(text.trim_start_matches('\u{feff}').as_bytes().to_vec())
}

/// Bytes as text without its mark; those that are not UTF-8 are Latin-1, as oscilloscopes write µ.
pub(crate) fn as_text(bytes: &[u8]) -> String {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    }
}

/// Lines that end with LF, CR LF or CR alone; as many CR as there are before one LF are one end.
struct Lines {
    reader: Box<dyn BufRead>,
    blank: usize,
}

#[derive(PartialEq)]
enum LineEnding {
    Whole,
    Begun,
    Nothing,
}

impl Lines {
    fn open(file: &Path) -> io::Result<Self> {
        let (mut file, mut probe) = (File::open(file)?, Vec::new());
        file.by_ref().take(PROBE as u64).read_to_end(&mut probe)?;
        file.rewind()?;
        let reader: Box<dyn BufRead> = match decoded(&probe) {
            Cow::Borrowed(_) => Box::new(BufReader::with_capacity(1 << 16, file)),
            Cow::Owned(_) => {
                let mut bytes = Vec::new();
                file.take(MOST_DECODED).read_to_end(&mut bytes)?;
                Box::new(Cursor::new(decoded(&bytes).into_owned()))
            }
        };
        Ok(Self { reader, blank: 0 })
    }

    fn next(&mut self, line: &mut Vec<u8>) -> io::Result<LineEnding> {
        line.clear();
        if self.blank > 0 {
            self.blank -= 1;
            return Ok(LineEnding::Whole);
        }
        loop {
            let buffer = self.reader.fill_buf()?;
            if buffer.is_empty() {
                return Ok(match line.is_empty() {
                    true => LineEnding::Nothing,
                    false => LineEnding::Begun,
                });
            }
            let end = buffer.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            let part = end.unwrap_or(buffer.len());
            line.extend_from_slice(&buffer[..part]);
            let returns = buffer.get(part) == Some(&b'\r');
            self.reader.consume(part + usize::from(end.is_some()));
            if line.len() > MOST_LINE {
                let detail = format!("a line of it is longer than {} MiB", MOST_LINE >> 20);
                return Err(io::Error::new(io::ErrorKind::InvalidData, detail));
            }
            if returns {
                self.blank = self.blank_lines()?;
            }
            if end.is_some() {
                return Ok(LineEnding::Whole);
            }
        }
    }

    /// Empty lines after a CR: none if LF ends what are only CR until there.
    fn blank_lines(&mut self) -> io::Result<usize> {
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
