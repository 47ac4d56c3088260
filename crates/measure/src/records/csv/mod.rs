//! Columns of numbers as text: any delimiter, decimal commas, preambles.

mod dialect;
mod even;
mod field;
mod header;
mod lines;
mod rows;
mod times;

use crate::records::channels::chosen;
use crate::records::error::RecordError;
use crate::records::interval::{Interval, interval_s, seconds_taken};
use crate::records::options::ReadOptions;
use crate::records::read::Raw;
use std::path::Path;

/// Opens a file of text; its beginning tells what the columns are.
pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw, RecordError> {
    let beginning = dialect::beginning(file).map_err(|e| RecordError::reading(file, e))?;
    let dialect = dialect::Dialect::of(&beginning)
        .ok_or_else(|| RecordError::malformed(file, "text", "no columns of numbers were found"))?;
    let header = header::Header::of(&beginning, &dialect, options.time_unit_s.is_some());
    if let Some(unit) = header.strange_unit.as_ref().filter(|_| !told(options)) {
        return Err(RecordError::malformed(file, "text", strange(&header, unit)));
    }
    let picked = chosen(file, &header.names, options)?;
    let columns = picked
        .iter()
        .filter_map(|index| header.channels.get(*index));
    let unit_s = header
        .time
        .map(|time| time.1.or(options.time_unit_s).unwrap_or(1.0));
    let plan = rows::Plan {
        names: picked
            .iter()
            .filter_map(|index| header.names.get(*index).cloned())
            .collect(),
        columns: columns.copied().collect(),
        time: header.time.map(|time| time.0).zip(unit_s),
        stated_s: header.interval_s,
        interval: match header.time {
            // Told by the times.
            Some(_) => Interval::of(f64::NAN),
            None => Interval::of(interval_s(file, header.interval_s, options)?),
        },
        notes: header
            .time
            .and_then(|time| seconds_taken(&header.time_name, time.1, options))
            .into_iter()
            .collect(),
        separators: beginning
            .lines()
            .take(dialect.first_row)
            .map(str::to_owned)
            .collect(),
        dialect,
        options: options.clone(),
    };
    let rows = rows::Rows::open(file, plan).map_err(|e| RecordError::reading(file, e))?;
    Ok(Box::new(rows))
}

/// Whether nobody need know the unit of times.
fn told(options: &ReadOptions) -> bool {
    options.time_unit_s.is_some() || (options.trust_rate && options.rate_hz.is_some())
}

fn strange(header: &header::Header, unit: &str) -> String {
    format!(
        "its times, {:?}, are in {unit:?}, which is no unit of time that is known here, as s, ms, \
         us and ns are; say with --time-unit what they are in",
        header.time_name
    )
}
