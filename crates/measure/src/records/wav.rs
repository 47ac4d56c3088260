//! RIFF WAVE: the header by hound, the samples as raw numbers.

use crate::error::{MeasureError, Result, file_name};
use crate::records::interval::interval_s;
use crate::records::options::{ReadOptions, chosen, numbered};
use crate::records::read::Raw;
use crate::records::stored::{Head, NumberKind, StoredChannel, StoredNumber};
use hound::{SampleFormat, WavReader, WavSpec};
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// Opens a WAV file; its whole numbers are shares of the full scale.
pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw> {
    let reading = |cause| MeasureError::reading(file, cause);
    let mut reader = BufReader::new(File::open(file).map_err(reading)?);
    let header = header(&mut reader).map_err(reading)?;
    let start = reader.stream_position().map_err(reading)?;
    let wave = WavReader::new(&header[..]).map_err(|error| refused(file, error))?;
    let (spec, frames) = (wave.spec(), wave.duration() as usize);
    let number = number(file, spec)?;
    let names = numbered(usize::from(spec.channels));
    let chosen = chosen(file, &names, options)?;
    if frames == 0 {
        return Err(MeasureError::empty(file_name(file)));
    }
    let head = Head {
        file: file.to_owned(),
        part: None,
        names: chosen.iter().map(|index| names[*index].clone()).collect(),
        interval_s: interval_s(file, Some(f64::from(spec.sample_rate).recip()), options)?,
        rows: 1,
        frames,
        note: None,
    };
    let wide = number.width();
    let channel = |at: &usize| {
        let first = start + (at * wide) as u64;
        StoredChannel::run(number, first, frames, names.len() * wide)
    };
    let channels = chosen.iter().map(channel).collect();
    Ok(head.stored(options.parts, reader, channels, 0))
}

/// Bytes of a chunk that says how samples are stored, at most.
const MOST_FORMAT: u32 = 64;

/// The file's header without chunks that say nothing of samples, up to these: hound does not expect the byte
/// that follows a chunk of odd length.
fn header(reader: &mut (impl Read + Seek)) -> io::Result<Vec<u8>> {
    let mut header = Vec::new();
    reader.by_ref().take(12).read_to_end(&mut header)?;
    loop {
        let mut chunk = Vec::new();
        reader.by_ref().take(8).read_to_end(&mut chunk)?;
        let &[a, b, c, d, ref length @ ..] = &chunk[..] else {
            return Ok(header);
        };
        let length = length.try_into().map_or(0, u32::from_le_bytes);
        match &[a, b, c, d] {
            b"data" => return Ok([header, chunk].concat()),
            b"fmt " if length <= MOST_FORMAT => {
                header.append(&mut chunk);
                reader.by_ref().take(length.into()).read_to_end(&mut header)?;
            }
            _ => reader.seek(SeekFrom::Current(length.into())).map(drop)?,
        }
        // Not every program writes it, and no chunk's name begins with 0.
        let mut padding = [0];
        if length % 2 == 1 && reader.read(&mut padding)? == 1 && padding != [0] {
            reader.seek(SeekFrom::Current(-1))?;
        }
    }
}

fn number(file: &Path, spec: WavSpec) -> Result<StoredNumber> {
    let (kind, scale, offset) = match (spec.sample_format, spec.bits_per_sample.div_ceil(8)) {
        (SampleFormat::Int, 1) => (NumberKind::U8, 1.0 / 128.0, -1.0),
        (SampleFormat::Int, 2) => (NumberKind::I16, 1.0 / 32_768.0, 0.0),
        (SampleFormat::Int, 3) => (NumberKind::I24, 1.0 / 8_388_608.0, 0.0),
        (SampleFormat::Int, 4) => (NumberKind::I32, 1.0 / 2_147_483_648.0, 0.0),
        (SampleFormat::Float, 4) => (NumberKind::F32, 1.0, 0.0),
        (_, bytes) => {
            let detail = format!("samples of {bytes} bytes are not read");
            return Err(MeasureError::malformed(file, "WAV", detail));
        }
    };
    Ok(StoredNumber { scale, offset, ..StoredNumber::plain(kind, false) })
}

fn refused(file: &Path, error: hound::Error) -> MeasureError {
    match error {
        // The library's error for a header that is not whole.
        hound::Error::IoError(cause) if cause.kind() == std::io::ErrorKind::Other => {
            MeasureError::truncated(file_name(file), "its header is not whole")
        }
        hound::Error::IoError(cause) => MeasureError::reading(file, cause),
        // The library's error for floating-point numbers alone.
        hound::Error::FormatError("bits per sample is not 32") => {
            let detail = "floating-point samples of another width than 32 bits are not read; save \
                          them as float32, or as NPY";
            MeasureError::malformed(file, "WAV", detail)
        }
        error => MeasureError::malformed(file, "WAV", error),
    }
}
