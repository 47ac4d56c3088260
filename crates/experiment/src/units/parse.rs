//! Unit expressions: "N/m^(3/2)", "kg s/m²", "N s m^-1".

use super::symbols::{self, Symbol};
use super::{Exponent, Unit, UnitError};
use num_rational::Ratio;
use num_traits::{CheckedAdd, CheckedMul};
use std::ops::Range;

/// Parentheses deeper than this are a mistake, and would cost stack.
const DEEPEST: usize = 16;

/// Reads a unit.
///
/// Factors are joined by a space, `*` or `·`; `/` divides by the one factor
/// after it, and a product after it needs parentheses ("N/(m s)"), since
/// "N/m s" is read in two ways by people.
///
/// # Errors
/// Unknown symbols, malformed exponents, ambiguous products.
pub fn parse_unit(text: &str) -> Result<Unit, UnitError> {
    let mut reader = Reader { text, at: 0 };
    let unit = reader.product(0)?;
    match reader.peek() {
        None => Ok(unit),
        Some(c) => Err(reader.here(format!("`{c}` is not expected in a unit"))),
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
}

impl Reader<'_> {
    fn rest(&self) -> &str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn skip_spaces(&mut self) {
        let rest = self.rest();
        self.at += rest.len() - rest.trim_start().len();
    }

    fn peek(&mut self) -> Option<char> {
        self.skip_spaces();
        self.rest().chars().next()
    }

    fn take(&mut self, c: char) -> bool {
        let found = self.peek() == Some(c);
        self.at += if found { c.len_utf8() } else { 0 };
        found
    }

    /// An error at the next character.
    fn here(&self, what: impl Into<String>) -> UnitError {
        let length = self.rest().chars().next().map_or(0, char::len_utf8);
        UnitError::new(what, self.at..self.at + length)
    }

    fn product(&mut self, depth: usize) -> Result<Unit, UnitError> {
        let mut unit = self.power(depth)?;
        let mut divided = false;
        loop {
            let start = self.at;
            match self.peek() {
                None | Some(')') => return Ok(unit),
                Some('/') => {
                    self.at += 1;
                    divided = true;
                    let divisor = self.power(depth)?;
                    unit = self.joined(unit, divisor, -1, start)?;
                }
                Some(c) => {
                    if matches!(c, '*' | '·' | '⋅') {
                        self.at += c.len_utf8();
                    }
                    let factor = self.power(depth)?;
                    if divided {
                        return Err(self.ambiguous(start));
                    }
                    unit = self.joined(unit, factor, 1, start)?;
                }
            }
        }
    }

    fn ambiguous(&self, start: usize) -> UnitError {
        let what = format!(
            "`{}` can be read in two ways: put the divisor in parentheses, as in N/(m s)",
            self.text.trim()
        );
        UnitError::new(what, start..self.at)
    }

    fn power(&mut self, depth: usize) -> Result<Unit, UnitError> {
        let base = self.atom(depth)?;
        let start = self.at;
        match self.exponent()? {
            None => Ok(base),
            Some(exponent) => raised(base, exponent).ok_or_else(|| self.too_large(start)),
        }
    }

    fn joined(&self, a: Unit, b: Unit, sign: i64, start: usize) -> Result<Unit, UnitError> {
        let b = raised(b, Ratio::from_integer(sign));
        b.and_then(|b| multiplied(a, b))
            .ok_or_else(|| self.too_large(start))
    }

    fn too_large(&self, start: usize) -> UnitError {
        UnitError::new("the unit's exponents are too large", start..self.at)
    }

    fn atom(&mut self, depth: usize) -> Result<Unit, UnitError> {
        if self.take('(') {
            if depth == DEEPEST {
                return Err(self.here("too many parentheses"));
            }
            let inner = self.product(depth + 1)?;
            return match self.take(')') {
                true => Ok(inner),
                false => Err(self.here("a closing parenthesis is missing")),
            };
        }
        if self.peek() == Some('1') {
            self.at += 1;
            return Ok(Unit::ONE);
        }
        self.symbol()
    }

    fn symbol(&mut self) -> Result<Unit, UnitError> {
        self.skip_spaces();
        let belongs = |c: &char| c.is_alphabetic() || matches!(c, '°' | '%' | 'µ');
        let name: String = self.rest().chars().take_while(belongs).collect();
        if name.is_empty() {
            return Err(match self.rest().is_empty() {
                true => self.here("a unit is missing"),
                false => self.here(format!("`{}` is not a unit", self.rest().trim())),
            });
        }
        let place = self.at..self.at + name.len();
        self.at = place.end;
        let (symbol, tens) = symbols::find(&name).ok_or_else(|| unknown(&name, place))?;
        Ok(single(symbol, tens))
    }

    /// "^2", "^-1.5", "^(3/2)", "**2", "²", or nothing.
    fn exponent(&mut self) -> Result<Option<Exponent>, UnitError> {
        if let Some(power) = self.superscript() {
            return Ok(Some(power));
        }
        if self.rest().starts_with("**") {
            self.at += 2;
        } else if !self.take('^') {
            return Ok(None);
        }
        let bracketed = self.take('(');
        let mut power = self.number()?;
        if bracketed && self.take('/') {
            let divisor = self.number()?;
            power = match *divisor.numer() == 0 {
                true => return Err(self.here("an exponent is divided by 0")),
                false => power
                    .checked_mul(&divisor.recip())
                    .ok_or_else(|| self.here("the exponent is too large"))?,
            };
        }
        if bracketed && !self.take(')') {
            return Err(self.here("a closing parenthesis is missing"));
        }
        Ok(Some(power))
    }

    /// A decimal number as an exact ratio.
    fn number(&mut self) -> Result<Exponent, UnitError> {
        self.skip_spaces();
        let belongs = |c: &char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+');
        let text: String = self.rest().chars().take_while(belongs).collect();
        let found = ratio(&text).ok_or_else(|| {
            let place = self.at..self.at + text.len().max(1);
            UnitError::new("an exponent such as 2, -1, 1.5 or (3/2) is missing", place)
        })?;
        self.at += text.len();
        Ok(found)
    }

    fn superscript(&mut self) -> Option<Exponent> {
        const DIGITS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
        let belongs = |c: &char| *c == '⁻' || DIGITS.contains(*c);
        let text: String = self.rest().chars().take_while(belongs).collect();
        let plain: String = text
            .chars()
            .filter_map(|c| match DIGITS.chars().position(|d| d == c) {
                Some(digit) => char::from_digit(u32::try_from(digit).ok()?, 10),
                None => Some('-'),
            })
            .collect();
        let power = ratio(&plain)?;
        self.at += text.len();
        Some(power)
    }
}

