//! Decimal numbers as text, so that powers of ten cost no rounding.

use super::UnitError;

/// ± digits · 10^exponent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Decimal {
    negative: bool,
    digits: String,
    exponent: i64,
}

impl Decimal {
    /// The number 1.
    pub(super) const ONE: &'static Self = &Self {
        negative: false,
        digits: String::new(),
        exponent: 0,
    };

    /// Reads the number at the start of a text and returns how many bytes it took.
    pub(super) fn read(text: &str) -> Result<(Self, usize), UnitError> {
        let bytes = text.as_bytes();
        let mut at = text.len() - text.trim_start().len();
        let start = at;
        let negative = bytes.get(at) == Some(&b'-');
        at += usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
        let whole = digits(text, at);
        at += whole.len();
        let mut fraction = "";
        if bytes.get(at) == Some(&b'.') {
            fraction = digits(text, at + 1);
            at += 1 + fraction.len();
        }
        if whole.is_empty() && fraction.is_empty() {
            return Err(no_number(text, start));
        }
        if let Some(better) = with_decimal_point(text) {
            let what = format!(
                "a comma is no decimal mark: write {better}{}",
                or_none(text)
            );
            return Err(UnitError::new(what, start..text.len()));
        }
        let (power, length) = power_of_ten(text, at)?;
        let number = Self {
            negative,
            digits: format!("{whole}{fraction}"),
            exponent: power - i64::try_from(fraction.len()).unwrap_or(i64::MAX / 4),
        };
        Ok((number, at + length))
    }

    /// Half a unit of the last digit: 0.005 for 6.35.
    pub(super) fn half_digit(&self) -> Self {
        Self {
            negative: false,
            digits: "5".to_owned(),
            exponent: self.exponent - 1,
        }
    }

    /// This number × factor × 10^tens, rounded once where the product of the
    /// digits and the factor fits into 128 bits.
    pub(super) fn times(&self, factor: u64, tens: i64) -> f64 {
        let digits = if self.digits.is_empty() {
            "1"
        } else {
            &self.digits
        };
        let exact = (digits.parse::<u128>().ok()).and_then(|d| d.checked_mul(factor.into()));
        let exponent = self.exponent.saturating_add(tens);
        let size = match exact {
            Some(product) => scientific(&product.to_string(), exponent),
            None => scientific(digits, exponent) * factor as f64,
        };
        if self.negative { -size } else { size }
    }
}

/// digits · 10^exponent, correctly rounded by the standard library.
fn scientific(digits: &str, exponent: i64) -> f64 {
    format!("{digits}e{exponent}").parse().unwrap_or(f64::NAN)
}

/// The run of digits that starts at a byte.
fn digits(text: &str, from: usize) -> &str {
    let rest = text.get(from..).unwrap_or_default();
    let end = rest.bytes().take_while(u8::is_ascii_digit).count();
    rest.get(..end).unwrap_or_default()
}

/// "6,35 mm" as "6.35 mm"; `None` where no comma stands between digits.
pub(crate) fn with_decimal_point(text: &str) -> Option<String> {
    let text = text.trim();
    let (whole, rest) = text.split_once(',')?;
    let figures = whole.trim_start_matches(['+', '-']);
    let number = !figures.is_empty() && figures.bytes().all(|b| b.is_ascii_digit());
    let fraction = rest.starts_with(|c: char| c.is_ascii_digit());
    (number && fraction).then(|| format!("{whole}.{rest}"))
}

/// A comma before three digits may have meant thousands.
fn or_none(text: &str) -> String {
    let (whole, rest) = text.trim().split_once(',').unwrap_or_default();
    match rest.bytes().take_while(u8::is_ascii_digit).count() {
        3 if !whole.ends_with('0') || whole.len() > 1 => {
            format!(", or {whole}{rest} if that was meant")
        }
        _ => String::new(),
    }
}

/// "e-3" at a byte: −3 and its length; 0 and 0 when there is none.
fn power_of_ten(text: &str, at: usize) -> Result<(i64, usize), UnitError> {
    let bytes = text.as_bytes();
    if !matches!(bytes.get(at), Some(b'e' | b'E')) {
        return Ok((0, 0));
    }
    let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
    let figures = digits(text, at + 1 + sign);
    if figures.is_empty() {
        return Ok((0, 0));
    }
    let length = 1 + sign + figures.len();
    match figures.parse::<i64>() {
        Ok(power) if power <= 1_000_000 => {
            let negative = bytes.get(at + 1) == Some(&b'-');
            Ok((if negative { -power } else { power }, length))
        }
        _ => Err(UnitError::new(
            "the power of ten is too large",
            at..at + length,
        )),
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
