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

/// A number with a decimal point, or with a decimal comma; thousands may be apart by a
/// comma or a point, whichever the decimal sign is not, a space or an apostrophe.
pub(super) fn number(text: &str, decimal_comma: bool) -> Option<f64> {
    plain(text, decimal_comma)
        .or_else(|| plain(&ungrouped(text, decimal_comma)?, decimal_comma))
        .or_else(|| time_of_day_s(text))
}

/// Whether a field is a time of day or a stamp of date and time.
pub(super) fn is_time_of_day(text: &str) -> bool {
    time_of_day_s(text).is_some()
}

/// `12:00:00.000001`, with a date before it or without, in s since midnight, or since that before
/// the month began: double precision has no more digits than nanoseconds of a month need. Hours and
/// minutes alone are none.
fn time_of_day_s(text: &str) -> Option<f64> {
    let text = text.trim_matches('"').trim();
    if text.len() > 40 || text.matches(':').count() < 2 {
        return None;
    }
    let (date, clock) = text.rsplit_once([' ', 'T']).unwrap_or(("", text));
    let clock = clock.trim_end_matches('Z');
    let clock = clock.split_once('+').map_or(clock, |(clock, _zone)| clock);
    let mut parts = clock.splitn(3, ':');
    let whole = |text: &str, most: u32| text.parse().ok().filter(|n: &u32| *n <= most);
    let hours = whole(parts.next()?, 24)?;
    let minutes = whole(parts.next()?, 59)?;
    let seconds = parts.next()?;
    let digits = |letter: char| letter.is_ascii_digit() || letter == '.' || letter == ',';
    if !seconds.starts_with(|letter: char| letter.is_ascii_digit()) || !seconds.chars().all(digits)
    {
        return None;
    }
    let seconds: f64 = seconds.replace(',', ".").parse().ok()?;
    let day = match date {
        "" => 0,
        date => day_of_month(date)?,
    };
    let minutes = 60 * (24 * day + hours) + minutes;
    (seconds < 61.0).then(|| f64::from(60 * minutes) + seconds)
}

/// Of year-month-day, also with slashes; 0 of other orders, which do not tell it.
fn day_of_month(date: &str) -> Option<u32> {
    let parts: Vec<&str> = date.trim().split(['-', '/', '.']).collect();
    let numbers: Option<Vec<u32>> = parts.iter().map(|part| part.parse().ok()).collect();
    match numbers?[..] {
        [_, _, day] if parts[0].len() == 4 && day <= 31 => Some(day),
        [_, _, _] => Some(0),
        _ => None,
    }
}

/// The same without what stands between thousands, if anything does.
fn ungrouped(text: &str, decimal_comma: bool) -> Option<String> {
    let (sign, other) = if decimal_comma {
        (',', '.')
    } else {
        ('.', ',')
    };
    let end = text.find([sign, 'e', 'E']).unwrap_or(text.len());
    let (whole, rest) = text.split_at(end);
    let digits = whole.trim_start_matches(['+', '-']);
    let mark = digits.chars().find(|letter| !letter.is_ascii_digit())?;
    let known = mark == other || matches!(mark, ' ' | '\u{a0}' | '\u{202f}' | '\'' | '’');
    let mut groups = digits.split(mark);
    let first = groups.next()?;
    let leads = (1..=3).contains(&first.len()) && !first.starts_with('0');
    let three = |group: &str| group.len() == 3 && group.bytes().all(|b| b.is_ascii_digit());
    (known && leads && groups.all(three)).then(|| whole.replace(mark, "") + rest)
}

/// What stands in a cell of a number where there was none to be told.
pub(super) fn no_number(text: &str) -> Option<f64> {
    const OVER: &[&str] = &[
        "overload",
        "overrange",
        "over range",
        "overflow",
        "over",
        "ovl",
        "ovld",
        "ovrl",
        "ovf",
        "ol",
        "o.l.",
        "clipped",
        "1.#inf",
        "∞",
        "+∞",
    ];
    const NONE: &[&str] = &[
        "", "-", "--", "---", "n/a", "na", "#n/a", "null", "none", "missing", "#num!", "#value!",
        "#div/0!", "1.#qnan", "1.#ind", "-1.#ind", "-1.#qnan",
    ];
    let text = text.trim_matches('"').to_lowercase();
    let over = OVER.contains(&text.trim_start_matches('+'));
    let under = text
        .strip_prefix('-')
        .is_some_and(|text| OVER.contains(&text.trim()));
    match (over, under || text == "underrange" || text == "underflow") {
        (true, _) => Some(f64::INFINITY),
        (_, true) => Some(f64::NEG_INFINITY),
        _ => NONE.contains(&text.as_str()).then_some(f64::NAN),
    }
}

/// A number with nothing between its thousands.
pub(super) fn plain(text: &str, decimal_comma: bool) -> Option<f64> {
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
    let sign = match text.contains(':') {
        true if text.contains(',') => ',',
        true => '.',
        false if decimal_comma => ',',
        false => '.',
    };
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
        let value = self::plain(head, decimal_comma).filter(|_| plain)?;
        Some((value, tail))
    });
    // Numbers are short; a long text is no number.
    parsed.take(32).last()
}

#[cfg(test)]
#[path = "tests/field.rs"]
mod tests;