/// "-1.5" as −3/2; `None` if malformed or too long.
fn ratio(text: &str) -> Option<Exponent> {
    let (whole, fraction) = text.split_once('.').unwrap_or((text, ""));
    let digits = format!("{whole}{fraction}");
    let numerator = digits.parse::<i64>().ok()?;
    let denominator = 10i64.checked_pow(u32::try_from(fraction.len()).ok()?)?;
    (numerator != i64::MIN).then(|| Ratio::new(numerator, denominator))
}

fn unknown(name: &str, place: Range<usize>) -> UnitError {
    let hint = symbols::nearest(name).map_or(String::new(), |n| format!("; did you mean `{n}`?"));
    UnitError::new(format!("`{name}` is not a known unit{hint}"), place)
}

fn single(symbol: &Symbol, prefix_tens: i64) -> Unit {
    Unit {
        dimension: symbol.dimension,
        tens: Ratio::from_integer(symbol.tens + prefix_tens),
        numerator: symbol.numerator,
        denominator: 1,
        rest: symbol.rest,
    }
}

/// `None` when an exponent overflows.
fn multiplied(a: Unit, b: Unit) -> Option<Unit> {
    let unit = Unit {
        dimension: a.dimension.times(b.dimension)?,
        tens: a.tens.checked_add(&b.tens)?,
        numerator: a.numerator.checked_mul(b.numerator)?,
        denominator: a.denominator.checked_mul(b.denominator)?,
        rest: a.rest * b.rest,
    };
    within_reach(unit)
}

/// `None` when an exponent overflows.
fn raised(unit: Unit, exponent: Exponent) -> Option<Unit> {
    let power = *exponent.numer() as f64 / *exponent.denom() as f64;
    let dimension = unit.dimension.power(exponent)?;
    let tens = unit.tens.checked_mul(&exponent)?;
    let rest = if unit.rest == 1.0 {
        1.0
    } else {
        unit.rest.powf(power)
    };
    let whole = exponent.is_integer().then(|| exponent.to_integer());
    let exact = whole.and_then(|n| {
        let size = u32::try_from(n.unsigned_abs()).ok()?;
        let (up, down) = (
            unit.numerator.checked_pow(size)?,
            unit.denominator.checked_pow(size)?,
        );
        Some(if n < 0 { (down, up) } else { (up, down) })
    });
    let (numerator, denominator, extra) = match exact {
        Some((up, down)) => (up, down, 1.0),
        None => (
            1,
            1,
            (unit.numerator as f64 / unit.denominator as f64).powf(power),
        ),
    };
    within_reach(Unit {
        dimension,
        tens,
        numerator,
        denominator,
        rest: rest * extra,
    })
}

/// Powers of ten beyond any quantity, or an infinite size, are refused.
fn within_reach(unit: Unit) -> Option<Unit> {
    let (above, below) = (*unit.tens.numer() as f64, *unit.tens.denom() as f64);
    let small = (above / below).abs() < 1e4 && above.abs() < 1e15 && below < 1e15;
    (small && unit.rest.is_finite()).then_some(unit)
}
