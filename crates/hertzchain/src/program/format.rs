//! Numbers and tables for people.

use crate::program::heading;
use crate::quantity::decimals;
pub(crate) use crate::quantity::{Style, digits};
use comfy_table::{CellAlignment, LineStyle, Row, Table, TableStyle, presets};
use hertzchain_experiment::Units;
use hertzchain_sim::{Group, Row as Line, Value};
use std::fmt::Display;

/// Decimals beyond which an error is written with an exponent.
const MOST_DECIMALS: usize = 7;

/// A value and its error, both to the second digit of the error.
pub(crate) fn with_error(value: f64, error: f64) -> (String, String) {
    if !(error > 0.0 && error.is_finite()) {
        return (digits(value, 7), digits(error, 2));
    }
    // What the error is once rounded: 0.0996 has the digits of 0.10.
    let shown: f64 = format!("{error:.1e}").parse().unwrap_or(error);
    let place = 1 - shown.log10().floor() as i32;
    let decimals = usize::try_from(place).unwrap_or(0).min(15);
    let value = match place < 0 {
        true => {
            let step = 10_f64.powi(-place);
            format!("{}", (value / step).round() * step)
        }
        false => format!("{value:.decimals$}"),
    };
    // Nothing is less than 0 by less than a digit.
    let zero = value.parse() == Ok(0.0);
    let value = if zero { value.trim_start_matches('-').to_owned() } else { value };
    let error = match decimals > MOST_DECIMALS {
        true => format!("{shown:.1e}"),
        false => format!("{shown:.decimals$}"),
    };
    (value, error)
}

/// R², with as many digits as make two of 1 − R²; close to 1 as a difference
/// from it.
pub(crate) fn r_squared(value: f64) -> String {
    let rest = 1.0 - value;
    if rest <= ROUNDING {
        return "1".to_owned();
    }
    match 1 - rest.log10().floor() as i32 {
        place @ ..=6 => format!("{value:.*}", usize::try_from(place).unwrap_or(0)),
        _ => format!("1 − {rest:.1e}"),
    }
}

/// What sums of logarithms leave of a perfect fit.
const ROUNDING: f64 = 1e-13;

/// Rows of a name and a value, aligned.
pub(crate) fn pairs<T: Display>(rows: impl IntoIterator<Item = (T, String)>) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.add_rows(rows.into_iter().map(|(name, value)| [format!("  {name}"), value]));
    trimmed(&table)
}

/// Lines above, below and under the head.
const RULED: TableStyle = TableStyle::new()
    .top_border(LineStyle::none().fill('─').junction('─'))
    .header_separator(LineStyle::none().fill('─').junction('─'))
    .bottom_border(LineStyle::none().fill('─').junction('─'));

pub(crate) fn table<T: Into<Row>>(
    head: impl Into<Row>,
    rows: impl IntoIterator<Item = T>,
) -> String {
    let mut table = Table::new();
    table.load_style(RULED);
    table.set_header(head).add_rows(rows);
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Right);
    }
    trimmed(&table)
}

/// Numbers with the same decimals, so many that the largest has `digits`; a
/// dash where there is none.
pub(crate) fn column(values: &[Option<f64>], digits: usize) -> Vec<String> {
    let most = values.iter().flatten().fold(0.0_f64, |most, value| most.max(value.abs()));
    let decimals = decimals(most, digits);
    let cell = |value: &Option<f64>| value.map_or("–".to_owned(), |v| format!("{v:.decimals$}"));
    values.iter().map(cell).collect()
}

fn trimmed(table: &Table) -> String {
    let lines = table.to_string();
    lines.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}

pub(crate) fn groups(groups: &[Group], units: Units) -> String {
    let style = Style::brief(units);
    let mut text = String::new();
    for group in groups {
        let rows = group.rows.iter().map(|row| (&row.name, value(style, &row.value, &row.unit)));
        text += &format!("{}\n{}\n", heading(&group.title), pairs(rows));
    }
    text.trim_end().to_owned()
}

fn value(style: Style, value: &Value, unit: &str) -> String {
    match value {
        Value::Number(number) => style.quantity(*number, unit),
        Value::Range(least, most) => {
            format!("{} to {}", style.quantity(*least, unit), style.quantity(*most, unit))
        }
        Value::Count(count) if unit.is_empty() => count.to_string(),
        Value::Count(count) => format!("{count} {unit}"),
        Value::Text(text) => text.clone(),
        Value::Parts(parts) => {
            let words: Vec<String> = parts.iter().map(|part| self::part(style, part)).collect();
            words.join(", ")
        }
    }
}

/// One of several numbers in a line has its name before it; words speak for
/// themselves.
fn part(style: Style, part: &Line) -> String {
    let value = value(style, &part.value, &part.unit);
    match part.value {
        Value::Text(_) => value,
        _ => format!("{} {value}", part.name),
    }
}

#[cfg(test)]
#[path = "tests/format.rs"]
mod tests;
