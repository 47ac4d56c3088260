//! Quantities in text, "6.35 mm", and what they are in SI.
//!
//! A quantity is a decimal number and a unit; a unit is a product of prefixed
//! symbols with exponents, "N/m^(3/2)". Powers of ten are moved into the
//! decimal text before it becomes binary, so "6.35 mm" is the `f64` nearest to
//! 0.00635.

use crate::report::nearest_word;
use std::f64::consts::PI;
use std::fmt;
use std::ops::Range;

/// A number with its dimension, in SI base units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// Value in SI base units.
    pub value: f64,
    /// Powers of the base units.
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
    fn new(what: impl Into<String>, at: Range<usize>) -> Self {
        let what = what.into();
        Self { what, at }
    }
}

/// Powers of metre, kilogram, second, radian, ampere and kelvin.
///
/// The radian counts as a base unit here, so that an angle without its unit,
/// or a frequency in rad/s, is a mistake and not a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dimension([f64; 6]);

/// Base units in the order in which they are printed, with their index.
const BASE: [(&str, usize); 6] = [("kg", 1), ("m", 0), ("s", 2), ("rad", 3), ("A", 4), ("K", 5)];

/// Common dimensions: name, SI unit, an example.
static NAMES: &[(&str, &str, &str)] = &[
    ("a plain number", "1", "0.3"),
    ("a length", "m", "6.35 mm"),
    ("a mass", "kg", "8.54 g"),
    ("a time", "s", "10 us"),
    ("an angle", "rad", "0.5 deg"),
    ("a speed", "m/s", "0.5 m/s"),
    ("an acceleration", "m/s^2", "9.80665 m/s^2"),
    ("a force", "N", "0.24 N"),
    ("a pressure", "Pa", "213 GPa"),
    ("a density", "kg/m^3", "7.96 g/cm^3"),
    ("a dynamic viscosity", "Pa s", "32 kPa s"),
    ("a kinematic viscosity", "m^2/s", "55 cSt"),
    ("a frequency", "Hz", "5 kHz"),
    ("an energy", "J", "1 mJ"),
    ("a stiffness or a surface tension", "N/m", "100 N/m"),
    ("a damping constant", "N s/m", "1e-3 N s/m"),
    ("a Hertz stiffness", "N/m^(3/2)", "8.79e9 N/m^(3/2)"),
    ("a cubic damping", "kg s/m^2", "77 kg s/m^2"),
    ("a viscoelastic damping", "N s/m^(3/2)", "4.5e3 N s/m^(3/2)"),
    ("an area", "m^2", "1 mm^2"),
    ("a volume", "m^3", "1 ml"),
    ("a voltage", "V", "10 V"),
    ("a charge", "C", "100 pC"),
    ("a charge sensitivity", "C/N", "20 pC/N"),
    ("a charge amplification", "V/C", "1 mV/pC"),
    ("a temperature", "K", "25 degC"),
    ("a pressure–viscosity coefficient", "1/Pa", "16 1/GPa"),
];

impl Dimension {
    /// Plain numbers.
    pub const NONE: Self = Self([0.0; 6]);

    fn times(self, other: Self, power: f64) -> Self {
        let mut out = self.0;
        for (own, other) in out.iter_mut().zip(other.0) {
            *own += power * other;
        }
        Self(out)
    }

    /// Whether two dimensions agree. Exponents may come from a user's decimal
    /// ("n = 1.3333333"), hence the margin.
    pub fn agrees_with(&self, other: &Self) -> bool {
        let mut pairs = self.0.iter().zip(&other.0);
        pairs.all(|(a, b)| (a - b).abs() < 1e-6)
    }

    /// "a length", or the SI unit where there is no common name.
    pub fn name(&self) -> String {
        let found = self.common_name().map(str::to_owned);
        found.unwrap_or_else(|| format!("a quantity in {self}"))
    }

