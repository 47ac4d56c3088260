//! What no record may be, whatever its format.

use crate::records::error::RecordError;
use crate::records::options::Parts;
use crate::records::record::{Channel, Record, Samples};
use std::ops::Range;

/// Share of the samples of a channel that may be no numbers: more are no signal.
const BEARABLE: f64 = 0.01;

/// Refuses records without samples, with channels of different lengths,
/// with many samples that are not finite and with channels that never change. Few are filled and
/// noted as gaps.
///
/// A piece of a recording may be quiet.
pub(crate) fn sound(mut record: Record, parts: Parts) -> Result<Record, RecordError> {
    let length = record.len();
    if length == 0 {
        return Err(RecordError::Empty {
            source_name: record.source,
        });
    }
    let mut gaps = Vec::new();
    for channel in &mut record.channels {
        gaps.extend(filled(&record.source, channel)?);
    }
    record.gaps = gaps;
    for channel in &record.channels {
        if channel.samples.len() != length {
            return Err(RecordError::MixedLengths {
                source_name: record.source,
                found: channel.samples.len(),
                expected: length,
                why: "as in its first channel",
            });
        }
        if !matches!(parts, Parts::Pieces(_)) {
            varied(&record.source, channel)?;
        }
    }
    Ok(record)
}

/// Fills the samples that are not finite, and gives their runs.
fn filled(source: &str, channel: &mut Channel) -> Result<Vec<Range<usize>>, RecordError> {
    let Samples::Volts(volts) = &mut channel.samples else {
        return Ok(Vec::new());
    };
    let Some(first) = volts.iter().position(|volt| !volt.is_finite()) else {
        return Ok(Vec::new());
    };
    let count = volts.iter().filter(|volt| !volt.is_finite()).count();
    if count as f64 > BEARABLE * volts.len() as f64 {
        return Err(RecordError::NotFinite {
            source_name: source.to_owned(),
            channel: channel.name.clone(),
            count,
            of: volts.len(),
            first: first + 1,
        });
    }
    let finite = || volts.iter().copied().filter(|volt| volt.is_finite());
    let ends = (
        finite().fold(f64::INFINITY, f64::min),
        finite().fold(f64::NEG_INFINITY, f64::max),
    );
    let mut gaps: Vec<Range<usize>> = Vec::new();
    for (at, _) in volts
        .iter()
        .enumerate()
        .filter(|(_, volt)| !volt.is_finite())
    {
        match gaps.last_mut() {
            Some(gap) if gap.end == at => gap.end += 1,
            _ => gaps.push(at..at + 1),
        }
    }
    gaps.iter().for_each(|gap| fill(volts, gap, ends));
    Ok(gaps)
}

/// What was beyond a range is the record's least or largest; what is missing, between its
/// neighbours.
fn fill(volts: &mut [f64], gap: &Range<usize>, (low, high): (f64, f64)) {
    let before = gap
        .start
        .checked_sub(1)
        .and_then(|at| volts.get(at))
        .copied();
    let after = volts.get(gap.end).copied();
    let (from, to) = match (before, after) {
        (Some(from), Some(to)) => (from, to),
        (one, other) => {
            let only = one.or(other).unwrap_or(0.0);
            (only, only)
        }
    };
    let steps = gap.len() as f64 + 1.0;
    for (number, volt) in volts[gap.clone()].iter_mut().enumerate() {
        *volt = match *volt {
            f64::INFINITY => high,
            f64::NEG_INFINITY => low,
            _ => from + (to - from) * (number as f64 + 1.0) / steps,
        };
    }
}

fn varied(source: &str, channel: &Channel) -> Result<(), RecordError> {
    fn all_same<T: PartialEq>(of: &[T]) -> bool {
        of.iter().all(|value| Some(value) == of.first())
    }
    let constant = match &channel.samples {
        Samples::Volts(volts) => all_same(volts),
        Samples::Counts { counts, .. } => all_same(counts),
    };
    if !constant {
        return Ok(());
    }
    let value = channel.samples.part(0, 1).volts();
    Err(RecordError::Constant {
        source_name: source.to_owned(),
        channel: channel.name.clone(),
        of: channel.samples.len(),
        value: value.first().copied().unwrap_or(f64::NAN),
    })
}

/// Refuses shots that are not as long as the file's first.
pub(crate) fn as_long(
    record: Record,
    parts: Parts,
    first: &mut Option<usize>,
) -> Result<Record, RecordError> {
    let expected = *first.get_or_insert(record.len());
    if record.len() == expected || matches!(parts, Parts::Pieces(_)) {
        return Ok(record);
    }
    Err(RecordError::MixedLengths {
        found: record.len(),
        source_name: record.source,
        expected,
        why: match parts == Parts::Shots(expected) {
            true => "what cutting left over is no shot",
            false => "as in the file's first record",
        },
    })
}
