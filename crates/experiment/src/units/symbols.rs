//! Symbols of units and prefixes.

use super::dimension::Dimension;
use std::f64::consts::PI;

/// One unit symbol: its dimension and its size `numerator`/`denominator` ·
/// 10^`tens` · `rest` in SI base units.
#[derive(Debug)]
pub(super) struct Symbol {
    pub(super) text: &'static str,
    pub(super) prefixable: bool,
    pub(super) dimension: Dimension,
    pub(super) numerator: u64,
    pub(super) tens: i64,
    pub(super) rest: f64,
}

/// A symbol whose size is a power of ten.
const fn si(text: &'static str, tens: i64, dimension: [i64; 4]) -> Symbol {
    electric(text, tens, dimension, 0)
}

/// A symbol with a power of the ampere.
const fn electric(text: &'static str, tens: i64, dimension: [i64; 4], ampere: i64) -> Symbol {
    Symbol {
        text,
        prefixable: true,
        dimension: Dimension::new(dimension, ampere),
        numerator: 1,
        tens,
        rest: 1.0,
    }
}

/// A symbol without prefixes, of size numerator · 10^tens.
const fn other(text: &'static str, numerator: u64, tens: i64, dimension: [i64; 4]) -> Symbol {
    Symbol {
        prefixable: false,
        numerator,
        ..si(text, tens, dimension)
    }
}

/// Degrees are not a rational number of radians.
const fn degree(text: &'static str) -> Symbol {
    Symbol {
        rest: PI / 180.0,
        ..other(text, 1, 0, [0, 0, 0, 1])
    }
}

const LENGTH: [i64; 4] = [1, 0, 0, 0];
const TIME: [i64; 4] = [0, 0, 1, 0];

/// Every unit symbol; the powers are those of m, kg, s, rad.
pub(super) static SYMBOLS: &[Symbol] = &[
    si("m", 0, LENGTH),
    si("g", -3, [0, 1, 0, 0]),
    si("s", 0, TIME),
    si("rad", 0, [0, 0, 0, 1]),
    si("N", 0, [1, 1, -2, 0]),
    si("Pa", 0, [-1, 1, -2, 0]),
    si("J", 0, [2, 1, -2, 0]),
    si("W", 0, [2, 1, -3, 0]),
    si("Hz", 0, [0, 0, -1, 0]),
    si("bar", 5, [-1, 1, -2, 0]),
    si("l", -3, [3, 0, 0, 0]),
    si("L", -3, [3, 0, 0, 0]),
    si("P", -1, [-1, 1, -1, 0]),
    si("St", -4, [2, 0, -1, 0]),
    si("dyn", -5, [1, 1, -2, 0]),
    electric("A", 0, [0, 0, 0, 0], 1),
    electric("C", 0, [0, 0, 1, 0], 1),
    electric("V", 0, [2, 1, -3, 0], -1),
    other("t", 1, 3, [0, 1, 0, 0]),
    other("in", 254, -4, LENGTH),
    other("micron", 1, -6, LENGTH),
    other("min", 60, 0, TIME),
    other("h", 3600, 0, TIME),
    other("%", 1, -2, [0, 0, 0, 0]),
    degree("deg"),
    degree("°"),
];

/// Prefixes and their powers of ten; both code points of the micro sign.
pub(super) static PREFIXES: &[(&str, i64)] = &[
    ("f", -15),
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("µ", -6),
    ("μ", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("da", 1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// The symbol of a text and its prefix's power of ten: exact symbols first,
/// so that "min" is a minute.
pub(super) fn find(text: &str) -> Option<(&'static Symbol, i64)> {
    let exact = SYMBOLS.iter().find(|symbol| symbol.text == text);
    exact.map(|symbol| (symbol, 0)).or_else(|| {
        PREFIXES.iter().find_map(|(prefix, tens)| {
            let rest = text.strip_prefix(prefix)?;
            let symbol = (SYMBOLS.iter()).find(|s| s.prefixable && s.text == rest)?;
            Some((symbol, *tens))
        })
    })
}

/// The known unit nearest to a text, if any is near.
pub(super) fn nearest(text: &str) -> Option<String> {
    let plain = SYMBOLS.iter().map(|s| s.text.to_owned());
    let prefixed = SYMBOLS.iter().filter(|s| s.prefixable).flat_map(|symbol| {
        PREFIXES
            .iter()
            .map(move |(prefix, _)| format!("{prefix}{}", symbol.text))
    });
    // Any letter is one slip away from any other: only its case may be wrong.
    let single = text.chars().count() == 1;
    let close = |unit: &String| !single || unit.eq_ignore_ascii_case(text);
    crate::nearest::of_owned(text, plain.chain(prefixed).filter(close))
}