    /// "a length"; `None` where there is no common name.
    pub(crate) fn common_name(&self) -> Option<&'static str> {
        self.common().map(|(name, _, _)| *name)
    }

    /// A quantity of this dimension, as an example.
    pub(crate) fn example(&self) -> String {
        let found = self.common().map(|(_, _, example)| (*example).to_owned());
        found.unwrap_or_else(|| format!("1 {self}"))
    }

    fn common(&self) -> Option<&'static (&'static str, &'static str, &'static str)> {
        let agrees = |unit: &str| parse_unit(unit).is_ok_and(|u| u.dimension.agrees_with(self));
        NAMES.iter().find(|(_, unit, _)| agrees(unit))
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let power = |(unit, at): (&str, usize)| match self.0[at] {
            0.0 => None,
            1.0 => Some(unit.to_owned()),
            n if (2.0 * n).fract() == 0.0 && n.fract() != 0.0 => {
                Some(format!("{unit}^({}/2)", 2.0 * n))
            }
            n => Some(format!("{unit}^{n}")),
        };
        let parts: Vec<String> = BASE.into_iter().filter_map(power).collect();
        f.write_str(if parts.is_empty() { "1" } else { "" })?;
        f.write_str(&parts.join(" "))
    }
}

/// A unit: its dimension and its size in SI base units.
///
/// The size is 10^`tens` · `up` / `down`, kept apart so that only what has to
/// be rounded is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Powers of the base units.
    pub dimension: Dimension,
    tens: f64,
    up: f64,
    down: f64,
}

impl Unit {
    /// The unit of plain numbers.
    pub(crate) const ONE: Self = Self { dimension: Dimension::NONE, tens: 0.0, up: 1.0, down: 1.0 };

    /// A decimal number of this unit in SI base units.
    fn convert(&self, number: &Decimal) -> f64 {
        let whole = self.tens.floor();
        let size = number.times(self.up, whole as i64) / self.down;
        match self.tens - whole {
            0.0 => size,
            fraction => size * 10f64.powf(fraction),
        }
    }

    /// Self · other^power; `None` for powers of ten beyond any quantity.
    fn times(self, other: Self, power: f64) -> Option<Self> {
        let [up, down] = match power < 0.0 {
            true => [other.down, other.up],
            false => [other.up, other.down],
        };
        let unit = Self {
            dimension: self.dimension.times(other.dimension, power),
            tens: self.tens + power * other.tens,
            up: self.up * up.powf(power.abs()),
            down: self.down * down.powf(power.abs()),
        };
        let exponents = unit.dimension.0.iter().all(|power| power.abs() < 1e15);
        let sizes = unit.tens.abs() < 1e4 && unit.up.is_finite() && unit.down.is_finite();
        (exponents && sizes).then_some(unit)
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
    // A scale with another zero is no factor: it stands alone.
    let (unit_text, zero) = match unit_text.trim() {
        "degC" | "°C" => ("K", 273.15),
        _ => (unit_text, 0.0),
    };
    let unit = match unit_text.trim().is_empty() {
        true => Unit::ONE,
        false => parse_unit(unit_text)
            .map_err(|e| UnitError::new(e.what, e.at.start + length..e.at.end + length))?,
    };
    let value = unit.convert(&number) + zero;
    if !value.is_finite() {
        let what = format!("`{}` is too large a number", text.trim());
        return Err(UnitError::new(what, 0..text.len()));
    }
    Ok(Quantity {
        value,
        dimension: unit.dimension,
        half_digit: unit.convert(&number.half_digit()),
    })
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
    let is_share = text.trim_end().ends_with('%');
    if (fits(Dimension::NONE) && !is_share) || fits(expected) {
        return Ok(quantity.value);
    }
    let (found, wanted) = (quantity.dimension.name(), expected.name());
    let (text, example) = (text.trim(), expected.example());
    let what = format!("`{text}` is {found}, not {wanted} such as \"{example}\"");
    Err(UnitError::new(what, 0..text.len()))
}

/// ± digits · 10^exponent.
struct Decimal {
    negative: bool,
    digits: String,
    exponent: i64,
}

impl Decimal {
    /// Reads the number at the start of a text and returns how many bytes it took.
    fn read(text: &str) -> Result<(Self, usize), UnitError> {
        let start = text.len() - text.trim_start().len();
        let bytes = text.as_bytes();
        let signed = |at| usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
        let whole = digits(text, start + signed(start));
        let mut end = start + signed(start) + whole.len();
        let mut fraction = "";
        if bytes.get(end) == Some(&b'.') {
            fraction = digits(text, end + 1);
            end += 1 + fraction.len();
        }
        if whole.is_empty() && fraction.is_empty() {
            return Err(no_number(text, start));
        }
        if let Some(better) = with_decimal_point(text) {
            let thousands = or_thousands(text);
            let what = format!("a comma is no decimal mark: write {better}{thousands}");
            return Err(UnitError::new(what, start..text.len()));
        }
        let mut power = 0;
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let figures = digits(text, end + 1 + signed(end + 1));
            let length = 1 + signed(end + 1) + figures.len();
            if !figures.is_empty() {
                let size: Option<i64> = figures.parse().ok().filter(|p| *p <= 1_000_000);
                let too_large = "the power of ten is too large";
                power = size.ok_or_else(|| UnitError::new(too_large, end..end + length))?;
                power *= if bytes.get(end + 1) == Some(&b'-') { -1 } else { 1 };
                end += length;
            }
        }
        let number = Self {
            negative: bytes.get(start) == Some(&b'-'),
            digits: format!("{whole}{fraction}"),
            exponent: power - fraction.len() as i64,
        };
        Ok((number, end))
    }

