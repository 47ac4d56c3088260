//! Lines into fields, fields into numbers.

use std::borrow::Cow;

/// The fields of a line. Spaces separate in runs; quotes keep delimiters.
pub(super) fn fields(line: &str, delimiter: char) -> Vec<Cow<'_, str>> {
    if delimiter == ' ' {
        return line.split_whitespace().map(Cow::Borrowed).collect();
    }
    if !line.contains('"') {
        return line
            .split(delimiter)
            .map(|field| Cow::Borrowed(field.trim()))
            .collect();
    }
    let mut fields = vec![String::new()];
    let mut quoted = false;
    for letter in line.chars() {
        if letter == '"' {
            quoted = !quoted;
        } else if letter == delimiter && !quoted {
            fields.push(String::new());
        } else if let Some(last) = fields.last_mut() {
            last.push(letter);
        }
    }
    let trimmed = fields.iter().map(|field| field.trim().to_owned());
    trimmed.map(Cow::Owned).collect()
}

/// A number with a decimal point, or with a decimal comma.
pub(super) fn number(text: &str, decimal_comma: bool) -> Option<f64> {
    // No number begins with other letters; the parser takes its time to say so.
    let first = text.bytes().next()?;
    if !(first.is_ascii_digit() || b"+-.,nNiI".contains(&first)) {
        return None;
    }
    match decimal_comma {
        false => text.parse().ok(),
        true if text.contains('.') => None,
        true => text.replace(',', ".").parse().ok(),
    }
}

/// What one of the last digit of a number is worth: 1e-5 of 0.00012, 1e-9 of 1.5e-8.
pub(super) fn last_digit(text: &str, decimal_comma: bool) -> f64 {
    let sign = if decimal_comma { ',' } else { '.' };
    let (digits, power) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let behind = digits
        .split_once(sign)
        .map_or(0, |(_, behind)| behind.len());
    let power: i32 = power.parse().unwrap_or(0);
    10.0_f64.powi(power.saturating_sub(i32::try_from(behind).unwrap_or(i32::MAX)))
}

/// A number at the beginning of a text and what follows: "1.5 MS/s".
pub(super) fn leading_number(text: &str, decimal_comma: bool) -> Option<(f64, &str)> {
    let text = text.trim_start_matches([' ', ':', '=', '"', ';', ',', '\t']);
    let ends = text
        .char_indices()
        .map(|(at, letter)| at + letter.len_utf8());
    let parsed = ends.filter_map(|end| {
        let (head, tail) = text.split_at(end);
        let plain = head.ends_with(|letter: char| letter.is_ascii_digit() || letter == '.');
        let value = number(head, decimal_comma).filter(|_| plain)?;
        Some((value, tail))
    });
    // Numbers are short; a long text is no number.
    parsed.take(32).last()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_keep_delimiters() {
        assert_eq!(fields("\"0,5\", \"1,5\"", ','), ["0,5", "1,5"]);
        assert_eq!(fields("  1   2\t3 ", ' '), ["1", "2", "3"]);
    }

    #[test]
    fn a_decimal_comma_is_a_point_only_where_it_is_one() {
        assert_eq!(number("-1,5e-3", true), Some(-1.5e-3));
        assert_eq!(number("1.5", true), None);
        assert_eq!(number("1,5", false), None);
        assert!(number("NaN", false).unwrap().is_nan());
        assert_eq!(number("Volt", false), None);
    }

    #[test]
    fn a_last_digit_is_worth_what_its_place_says() {
        for (text, comma, expected) in [
            ("0.00012", false, 1e-5),
            ("-1,5E-03", true, 1e-4),
            ("17", false, 1.0),
            ("2e-6", false, 1e-6),
        ] {
            let worth = last_digit(text, comma);
            // Rounding of a power of ten.
            assert!((worth / expected - 1.0).abs() < 1e-12, "{text}: {worth}");
        }
    }

    #[test]
    fn a_leading_number_leaves_its_unit() {
        assert_eq!(leading_number("=1.5 MS/s", false), Some((1.5, " MS/s")));
        assert_eq!(leading_number(" 1e-6s", false), Some((1e-6, "s")));
        assert_eq!(leading_number("none", false), None);
    }
}
