//! Lists of speeds as a user writes them.

use hertzchain_experiment::units::{UnitError, parse_quantity, parse_unit};

/// Most speeds in one sweep.
pub const MOST_SPEEDS: usize = 100_000;

/// What is wrong with a speed or a list of speeds.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpeedError {
    /// Not a number with a unit.
    #[error("`{text}`: {error}; expected a number with a unit, such as \"0.5 m/s\"")]
    Unit {
        /// The text.
        text: String,
        /// What is wrong with it.
        error: UnitError,
    },
    /// Another quantity.
    #[error("`{text}` is {found}, not a speed such as 0.5 or \"0.5 m/s\"")]
    NotASpeed {
        /// The text.
        text: String,
        /// What it is.
        found: String,
    },
    /// Another quantity than a time.
    #[error("`{text}` is {found}, not a time such as \"2 ms\"")]
    NotATime {
        /// The text.
        text: String,
        /// What it is.
        found: String,
    },
    /// Time that does not pass.
    #[error("a time of {0} s is not positive")]
    TimeNotPositive(f64),
    /// Nothing moves, or backward.
    #[error("a speed of {0} m/s is not positive")]
    NotPositive(f64),
    /// A range that is none.
    #[error(
        "`{0}` is not a range; expected FROM:TO:COUNT, such as 0.075:1.23:25 or log:0.075:1.23:25"
    )]
    Range(String),
    /// Too few or too many points in a range.
    #[error("a range has from 2 to {MOST_SPEEDS} speeds, not {0}")]
    Count(String),
}

/// A speed in m/s from "0.5", "0.5 m/s" or "500 mm/s".
///
/// # Errors
/// See [`SpeedError`].
pub fn parse_speed(text: &str) -> Result<f64, SpeedError> {
    let text = text.trim();
    let given = |error| SpeedError::Unit {
        text: text.to_owned(),
        error,
    };
    let quantity = parse_quantity(text).map_err(given)?;
    let plain = parse_unit("1").is_ok_and(|one| quantity.dimension.agrees_with(&one.dimension));
    let speed = parse_unit("m/s").is_ok_and(|unit| quantity.dimension.agrees_with(&unit.dimension));
    if !plain && !speed {
        return Err(SpeedError::NotASpeed {
            text: text.to_owned(),
            found: quantity.dimension.name(),
        });
    }
    if quantity.value > 0.0 {
        Ok(quantity.value)
    } else {
        Err(SpeedError::NotPositive(quantity.value))
    }
}

/// A time in s from "1e-3", "2 ms" or "1 us".
///
/// # Errors
/// See [`SpeedError`].
pub fn parse_time(text: &str) -> Result<f64, SpeedError> {
    let given = |error| SpeedError::Unit {
        text: text.to_owned(),
        error,
    };
    let quantity = parse_quantity(text.trim()).map_err(given)?;
    let fits = |unit: &str| {
        parse_unit(unit).is_ok_and(|unit| quantity.dimension.agrees_with(&unit.dimension))
    };
    if !fits("1") && !fits("s") {
        return Err(SpeedError::NotATime {
            text: text.to_owned(),
            found: quantity.dimension.name(),
        });
    }
    if quantity.value > 0.0 {
        Ok(quantity.value)
    } else {
        Err(SpeedError::TimeNotPositive(quantity.value))
    }
}

/// Speeds in m/s from "0.1, 0.2, 0.5 m/s", "0.075:1.23:25" (equal steps) or
/// "log:0.075:1.23:25" (equal ratios); members of a list may be ranges.
///
/// # Errors
/// See [`SpeedError`].
pub fn parse_speeds(text: &str) -> Result<Vec<f64>, SpeedError> {
    let mut speeds = Vec::new();
    for member in text.split(',') {
        if member.contains(':') {
            speeds.extend(range(member.trim())?);
        } else {
            speeds.push(parse_speed(member)?);
        }
    }
    Ok(speeds)
}

fn range(text: &str) -> Result<Vec<f64>, SpeedError> {
    let (logarithmic, ends) = match text.strip_prefix("log:") {
        Some(ends) => (true, ends),
        None => (false, text),
    };
    let parts: Vec<&str> = ends.split(':').collect();
    let &[from, to, count] = parts.as_slice() else {
        return Err(SpeedError::Range(text.to_owned()));
    };
    let (from, to) = (parse_speed(from)?, parse_speed(to)?);
    let points = count
        .trim()
        .parse()
        .ok()
        .filter(|n| (2..=MOST_SPEEDS).contains(n));
    let count = points.ok_or_else(|| SpeedError::Count(count.trim().to_owned()))?;
    let between = |share: f64| match logarithmic {
        true => from * (to / from).powf(share),
        false => from + (to - from) * share,
    };
    let at = |i: usize| match i {
        0 => from,
        // The last is the end itself, not the end as rounding leaves it.
        i if i + 1 == count => to,
        i => between(i as f64 / (count - 1) as f64),
    };
    Ok((0..count).map(at).collect())
}

#[cfg(test)]
#[path = "tests/speeds.rs"]
mod tests;