    /// Half a unit of the last digit: 0.005 for 6.35.
    fn half_digit(&self) -> Self {
        Self { negative: false, digits: "5".to_owned(), exponent: self.exponent - 1 }
    }

    /// This number · factor · 10^tens, rounded once where the digits and the factor are whole
    /// and their product fits into 128 bits.
    fn times(&self, factor: f64, tens: i64) -> f64 {
        let whole = (factor.fract() == 0.0 && factor < 1e15).then_some(factor as u128);
        let digits = self.digits.parse::<u128>().ok();
        let exact = digits.zip(whole).and_then(|(d, w)| d.checked_mul(w));
        // Correctly rounded by the standard library.
        let scientific = |digits: &str| {
            let number = format!("{digits}e{}", self.exponent.saturating_add(tens));
            number.parse().unwrap_or(f64::NAN)
        };
        let size = match exact {
            Some(product) => scientific(&product.to_string()),
            None => scientific(&self.digits) * factor,
        };
        if self.negative { -size } else { size }
    }
}

/// The run of digits that starts at a byte.
fn digits(text: &str, from: usize) -> &str {
    let rest = text.get(from..).unwrap_or_default();
    let end = rest.bytes().take_while(u8::is_ascii_digit).count();
    rest.get(..end).unwrap_or_default()
}

/// "6,35 mm" as "6.35 mm"; `None` where no comma stands between digits.
pub(crate) fn with_decimal_point(text: &str) -> Option<String> {
    let (whole, rest) = text.trim().split_once(',')?;
    let figures = whole.trim_start_matches(['+', '-']);
    let number = !figures.is_empty() && digits(figures, 0).len() == figures.len();
    (number && !digits(rest, 0).is_empty()).then(|| format!("{whole}.{rest}"))
}

/// A comma before three digits may have meant thousands.
fn or_thousands(text: &str) -> String {
    let (whole, rest) = text.trim().split_once(',').unwrap_or_default();
    match digits(rest, 0).len() {
        3 if whole != "0" => format!(", or {whole}{rest} if that was meant"),
        _ => String::new(),
    }
}

fn no_number(text: &str, start: usize) -> UnitError {
    let trimmed = text.trim();
    let first = trimmed.split_whitespace().next().unwrap_or_default();
    let first = first.trim_start_matches(['+', '-']).to_lowercase();
    let what = match first.as_str() {
        "nan" | "inf" | "infinity" => format!("`{trimmed}` is not a finite number"),
        "" => "a number is missing".to_owned(),
        dash if dash.starts_with(['−', '–', '—']) => {
            format!("`{trimmed}` begins with a dash: write the minus sign of the keyboard, -")
        }
        _ => format!("`{trimmed}` does not start with a number"),
    };
    UnitError::new(what, start..text.len())
}

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
    let mut reader = UnitReader { text, at: 0 };
    let unit = reader.product(0)?;
    match reader.peek() {
        None => Ok(unit),
        Some(c) => Err(reader.here(format!("`{c}` is not expected in a unit"))),
    }
}

