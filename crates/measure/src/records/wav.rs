//! RIFF WAVE: the header by hound, the samples as raw numbers.

use crate::records::channels::{chosen, numbered};
use crate::records::cut::{Cut, Head, RawNumbers};
use crate::records::error::{RecordError, name};
use crate::records::interval::interval_s;
use crate::records::numbers::{Kind, Number};
use crate::records::options::ReadOptions;
use crate::records::read::Raw;
use hound::{SampleFormat, WavReader, WavSpec};
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Opens a WAV file; its whole numbers are shares of the full scale.
pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw, RecordError> {
    let opened = File::open(file).map_err(|cause| RecordError::reading(file, cause))?;
    let wave = WavReader::new(BufReader::new(opened)).map_err(|error| refused(file, error))?;
    let (spec, total) = (wave.spec(), wave.duration() as usize);
    let number = number(file, spec)?;
    let stored = usize::from(spec.channels);
    let names = numbered(stored);
    let chosen = chosen(file, &names, options)?;
    let rate_hz = f64::from(spec.sample_rate);
    if total == 0 {
        return Err(RecordError::Empty {
            source_name: name(file),
        });
    }
    let head = Head {
        file: file.to_owned(),
        part: None,
        names: chosen.iter().map(|index| names[*index].clone()).collect(),
        interval_s: interval_s(file, Some(rate_hz.recip()), options)?,
        total,
        row: total,
        each: total,
        pieces: false,
        note: None,
    };
    let stream = RawNumbers {
        reader: wave.into_inner(),
        file: file.to_owned(),
        number,
        stored,
        chosen,
    };
    Ok(Box::new(Cut::new(head.divided(options.parts), stream)))
}

fn number(file: &Path, spec: WavSpec) -> Result<Number, RecordError> {
    let (kind, scale, offset) = match (spec.sample_format, spec.bits_per_sample.div_ceil(8)) {
        (SampleFormat::Int, 1) => (Kind::U8, 1.0 / 128.0, -1.0),
        (SampleFormat::Int, 2) => (Kind::I16, 1.0 / 32_768.0, 0.0),
        (SampleFormat::Int, 3) => (Kind::I24, 1.0 / 8_388_608.0, 0.0),
        (SampleFormat::Int, 4) => (Kind::I32, 1.0 / 2_147_483_648.0, 0.0),
        (SampleFormat::Float, 4) => (Kind::F32, 1.0, 0.0),
        (_, bytes) => {
            let detail = format!("samples of {bytes} bytes are not read");
            return Err(RecordError::malformed(file, "WAV", detail));
        }
    };
    Ok(Number {
        kind,
        big_endian: false,
        scale,
        offset,
    })
}

fn refused(file: &Path, error: hound::Error) -> RecordError {
    match error {
        // What the library says where a header ends before its end.
        hound::Error::IoError(cause) if cause.kind() == std::io::ErrorKind::Other => {
            RecordError::truncated(name(file), "its header is not whole")
        }
        hound::Error::IoError(cause) => RecordError::reading(file, cause),
        // What it says of floating-point numbers alone.
        hound::Error::FormatError("bits per sample is not 32") => RecordError::malformed(
            file,
            "WAV",
            "its samples are floating-point numbers of another width than 32 bits, which are not \
             read; save them as float32, or as NPY",
        ),
        error => RecordError::malformed(file, "WAV", error),
    }
}
