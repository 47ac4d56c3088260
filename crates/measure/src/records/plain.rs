//! Names and titles from files, as they may be shown and written.

use std::borrow::Cow;
use std::fmt::Write;

/// A text in which control characters but line ends and tabs are written as `\u001b`: those of a
/// file's name or a title could steer a terminal.
#[must_use]
pub fn without_controls(text: &str) -> Cow<'_, str> {
    let steers = |letter: char| letter.is_control() && !matches!(letter, '\n' | '\t');
    if !text.contains(steers) {
        return Cow::Borrowed(text);
    }
    let mut plain = String::with_capacity(text.len() + 16);
    for letter in text.chars() {
        match steers(letter) {
            // Writing to a text cannot fail.
            true => drop(write!(plain, "\\u{:04x}", u32::from(letter))),
            false => plain.push(letter),
        }
    }
    Cow::Owned(plain)
}

/// The words of a table's cell that no spreadsheet takes for a formula: those that begin as one,
/// and are no number, stand after an apostrophe.
#[must_use]
pub fn no_formula(words: &str) -> Cow<'_, str> {
    let formula = words.starts_with(['=', '+', '-', '@', '\t', '\r']);
    match formula && words.parse::<f64>().is_err() {
        true => Cow::Owned(format!("'{words}")),
        false => Cow::Borrowed(words),
    }
}

#[cfg(test)]
#[path = "tests/plain.rs"]
mod tests;