struct UnitReader<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> UnitReader<'a> {
    fn rest(&self) -> &'a str {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// The next character that is no space.
    fn peek(&mut self) -> Option<char> {
        self.at += self.rest().len() - self.rest().trim_start().len();
        self.rest().chars().next()
    }

    fn take(&mut self, c: char) -> bool {
        let found = self.peek() == Some(c);
        self.at += if found { c.len_utf8() } else { 0 };
        found
    }

    fn take_while(&self, belongs: impl Fn(char) -> bool) -> &'a str {
        let end = self.rest().find(|c| !belongs(c));
        self.rest().get(..end.unwrap_or(self.rest().len())).unwrap_or_default()
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
            let sign = match self.peek() {
                None | Some(')') => return Ok(unit),
                Some('/') => {
                    self.at += 1;
                    divided = true;
                    -1.0
                }
                Some(c) => {
                    let joins = matches!(c, '*' | '·' | '⋅');
                    self.at += if joins { c.len_utf8() } else { 0 };
                    1.0
                }
            };
            let factor = self.power(depth)?;
            if divided && sign > 0.0 {
                let text = self.text.trim();
                let what = format!(
                    "`{text}` can be read in two ways: put the divisor in parentheses, as in N/(m s)"
                );
                return Err(UnitError::new(what, start..self.at));
            }
            unit = self.joined(unit, factor, sign, start)?;
        }
    }

    fn joined(&self, unit: Unit, by: Unit, power: f64, start: usize) -> Result<Unit, UnitError> {
        let too_large = || UnitError::new("the unit's exponents are too large", start..self.at);
        unit.times(by, power).ok_or_else(too_large)
    }

    fn power(&mut self, depth: usize) -> Result<Unit, UnitError> {
        let base = self.atom(depth)?;
        let start = self.at;
        match self.exponent()? {
            None => Ok(base),
            Some(exponent) => self.joined(Unit::ONE, base, exponent, start),
        }
    }

    fn atom(&mut self, depth: usize) -> Result<Unit, UnitError> {
        if self.take('(') {
            if depth == DEEPEST {
                return Err(self.here("too many parentheses"));
            }
            let inner = self.product(depth + 1)?;
            return self.closed().map(|()| inner);
        }
        if self.take('1') {
            return Ok(Unit::ONE);
        }
        self.peek();
        let name = self.take_while(|c| c.is_alphabetic() || matches!(c, '°' | '%' | 'µ'));
        if name.is_empty() {
            return Err(match self.rest().is_empty() {
                true => self.here("a unit is missing"),
                false => self.here(format!("`{}` is not a unit", self.rest().trim())),
            });
        }
        let place = self.at..self.at + name.len();
        self.at = place.end;
        find_symbol(name).ok_or_else(|| {
            let near = nearest_symbol(name);
            let hint = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            UnitError::new(format!("`{name}` is not a known unit{hint}"), place)
        })
    }

    fn closed(&mut self) -> Result<(), UnitError> {
        let found = self.take(')').then_some(());
        found.ok_or_else(|| self.here("a closing parenthesis is missing"))
    }

    /// "^2", "^-1.5", "^(3/2)", "**2", "²", or nothing.
    fn exponent(&mut self) -> Result<Option<f64>, UnitError> {
        const RAISED: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
        let raised = self.take_while(|c| c == '⁻' || RAISED.contains(c));
        let digit = |c| RAISED.chars().position(|d| d == c);
        let plain = raised.chars().map(|c| digit(c).map_or("-".to_owned(), |d| d.to_string()));
        if let Some(power) = exponent_of(&plain.collect::<String>()) {
            self.at += raised.len();
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
            if divisor == 0.0 {
                return Err(self.here("an exponent is divided by 0"));
            }
            power /= divisor;
        }
        if bracketed {
            self.closed()?;
        }
        Ok(Some(power))
    }

    fn number(&mut self) -> Result<f64, UnitError> {
        self.peek();
        let text = self.take_while(|c| c.is_ascii_digit() || matches!(c, '.' | '-' | '+'));
        let found = exponent_of(text).ok_or_else(|| {
            let place = self.at..self.at + text.len().max(1).min(self.rest().len());
            UnitError::new("an exponent such as 2, -1, 1.5 or (3/2) is missing", place)
        })?;
        self.at += text.len();
        Ok(found)
    }
}

fn exponent_of(text: &str) -> Option<f64> {
    text.parse().ok().filter(|power: &f64| power.abs() < 1e15)
}

/// One unit symbol; its size is factor · 10^tens in SI base units.
struct Symbol {
    text: &'static str,
    prefixable: bool,
    factor: f64,
    tens: i8,
    powers: [i8; 5],
    kelvin: i8,
}

/// A symbol whose size is a power of ten, and which may have a prefix.
const fn si(text: &'static str, tens: i8, powers: [i8; 5]) -> Symbol {
    Symbol { prefixable: true, ..other(text, 1.0, tens, powers) }
}

