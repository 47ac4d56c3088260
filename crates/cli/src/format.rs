//! Numbers and tables for people.

use crate::print::heading;
use comfy_table::{CellAlignment, LineStyle, Table, TableStyle, presets};
use hertzchain_experiment::Units;
use hertzchain_study::{Group, Value};

/// Units that take prefixes.
const PREFIXED: [&str; 6] = ["s", "N", "m", "J", "Hz", "Pa"];

const PREFIXES: [(f64, &str); 8] = [
    (1e9, "G"),
    (1e6, "M"),
    (1e3, "k"),
    (1.0, ""),
    (1e-3, "m"),
    (1e-6, "µ"),
    (1e-9, "n"),
    (1e-12, "p"),
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
        self.scaled(value, unit, digits)
    }

    /// The same with all digits, zeros at the end too: they are known.
    pub fn exact(self, value: f64, unit: &str) -> String {
        self.scaled(value, unit, |value, digits| {
            format!("{value:.*}", decimals(value.abs(), digits))
        })
    }

    fn scaled(self, value: f64, unit: &str, write: impl Fn(f64, usize) -> String) -> String {
        if self.units == Units::Dimensionless || unit.is_empty() || unit == "1" {
            return write(value, self.digits);
        }
        let prefix = PREFIXES.iter().find(|(size, _)| value.abs() >= *size);
        match prefix {
            Some((size, prefix)) if PREFIXED.contains(&unit) && value.abs() < 1e12 => {
                format!("{} {prefix}{unit}", write(value / size, self.digits))
            }
            _ => format!("{} {unit}", write(value, self.digits)),
        }
    }
}

/// Decimals that give a number of this size so many significant digits.
fn decimals(size: f64, digits: usize) -> usize {
    let whole = if size > 0.0 && size.is_finite() {
        size.log10().floor() as i32 + 1
    } else {
        1
    };
    usize::try_from(digits as i32 - whole).unwrap_or(0).min(15)
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

/// Lines above, below and under the head.
const RULED: TableStyle = TableStyle::new()
    .top_border(LineStyle::none().fill('─').junction('─'))
    .header_separator(LineStyle::none().fill('─').junction('─'))
    .bottom_border(LineStyle::none().fill('─').junction('─'));

/// A table of numbers with a head.
pub fn table(head: &[String], rows: &[Vec<String>]) -> String {
    let mut table = Table::new();
    table.load_style(RULED);
    table.set_header(head.to_vec());
    for row in rows {
        table.add_row(row.clone());
    }
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Right);
    }
    trimmed(&table)
}

/// Numbers with the same decimals, so many that the largest has `digits`; a
/// dash where there is none.
pub fn column(values: &[Option<f64>], digits: usize) -> Vec<String> {
    let most = values
        .iter()
        .flatten()
        .fold(0.0_f64, |most, value| most.max(value.abs()));
    let decimals = decimals(most, digits);
    let cell = |value: &Option<f64>| value.map_or("–".to_owned(), |v| format!("{v:.decimals$}"));
    values.iter().map(cell).collect()
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
