//! What a cell's number must be.

use super::Observable;
use hertzchain_measure::signal::Estimate;

/// Faster than any striker: speeds of chains are in m/s.
const MOST_SPEED_M_S: f64 = 50.0;

/// Longer than a wave takes through any row on a table.
const MOST_TIME_S: f64 = 0.1;

/// Times from here on are rather microseconds than milliseconds.
const MICROSECONDS_FROM: f64 = 20.0;

/// What is wrong with a speed of a striker in m/s, if anything is.
#[must_use]
pub fn wrong_speed(value: f64) -> Option<String> {
    let most = value > MOST_SPEED_M_S;
    // Nine digits tell what stands in a file; further ones are rounding.
    let value: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    if value <= 0.0 || !value.is_finite() {
        return Some(format!(
            "{value} is no speed of a striker; expected more than 0 m/s"
        ));
    }
    most.then(|| {
        format!("{value} m/s is no speed of a striker; it looks like mm/s or cm/s, expected m/s")
    })
}

/// What is wrong with a measured value.
pub(super) fn value(of: Observable, value: f64) -> Option<String> {
    let name = of.name();
    if value <= 0.0 || !value.is_finite() {
        return Some(format!("{value} is no {name}; expected a positive number"));
    }
    if !of.is_time() || value <= MOST_TIME_S {
        return None;
    }
    let unit = match value >= MICROSECONDS_FROM {
        true => "microseconds",
        false => "milliseconds",
    };
    Some(format!(
        "{value} s is no {name}; it looks like {unit}, expected seconds"
    ))
}

/// What is wrong with a standard error of an observable.
pub(super) fn sigma(of: Observable, measured: Estimate) -> Option<String> {
    let Estimate { value, sigma } = measured;
    if sigma <= 0.0 || !sigma.is_finite() {
        return Some(format!(
            "{sigma} is no uncertainty; expected a standard error above 0"
        ));
    }
    let unit = if of.is_time() { " s" } else { "" };
    (sigma > value).then(|| {
        format!(
            "the uncertainty {sigma}{unit} is larger than the value {value}{unit}: another unit?"
        )
    })
}

/// What is wrong with a correlation.
pub(super) fn correlation(value: f64) -> Option<String> {
    let sound = value.abs() < 1.0;
    (!sound).then(|| {
        format!("{value} is no correlation of two errors; expected a number between -1 and 1")
    })
}

/// What is wrong with the standard error of a speed: none is allowed.
pub(super) fn speed_sigma(measured: Estimate) -> Option<String> {
    let Estimate { value, sigma } = measured;
    if sigma < 0.0 || !sigma.is_finite() {
        return Some(format!("{sigma} is no uncertainty; expected 0 m/s or more"));
    }
    (sigma >= value).then(|| {
        format!("the uncertainty {sigma} m/s is not below the speed {value} m/s: another unit?")
    })
}