const fn other(text: &'static str, factor: f64, tens: i8, powers: [i8; 5]) -> Symbol {
    Symbol { text, prefixable: false, factor, tens, powers, kelvin: 0 }
}

const LENGTH: [i8; 5] = [1, 0, 0, 0, 0];
const TIME: [i8; 5] = [0, 0, 1, 0, 0];
const ANGLE: [i8; 5] = [0, 0, 0, 1, 0];
const DEGREE: f64 = PI / 180.0;

/// Every unit symbol; the powers are those of m, kg, s, rad, A.
static SYMBOLS: &[Symbol] = &[
    si("m", 0, LENGTH),
    si("g", -3, [0, 1, 0, 0, 0]),
    si("s", 0, TIME),
    si("rad", 0, ANGLE),
    si("N", 0, [1, 1, -2, 0, 0]),
    si("Pa", 0, [-1, 1, -2, 0, 0]),
    si("J", 0, [2, 1, -2, 0, 0]),
    si("W", 0, [2, 1, -3, 0, 0]),
    si("Hz", 0, [0, 0, -1, 0, 0]),
    si("bar", 5, [-1, 1, -2, 0, 0]),
    si("l", -3, [3, 0, 0, 0, 0]),
    si("L", -3, [3, 0, 0, 0, 0]),
    si("P", -1, [-1, 1, -1, 0, 0]),
    si("St", -4, [2, 0, -1, 0, 0]),
    si("dyn", -5, [1, 1, -2, 0, 0]),
    si("A", 0, [0, 0, 0, 0, 1]),
    si("C", 0, [0, 0, 1, 0, 1]),
    si("V", 0, [2, 1, -3, 0, -1]),
    Symbol { kelvin: 1, ..si("K", 0, [0; 5]) },
    other("t", 1.0, 3, [0, 1, 0, 0, 0]),
    other("in", 254.0, -4, LENGTH),
    other("micron", 1.0, -6, LENGTH),
    other("min", 60.0, 0, TIME),
    other("h", 3600.0, 0, TIME),
    other("%", 1.0, -2, [0; 5]),
    other("deg", DEGREE, 0, ANGLE),
    other("°", DEGREE, 0, ANGLE),
];

/// Prefixes and their powers of ten; both code points of the micro sign.
#[rustfmt::skip]
static PREFIXES: &[(&str, i8)] = &[
    ("f", -15), ("p", -12), ("n", -9), ("u", -6), ("µ", -6), ("μ", -6), ("m", -3), ("c", -2),
    ("d", -1), ("da", 1), ("h", 2), ("k", 3), ("M", 6), ("G", 9), ("T", 12),
];

/// The unit of a symbol with or without prefix: exact symbols first, so that
/// "min" is a minute.
fn find_symbol(text: &str) -> Option<Unit> {
    let exact = SYMBOLS.iter().find(|symbol| symbol.text == text);
    let (symbol, tens) = exact.map(|symbol| (symbol, 0)).or_else(|| {
        PREFIXES.iter().find_map(|(prefix, tens)| {
            let rest = text.strip_prefix(prefix)?;
            let symbol = SYMBOLS.iter().find(|s| s.prefixable && s.text == rest)?;
            Some((symbol, *tens))
        })
    })?;
    let [m, kg, s, rad, a] = symbol.powers.map(f64::from);
    Some(Unit {
        dimension: Dimension([m, kg, s, rad, a, f64::from(symbol.kelvin)]),
        tens: f64::from(symbol.tens) + f64::from(tens),
        up: symbol.factor,
        down: 1.0,
    })
}

/// The known unit nearest to a text, if any is near.
fn nearest_symbol(text: &str) -> Option<String> {
    let prefixed = |symbol: &Symbol| {
        let prefixes = PREFIXES.iter().filter(|_| symbol.prefixable);
        let prefixed = prefixes.map(|(prefix, _)| format!("{prefix}{}", symbol.text));
        std::iter::once(symbol.text.to_owned()).chain(prefixed).collect::<Vec<_>>()
    };
    // Any letter is one slip away from any other: only its case may be wrong.
    let single = text.chars().count() == 1;
    let units: Vec<String> = SYMBOLS.iter().flat_map(prefixed).collect();
    let close = units.iter().map(String::as_str);
    let close = close.filter(|unit| !single || unit.eq_ignore_ascii_case(text));
    nearest_word(text, close).map(str::to_owned)
}
