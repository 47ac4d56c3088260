//! Numbers with their units, for people.

use hertzchain_experiment::Units;
use hertzchain_sim::dimensionless_unit;

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

#[derive(Clone, Copy, Debug)]
pub(crate) struct Style {
    /// Significant digits.
    pub(crate) digits: usize,
    /// Whether numbers have units.
    pub(crate) units: Units,
}

impl Style {
    /// Digits that an accuracy is worth, one to spare.
    pub(crate) fn of_accuracy(accuracy: f64, units: Units) -> Self {
        let digits = (-accuracy.log10()).ceil().clamp(3.0, 15.0) as usize + 1;
        Self { digits, units }
    }

    /// A few digits, for what need not be exact.
    pub(crate) fn brief(units: Units) -> Self {
        Self { digits: 6, units }
    }

    /// A number with its unit, with a prefix where that is usual.
    pub(crate) fn quantity(self, value: f64, unit: &str) -> String {
        self.scaled(value, unit, digits)
    }

    /// The same with all digits, zeros at the end too: they are known.
    pub(crate) fn exact(self, value: f64, unit: &str) -> String {
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
pub(crate) fn decimals(size: f64, digits: usize) -> usize {
    let whole = if size > 0.0 && size.is_finite() { size.log10().floor() as i32 + 1 } else { 1 };
    usize::try_from(digits as i32 - whole).unwrap_or(0).min(15)
}

/// A number with so many significant digits, trailing zeros dropped.
pub(crate) fn digits(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits.saturating_sub(1));
    let number: f64 = rounded.parse().unwrap_or(value);
    match number.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e7).contains(&size) => format!("{number}"),
        _ => format!("{number:e}"),
    }
}

#[cfg(test)]
#[path = "tests/quantity.rs"]
mod tests;
