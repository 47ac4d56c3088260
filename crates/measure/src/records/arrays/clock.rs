//! Times among the columns of an array, as they are among those of a text.

use crate::records::error::RecordError;
use crate::records::interval::seconds_taken;
use crate::records::options::{Parts, ReadOptions, Rows};
use crate::records::read::Raw;

/// Samples that are looked at.
pub(crate) const LOOKED_AT: usize = 4096;

/// Fewer may rise evenly by chance.
const LEAST: usize = 32;

/// Most columns of which one may be times.
const MOST: usize = 8;

/// Most channels that a shot has.
const CHANNELS: usize = 2;

/// Share of a step by which times in single or double precision may be off even ones, besides
/// single precision's own rounding.
const EVEN: f64 = 1e-3;

/// Largest share of a step that rounding may be.
const ROUNDED: f64 = 0.4;

/// An array of which the first column, or row, is times or counts.
pub(crate) struct Clock {
    /// How the others are to be read.
    pub options: ReadOptions,
    /// From one time to the next in s; `None` of counts.
    pub interval_s: Option<f64>,
    /// What was taken for granted.
    pub note: Option<String>,
}

/// Looks whether the first column of a table of few columns, or its first row of few rows, rises
/// evenly, as no signal does; `open` reads the array.
pub(crate) fn clock(
    shape: &[usize],
    options: &ReadOptions,
    open: &dyn Fn(&ReadOptions) -> Result<Raw, RecordError>,
) -> Option<Clock> {
    let &[first, second] = shape else { return None };
    let (columns, long) = (first.min(second), first.max(second));
    let rows = if first <= second {
        Rows::Channels
    } else {
        Rows::Times
    };
    let plain = (2..=MOST).contains(&columns) && long >= LEAST;
    let free = options.rows == Rows::Auto || options.rows == rows;
    if !plain || !free || options.channels.iter().any(|name| name == "1") {
        return None;
    }
    let looking = ReadOptions {
        rows,
        channels: vec!["1".to_owned()],
        parts: Parts::Pieces(LOOKED_AT),
        ..options.clone()
    };
    let record = open(&looking).ok()?.next()?.ok()?;
    let step = rises(&record.channels.first()?.samples.volts())?;
    let interval_s = of_step(step, options);
    let named = (2..=columns).map(|number| number.to_string());
    let told = !options.channels.is_empty() || columns > CHANNELS + 1;
    Some(Clock {
        interval_s,
        note: interval_s.and_then(|_| seconds_taken("", None, options)),
        options: ReadOptions {
            rows,
            channels: if told {
                options.channels.clone()
            } else {
                named.collect()
            },
            ..options.clone()
        },
    })
}

/// What a step between numbers is in s; nothing of counts, whose unit nobody tells.
pub(crate) fn of_step(step: f64, options: &ReadOptions) -> Option<f64> {
    let counts = step == 1.0 && options.time_unit_s.is_none();
    (!counts).then(|| step * options.time_unit_s.unwrap_or(1.0))
}

/// The step of numbers that rise evenly; those in single precision are rounded.
pub(crate) fn rises(values: &[f64]) -> Option<f64> {
    let (first, last) = (values.first()?, values.last()?);
    let step = (last - first) / (values.len().checked_sub(1)? as f64);
    let rounding = f64::from(f32::EPSILON) * first.abs().max(last.abs());
    let bearable = (EVEN * step + rounding).min(ROUNDED * step);
    let even = |(i, value): (usize, &f64)| (value - first - i as f64 * step).abs() <= bearable;
    let all = values.len() >= LEAST && step > 0.0 && values.iter().enumerate().all(even);
    all.then_some(step)
}

#[cfg(test)]
#[path = "tests/clock.rs"]
mod tests;
