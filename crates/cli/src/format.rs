//! Numbers and tables for people.

use crate::print::heading;
use comfy_table::{CellAlignment, LineStyle, Table, TableStyle, presets};
use hertzchain_experiment::Units;
use hertzchain_study::{Group, Row, Value, dimensionless_unit};

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
        let unit = match self.units {
            Units::Si => unit,
            Units::Dimensionless => dimensionless_unit(unit),
        };
        if unit.is_empty() || unit == "1" {
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

/// Decimals beyond which an error is written with an exponent.
const MOST_DECIMALS: usize = 7;

/// A value and its error, both to the second digit of the error.
pub fn with_error(value: f64, error: f64) -> (String, String) {
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
    let error = match decimals > MOST_DECIMALS {
        true => format!("{shown:.1e}"),
        false => format!("{shown:.decimals$}"),
    };
    (value, error)
}

/// R², with as many digits as make two of 1 − R²; close to 1 as a difference
/// from it.
pub fn r_squared(value: f64) -> String {
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
fn part(style: Style, part: &Row) -> String {
    let value = value(style, &part.value, &part.unit);
    match part.value {
        Value::Text(_) => value,
        _ => format!("{} {value}", part.name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(value: f64, error: f64) -> String {
        let (value, error) = with_error(value, error);
        format!("{value} ± {error}")
    }

    #[test]
    fn values_end_where_their_errors_do() {
        assert_eq!(pair(686.612_934, 4.7123), "686.6 ± 4.7");
        assert_eq!(pair(630.841_591_2, 6.31e-4), "630.84159 ± 0.00063");
        assert_eq!(pair(-0.199_999_999_7, 2.62e-10), "-0.19999999970 ± 2.6e-10");
        assert_eq!(pair(686.612_934, 0.0996), "686.61 ± 0.10");
        assert_eq!(pair(686.612_934, 47.4), "687 ± 47");
        assert_eq!(pair(6866.129, 474.0), "6870 ± 470");
    }

    #[test]
    fn r_squared_shows_two_digits_of_what_is_left() {
        assert_eq!(r_squared(0.998_758_344), "0.9988");
        assert_eq!(r_squared(0.87), "0.87");
        assert_eq!(r_squared(1.0 - 2.04e-9), "1 − 2.0e-9");
        assert_eq!(r_squared(1.0 - 1e-15), "1");
    }

    #[test]
    fn counts_keep_their_word_where_nothing_else_has_a_unit() {
        let style = Style::brief(Units::Dimensionless);
        assert_eq!(style.quantity(0.84, "beads/s"), "0.84 beads per unit time");
        assert_eq!(style.quantity(5.0, "beads"), "5 beads");
        assert_eq!(style.quantity(5.0, "m/s"), "5");
    }
}
