//! Columns of numbers as text: any delimiter, decimal commas, preambles.

mod dialect;
mod header;
mod lines;
mod rows;
mod times;

pub(crate) use lines::Encoding;

use crate::error::MeasureError;
use crate::records::interval::{Interval, interval_s, seconds_assumed};
use crate::records::options::{ReadOptions, chosen};
use crate::records::read::Raw;
use dialect::Dialect;
use header::Header;
use rows::{Plan, Segments};
use std::path::Path;

/// Opens a file of text; its beginning shows the columns.
pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw, MeasureError> {
    let beginning = dialect::beginning(file).map_err(|e| MeasureError::reading(file, e))?;
    let malformed = |detail: &str| MeasureError::malformed(file, "text", detail);
    let dialect =
        Dialect::of(&beginning).ok_or_else(|| malformed("no columns of numbers were found"))?;
    let header = Header::of(&beginning, &dialect, options.time_unit_s.is_some());
    let needs_unit = options.time_unit_s.is_none() && options.trusted_rate_hz().is_none();
    if let Some(unit) = header.strange_unit.as_ref().filter(|_| needs_unit) {
        return Err(malformed(&format!(
            "its times, {:?}, are in {unit:?}, which is no unit of time that is known here, as s, \
             ms, us and ns are; say with --time-unit what they are in",
            header.time_name
        )));
    }
    let (names, columns) = chosen(file, &header.names, options)?
        .into_iter()
        .map(|index| (header.names[index].clone(), header.channels[index]))
        .unzip();
    let time = header.time.map(|(column, unit_s)| {
        let unit_s = unit_s.or(options.time_unit_s);
        (column, unit_s.unwrap_or(1.0))
    });
    let interval = match time {
        // Follows from the times.
        Some(_) => Interval::exact(f64::NAN),
        None => Interval::exact(interval_s(file, header.interval_s, options)?),
    };
    let unit_s = header.time.map(|time| time.1);
    let note = unit_s.and_then(|unit_s| seconds_assumed(&header.time_name, unit_s, options));
    let before = beginning.lines().take(dialect.first_row);
    let plan = Plan {
        names,
        columns,
        time,
        stated_s: header.interval_s,
        interval,
        note,
        separators: before.map(str::to_owned).collect(),
        dialect,
        options: options.clone(),
    };
    let segments = Segments::open(file, plan).map_err(|e| MeasureError::reading(file, e))?;
    Ok(Box::new(segments))
}
