//! What the axes of an array of samples are, and which records they make.

use crate::records::channels::{chosen, numbered};
use crate::records::cut::Head;
use crate::records::error::{RecordError, name};
use crate::records::options::{ReadOptions, Rows};
use std::path::Path;

/// Axes by their meaning, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Axes {
    pub shots: Option<usize>,
    pub channels: Option<usize>,
    pub time: usize,
}

impl Axes {
    /// The axes of an array of this shape, if it can be one of samples.
    pub(crate) fn of(shape: &[usize], rows: Rows) -> Option<Self> {
        let (shots, channels, time) = match (shape, rows) {
            (&[_], _) => (None, None, 0),
            (&[a, b], Rows::Auto) if a <= b => (Some(0), None, 1),
            (&[_, _], Rows::Shots) => (Some(0), None, 1),
            (&[_, _], Rows::Channels) => (None, Some(0), 1),
            (&[_, _], Rows::Moments) => (Some(1), None, 0),
            (&[_, _], Rows::Auto | Rows::Times) => (None, Some(1), 0),
            (&[_, _, _], _) => (Some(0), Some(1), 2),
            _ => return None,
        };
        Some(Self {
            shots,
            channels,
            time,
        })
    }
}

/// An array of samples whose meaning is known.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    pub axes: Axes,
    /// Channels that are stored.
    pub stored: usize,
    pub shots: usize,
    /// Samples of a channel in a shot.
    pub frames: usize,
    /// Channels that are wanted.
    pub chosen: Vec<usize>,
    /// What its records share; none is divided yet.
    pub head: Head,
}

impl Table {
    /// # Errors
    /// Arrays without samples or of too many axes; what [`chosen`] refuses.
    pub(crate) fn of(
        file: &Path,
        part: Option<String>,
        shape: &[usize],
        interval_s: f64,
        options: &ReadOptions,
    ) -> Result<Self, RecordError> {
        if shape.contains(&0) {
            return Err(RecordError::Empty {
                source_name: name(file),
            });
        }
        let axes = Axes::of(shape, options.rows_of(shape)).ok_or_else(|| {
            let detail = format!("of {} axes, {shape:?}, is no table of samples", shape.len());
            RecordError::malformed(file, "an array", detail)
        })?;
        let size = |axis: Option<usize>| axis.and_then(|axis| shape.get(axis)).map_or(1, |n| *n);
        let (stored, shots) = (size(axes.channels), size(axes.shots));
        let frames = size(Some(axes.time));
        let unasked = options.rows == Rows::Auto && axes.shots == Some(1);
        let names = numbered(stored);
        let chosen = match stored {
            1 => vec![0],
            _ => chosen(file, &names, options)?,
        };
        let head = Head {
            file: file.to_owned(),
            part,
            names: chosen
                .iter()
                .filter_map(|index| names.get(*index).cloned())
                .collect(),
            interval_s,
            total: frames.saturating_mul(shots),
            row: frames,
            each: frames,
            pieces: false,
            note: unasked.then(|| {
                format!(
                    "each of the {shots} columns, of {frames} samples, was taken for a shot; --rows times \
                     or --channel says that they are channels"
                )
            }),
        };
        Ok(Self {
            axes,
            stored,
            shots,
            frames,
            chosen,
            head,
        })
    }
}

#[cfg(test)]
#[path = "tests/table.rs"]
mod tests;
