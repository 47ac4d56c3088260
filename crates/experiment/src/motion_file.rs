//! Measured motion of a driven end: points in the experiment file, or in a
//! CSV file beside it.

use crate::finding::Problem;
use crate::value::Units;
use crate::view::View;
use hertzchain_chain::Motion;
use std::path::Path;

/// Larger files are a mistake.
const MOST_BYTES: u64 = 64 << 20;

/// First line of a CSV file, which names the columns and their units.
const HEADER: &str = "time_s,position_m";
/// The same for dimensionless files.
const HEADER_DIMENSIONLESS: &str = "time,position";

/// The motion of `[driven]` with `motion = "table"`.
pub(crate) fn table(table: &View<'_>, folder: &Path) -> Result<Motion, Problem> {
    let (times_s, positions_m, key) = match (table.text("file"), table.has("times")) {
        (Some(_), true) => {
            let message = "the motion stands both here and in a file";
            let label = "expected `file`, or `times` and `positions`";
            return Err(Problem::new(&table.span_of("file"), message, label));
        }
        (Some(file), false) => {
            let (times, positions) = from_file(table, &folder.join(file))?;
            (times, positions, "file")
        }
        (None, _) => (
            table.quantities("times")?,
            table.quantities("positions")?,
            "times",
        ),
    };
    let wrong = |message: &str, label: &str| Problem::new(&table.span_of(key), message, label);
    if times_s.len() != positions_m.len() {
        let message = "there are not as many positions as times";
        return Err(wrong(message, "expected one position a time"));
    }
    if times_s.len() < 2 {
        return Err(wrong(
            "a motion needs at least two points",
            "expected more points",
        ));
    }
    if times_s.windows(2).any(|pair| pair[0] >= pair[1]) {
        let label = "expected each time to be later than the one before";
        return Err(wrong("the times do not increase", label));
    }
    if positions_m.windows(2).all(|pair| pair[0] == pair[1]) {
        let label = "expected positions that differ";
        return Err(wrong("this motion sets nothing in motion", label));
    }
    Ok(Motion::Table {
        times_s,
        positions_m,
    })
}

fn from_file(table: &View<'_>, path: &Path) -> Result<(Vec<f64>, Vec<f64>), Problem> {
    let wrong =
        |message: String, label: String| Problem::new(&table.span_of("file"), message, label);
    let readable = || format!("expected a readable CSV file with the header {HEADER}");
    let unreadable =
        |e: std::io::Error| wrong(format!("{} can't be read: {e}", path.display()), readable());
    let size = std::fs::metadata(path).map_err(unreadable)?;
    if !size.is_file() || size.len() > MOST_BYTES {
        let message = format!("{} is not a file of at most 64 MiB", path.display());
        return Err(wrong(message, readable()));
    }
    let text = std::fs::read_to_string(path).map_err(unreadable)?;
    let header = match table.units {
        Units::Si => HEADER,
        Units::Dimensionless => HEADER_DIMENSIONLESS,
    };
    columns(&text, header).map_err(|(line, what)| {
        wrong(
            format!("{}:{line}: {what}", path.display()),
            format!("expected columns {header}"),
        )
    })
}

/// The two columns, or the line and what is wrong with it.
fn columns(text: &str, header: &str) -> Result<(Vec<f64>, Vec<f64>), (usize, String)> {
    let mut lines = text.lines().map(str::trim).enumerate();
    match lines.next() {
        Some((_, first)) if first == header => {}
        _ => return Err((1, format!("the first line is not {header}"))),
    }
    let rows = lines.filter(|(_, line)| !line.is_empty());
    rows.map(|(index, line)| {
        pair(line).ok_or_else(|| (index + 1, format!("`{line}` is not two numbers")))
    })
    .collect()
}

fn pair(line: &str) -> Option<(f64, f64)> {
    let (time, position) = line.split_once(',')?;
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    Some((number(time)?, number(position)?))
}
