//! What no record may be, whatever its format.

use crate::error::RecordError;
use crate::options::Parts;
use crate::record::{Channel, Record, Samples};

/// Refuses records without samples, with channels of different lengths,
/// with samples that are not finite and with channels that never change.
///
/// A piece of a recording may be quiet.
pub(crate) fn sound(record: Record, parts: Parts) -> Result<Record, RecordError> {
    let length = record.len();
    if length == 0 {
        return Err(RecordError::Empty {
            source_name: record.source,
        });
    }
    for channel in &record.channels {
        if channel.samples.len() != length {
            return Err(RecordError::MixedLengths {
                source_name: record.source,
                found: channel.samples.len(),
                expected: length,
                why: "as in its first channel",
            });
        }
        finite(&record.source, channel)?;
        if !matches!(parts, Parts::Pieces(_)) {
            varied(&record.source, channel)?;
        }
    }
    Ok(record)
}

fn finite(source: &str, channel: &Channel) -> Result<(), RecordError> {
    let Samples::Volts(volts) = &channel.samples else {
        return Ok(());
    };
    let Some(first) = volts.iter().position(|volt| !volt.is_finite()) else {
        return Ok(());
    };
    Err(RecordError::NotFinite {
        source_name: source.to_owned(),
        channel: channel.name.clone(),
        count: volts.iter().filter(|volt| !volt.is_finite()).count(),
        of: volts.len(),
        first: first + 1,
    })
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
