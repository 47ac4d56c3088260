//! A sweep's table and power laws: printed, as CSV, as a figure. Shots of this
//! process and merged shards are reported alike.

use super::fits;
use crate::program::print::print;
use crate::program::{Failure, Folder, Style, format, heading, pictures};
use crate::{csv, table};
use hertzchain_experiment::Units;
use hertzchain_sim::{BatchResult, COLUMNS, Column, Rows};
use std::collections::HashSet;

/// The table in the output folder.
pub(crate) const SWEEP: &str = "sweep.csv";

/// What a column is called, its unit, the size of the unit, and which it is.
type Shown = (&'static str, &'static str, f64, Column);

const SHOWN: [Shown; 10] = [
    ("speed", "m/s", 1.0, Column::Speed),
    ("incident ToF", "µs", 1e-6, Column::Incident),
    ("reflected ToF", "µs", 1e-6, Column::Reflected),
    ("sensor peak", "N", 1.0, Column::SensorPeak),
    ("wall peak", "N", 1.0, Column::WallPeak),
    ("rebound", "m/s", 1.0, Column::Rebound),
    ("competing maximum", "µs", 1e-6, Column::CompetingTime),
    ("competing peak", "N", 1.0, Column::CompetingPeak),
    ("reflected, competing", "µs", 1e-6, Column::CompetingReflectedTime),
    ("its peak", "N", 1.0, Column::CompetingReflectedPeak),
];

pub(crate) fn nothing(part: &BatchResult) -> bool {
    part.rows.failed.len() == part.rows.len()
}

/// Prints the table with its power laws; nothing where no speed has a shot,
/// which is reported instead.
pub(crate) fn show(part: &BatchResult) -> Result<(), Failure> {
    if nothing(part) {
        return Ok(());
    }
    let mut text = rows(part) + &fits::lines(part);
    if part.error_control.starts_with("calibrated") {
        text += &format!("Error control: {}\n", part.error_control);
    }
    print(&text)
}

pub(crate) fn rows(part: &BatchResult) -> String {
    let reached = part.rows.column(Column::Accuracy).iter().copied();
    // A number that is none is never the larger one.
    let style = Style::of_accuracy(reached.fold(part.accuracy, f64::max), part.units);
    format!("{}\n{}", heading(&part.title), lines(style, &part.rows))
}

fn reported(rows: &Rows, column: Column) -> bool {
    rows.column(column).iter().any(|value| !value.is_nan())
}

fn lines(style: Style, rows: &Rows) -> String {
    let si = style.units == Units::Si;
    let column = |(name, unit, size, of): &Shown| {
        let size = if si { *size } else { 1.0 };
        let values = rows.column(*of).iter();
        let values: Vec<Option<f64>> =
            values.map(|value| (!value.is_nan()).then(|| value / size)).collect();
        let digits = if name.ends_with("ToF") { style.digits + 1 } else { 5 };
        let head = if si { format!("{name} ({unit})") } else { (*name).to_owned() };
        (head, format::column(&values, digits))
    };
    let shown = SHOWN.iter().filter(|shown| reported(rows, shown.3));
    let (mut head, mut columns): (Vec<String>, Vec<Vec<String>>) = shown.map(column).unzip();
    if reported(rows, Column::Accuracy) {
        let text = |reached: &f64| match reached.is_nan() {
            true => String::new(),
            false => format!("{reached:.0e}"),
        };
        head.push("accuracy reached".to_owned());
        columns.push(rows.column(Column::Accuracy).iter().map(text).collect());
    }
    let row = |i: usize| columns.iter().map(move |column| &column[i]).collect::<Vec<_>>();
    format::table(head, (0..rows.len()).map(row))
}

pub(crate) fn write(mut folder: Folder, part: &BatchResult) -> Result<(), Failure> {
    folder.write(SWEEP, csv(part).as_bytes())?;
    folder.figure("sweep", &pictures::sweep(part))?;
    folder.finish_and_report()
}

/// Shots that are none have no line.
fn csv(part: &BatchResult) -> String {
    let titles = COLUMNS.iter().map(|name| match part.units {
        Units::Si => name,
        Units::Dimensionless => table::without_unit(name),
    });
    let failed: HashSet<usize> = part.rows.failed.iter().map(|failed| failed.place).collect();
    let places = (0..part.rows.len()).filter(|place| !failed.contains(place));
    let line = |place: usize| part.rows.columns.iter().map(move |column| column[place].into());
    csv::table(titles, places.map(line))
}
