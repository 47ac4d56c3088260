//! Numbers and tables for people.

use crate::print::heading;
use comfy_table::{CellAlignment, Table, presets};
use hertzchain_experiment::Units;
use hertzchain_study::{Group, Value};

/// Units that take prefixes.
const PREFIXED: [&str; 6] = ["s", "N", "m", "J", "Hz", "Pa"];

const PREFIXES: [(f64, &str); 7] = [
    (1e9, "G"),
    (1e6, "M"),
    (1e3, "k"),
    (1.0, ""),
    (1e-3, "m"),
    (1e-6, "µ"),
    (1e-9, "n"),
];

/// How numbers are written.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// Significant digits.
    pub digits: usize,
    /// Whether numbers have units.
    pub units: Units,
}

impl Style {
    /// Digits that an accuracy is worth, one to spare.
    pub fn of_accuracy(accuracy: f64, units: Units) -> Self {
        let digits = (-accuracy.log10()).ceil().clamp(3.0, 15.0) as usize + 1;
        Self { digits, units }
    }

    /// A few digits, for what need not be exact.
    pub fn brief(units: Units) -> Self {
        Self { digits: 6, units }
    }

    /// A number with its unit, with a prefix where that is usual.
    pub fn quantity(self, value: f64, unit: &str) -> String {
        if self.units == Units::Dimensionless || unit.is_empty() || unit == "1" {
            return digits(value, self.digits);
        }
        let prefix = PREFIXES.iter().find(|(size, _)| value.abs() >= *size);
        match prefix {
            Some((size, prefix)) if PREFIXED.contains(&unit) && value.abs() < 1e12 => {
                format!("{} {prefix}{unit}", digits(value / size, self.digits))
            }
            _ => format!("{} {unit}", digits(value, self.digits)),
        }
    }
}

/// A number with so many significant digits, trailing zeros dropped.
pub fn digits(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits.saturating_sub(1));
    let number: f64 = rounded.parse().unwrap_or(value);
    match number.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e7).contains(&size) => format!("{number}"),
        _ => format!("{number:e}"),
    }
}

/// Rows of a name and a value, aligned.
pub fn pairs(rows: &[(String, String)]) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    for (name, value) in rows {
        table.add_row([format!("  {name}"), value.clone()]);
    }
    trimmed(&table)
}

/// A table with a head.
pub fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header(head.to_vec());
    for row in rows {
        table.add_row(row.clone());
    }
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Right);
    }
    trimmed(&table)
}

fn trimmed(table: &Table) -> String {
    let lines = table.to_string();
    lines
        .lines()
        .map(|line| format!("{}\n", line.trim_end()))
        .collect()
}

/// Groups of a description under their titles.
pub fn groups(groups: &[Group], units: Units) -> String {
    let style = Style::brief(units);
    let mut text = String::new();
    for group in groups {
        let rows: Vec<(String, String)> = (group.rows.iter())
            .map(|row| (row.name.clone(), value(style, &row.value, &row.unit)))
            .collect();
        text += &format!("{}\n{}\n", heading(&group.title), pairs(&rows));
    }
    text.trim_end().to_owned()
}

fn value(style: Style, value: &Value, unit: &str) -> String {
    match value {
        Value::Number(number) => style.quantity(*number, unit),
        Value::Range(least, most) => {
            format!(
                "{} to {}",
                style.quantity(*least, unit),
                style.quantity(*most, unit)
            )
        }
        Value::Text(text) => text.clone(),
    }
}
