//! A shard of a sweep as a file.

use crate::shards::error::ShardsError;
use crate::shards::gather::ENDING;
use crate::{COLUMNS, Failed, Fingerprint, Odd, Part, Rows, Shard};
use hertzchain_experiment::Units;
use hertzchain_measure::records::Table;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// What a file says it is.
const FORMAT: &str = "hertzchain sweep shard 1";

/// What stands beside the numbers, as JSON.
#[derive(Serialize, Deserialize)]
struct Header {
    format: String,
    run: String,
    shard: usize,
    of: usize,
    shots: usize,
    title: String,
    dimensionless: bool,
    accuracy: f64,
    about: String,
    tuned: Option<String>,
    failed: Vec<Failed>,
    odd: Option<Odd>,
    /// Of all the rest, numbers included.
    content: String,
}

/// Writes a part into a folder, under its name: whole or not at all. Its bytes
/// follow from the part alone.
///
/// # Errors
/// A file that can't be written.
pub fn write(part: &Part, folder: &Path) -> Result<PathBuf, ShardsError> {
    let path = folder.join(format!("{}{ENDING}", part.name()));
    let mut header = header(part);
    header.content = content(&header, &part.rows).to_string();
    let columns = COLUMNS.iter().zip(&part.rows.columns);
    let table = Table {
        about: text(&header),
        columns: columns
            .map(|(name, values)| ((*name).to_owned(), values.clone()))
            .collect(),
    };
    table.write(&path).map_err(ShardsError::Unwritable)?;
    Ok(path)
}

fn header(part: &Part) -> Header {
    Header {
        format: FORMAT.to_owned(),
        run: part.run.to_string(),
        shard: part.shard.number(),
        of: part.shard.of(),
        shots: part.shots,
        title: part.title.clone(),
        dimensionless: part.units == Units::Dimensionless,
        accuracy: part.accuracy,
        about: part.about.clone(),
        tuned: part.tuned.clone(),
        failed: part.rows.failed.clone(),
        odd: part.rows.odd.clone(),
        content: String::new(),
    }
}

fn text(header: &Header) -> String {
    // Texts and numbers always have a form in JSON.
    serde_json::to_string_pretty(header).unwrap_or_default()
}

/// A hash of all that a file tells, but for itself.
fn content(header: &Header, rows: &Rows) -> Fingerprint {
    let mut bytes = text(header).into_bytes();
    for value in rows.columns.iter().flatten() {
        bytes.extend(value.to_bits().to_le_bytes());
    }
    Fingerprint::of_bytes(&bytes)
}

/// Reads a shard and sees that it is whole.
///
/// # Errors
/// [`ShardsError::Damaged`] with what is wrong.
pub fn read(path: &Path) -> Result<Part, ShardsError> {
    let damaged = |why: String| ShardsError::Damaged {
        file: path.display().to_string(),
        why,
    };
    let table = Table::read(path, &COLUMNS).map_err(|error| damaged(error.to_string()))?;
    let header = serde_json::from_str::<Header>(&table.about);
    let header = header.map_err(|error| damaged(format!("its header is not ours ({error})")))?;
    part(header, table).map_err(|why| damaged(why.to_owned()))
}

fn part(mut header: Header, table: Table) -> Result<Part, &'static str> {
    if header.format != FORMAT {
        return Err("it is of another format");
    }
    let run = header
        .run
        .parse()
        .map_err(|_| "its run has no fingerprint")?;
    let shard = Shard::new(header.shard, header.of).map_err(|_| "there is no such shard")?;
    let mut rows = Rows {
        failed: header.failed.clone(),
        odd: header.odd.clone(),
        ..Rows::default()
    };
    for (name, values) in table.columns {
        if let Some(at) = COLUMNS.iter().position(|column| *column == name) {
            rows.columns[at] = values;
        }
    }
    let count = shard.places(header.shots).count();
    if rows.columns.iter().any(|column| column.len() != count) {
        return Err("it has not as many shots as it should");
    }
    let told = std::mem::take(&mut header.content);
    if content(&header, &rows).to_string() != told {
        return Err("its numbers are not those that were written");
    }
    Ok(Part {
        run,
        shard,
        shots: header.shots,
        title: header.title,
        units: match header.dimensionless {
            true => Units::Dimensionless,
            false => Units::Si,
        },
        accuracy: header.accuracy,
        about: header.about,
        tuned: header.tuned,
        rows,
    })
}
