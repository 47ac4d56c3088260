//! Quantities in text, "6.35 mm", and what they are in SI.
//!
//! A quantity is a decimal number and a unit; a unit is a product of prefixed
//! symbols with rational exponents, "N/m^(3/2)". Powers of ten are moved into
//! the decimal text before it becomes binary, so "6.35 mm" is the `f64`
//! nearest to 0.00635.

mod decimal;
mod dimension;
mod parse;
mod symbols;

pub use dimension::Dimension;
pub use parse::parse_unit;

pub(crate) use decimal::with_decimal_point;

use decimal::Decimal;
use num_rational::Ratio;
use std::ops::Range;

/// A rational exponent.
pub type Exponent = Ratio<i64>;

/// A number with its dimension, in SI base units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// Value in SI base units.
    pub value: f64,
    /// Powers of metre, kilogram, second and radian.
    pub dimension: Dimension,
    /// Half a unit of the last digit written, in SI base units.
    pub half_digit: f64,
}

/// What is wrong with a quantity's text, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what}")]
pub struct UnitError {
    /// What is wrong, and what was expected.
    pub what: String,
    /// Where in the text, in bytes.
    pub at: Range<usize>,
}

impl UnitError {
    pub(crate) fn new(what: impl Into<String>, at: Range<usize>) -> Self {
        Self {
            what: what.into(),
            at,
        }
    }
}

/// A unit: its dimension and its size in SI base units.
///
/// The size is 10^`tens` · `numerator` / `denominator` · `rest`, kept apart so
/// that only what has to be rounded is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Powers of metre, kilogram, second and radian.
    pub dimension: Dimension,
    tens: Exponent,
    numerator: u64,
    denominator: u64,
    rest: f64,
}

impl Unit {
    /// The unit of plain numbers.
    pub const ONE: Self = Self {
        dimension: Dimension::NONE,
        tens: Ratio::new_raw(0, 1),
        numerator: 1,
        denominator: 1,
        rest: 1.0,
    };

    /// Size in SI base units.
    pub fn size(&self) -> f64 {
        self.convert(Decimal::ONE)
    }

    /// A decimal number of this unit in SI base units.
    fn convert(&self, number: &Decimal) -> f64 {
        let whole = self.tens.floor().to_integer();
        let fraction = self.tens - self.tens.floor();
        let mut rest = self.rest;
        if fraction != Ratio::new_raw(0, 1) {
            let power = *fraction.numer() as f64 / *fraction.denom() as f64;
            rest *= 10f64.powf(power);
        }
        number.times(self.numerator, whole) / self.denominator as f64 * rest
    }
}

/// Reads a quantity: a number, then a unit (none for a plain number).
///
/// ```
/// let radius = hertzchain_experiment::units::parse_quantity("6.35 mm")?;
/// assert_eq!(radius.value, 0.00635);
/// # Ok::<(), hertzchain_experiment::units::UnitError>(())
/// ```
///
/// # Errors
/// When the text has no leading number, an unknown unit, an ambiguous one, or
/// a value that is not finite.
pub fn parse_quantity(text: &str) -> Result<Quantity, UnitError> {
    let (number, length) = Decimal::read(text)?;
    let unit_text = text.get(length..).unwrap_or_default();
    let unit = if unit_text.trim().is_empty() {
        Unit::ONE
    } else {
        parse_unit(unit_text)
            .map_err(|e| UnitError::new(e.what, e.at.start + length..e.at.end + length))?
    };
    let value = unit.convert(&number);
    if value.is_finite() {
        let half_digit = unit.convert(&number.half_digit());
        Ok(Quantity {
            value,
            dimension: unit.dimension,
            half_digit,
        })
    } else {
        let what = format!("`{}` is too large a number", text.trim());
        Err(UnitError::new(what, 0..text.len()))
    }
}

/// Returns the number of a text in SI: plain, or with any unit of the dimension of `unit`.
///
/// ```
/// use hertzchain_experiment::units::parse_in;
/// assert_eq!(parse_in("0.7mm/s", "m/s")?, 0.0007);
/// assert_eq!(parse_in("2", "m/s")?, 2.0);
/// assert!(parse_in("2 kg", "m/s").is_err());
/// # Ok::<(), hertzchain_experiment::units::UnitError>(())
/// ```
///
/// # Errors
/// Those of [`parse_quantity`], and a unit of another dimension.
pub fn parse_in(text: &str, unit: &str) -> Result<f64, UnitError> {
    let quantity = parse_quantity(text)?;
    let expected = parse_unit(unit).map_or(Dimension::NONE, |unit| unit.dimension);
    let fits = |dimension: Dimension| quantity.dimension.agrees_with(&dimension);
    if fits(Dimension::NONE) || fits(expected) {
        return Ok(quantity.value);
    }
    let (found, wanted) = (quantity.dimension.name(), expected.name());
    let what = format!(
        "`{}` is {found}, not {wanted} such as \"{}\"",
        text.trim(),
        expected.example()
    );
    Err(UnitError::new(what, 0..text.len()))
}
