//! Which channels, and how fast: what file and options say together.

use crate::error::{RecordError, name};
use crate::options::ReadOptions;
use std::path::Path;

/// Most channels that a shot has: the bead's sensor and the wall's.
const MOST: usize = 2;

/// Relative difference of two rates that are meant to be the same: exports
/// round intervals to four digits.
const SAME_RATE: f64 = 1e-3;

/// Indices of the asked channels among those there are.
///
/// # Errors
/// A name that there is not, or more channels than a shot has without a choice.
pub(crate) fn chosen(
    file: &Path,
    names: &[String],
    options: &ReadOptions,
) -> Result<Vec<usize>, RecordError> {
    if !options.channels.is_empty() {
        let one = |wanted: &String| {
            position(names, wanted).ok_or_else(|| RecordError::NoChannel {
                file: name(file),
                wanted: wanted.clone(),
                there: list(names),
            })
        };
        return options.channels.iter().map(one).collect();
    }
    match names.len() {
        0 => Err(RecordError::Empty {
            source_name: name(file),
        }),
        count if count > MOST => Err(RecordError::WhichChannel {
            file: name(file),
            count,
            there: list(names),
        }),
        count => Ok((0..count).collect()),
    }
}

/// By name, by name in other letters, or by number from 1.
fn position(names: &[String], wanted: &str) -> Option<usize> {
    let folded = |text: &str| text.trim().to_lowercase();
    let number = || wanted.parse().ok().and_then(|n: usize| n.checked_sub(1));
    let exact = names.iter().position(|name| name == wanted);
    exact
        .or_else(|| names.iter().position(|name| folded(name) == folded(wanted)))
        .or_else(|| number().filter(|index| *index < names.len()))
}

/// Names that anybody reads at once.
const SHOWN: usize = 12;

pub(crate) fn list(names: &[String]) -> String {
    let shown: Vec<&str> = names.iter().take(SHOWN).map(String::as_str).collect();
    let more = if names.len() > SHOWN { ", …" } else { "" };
    shown.join(", ") + more
}

/// Names of channels that have none: numbers from 1.
pub(crate) fn numbered(count: usize) -> Vec<String> {
    (1..=count).map(|number| number.to_string()).collect()
}

/// Sampling interval in s, from what the file states and what the option says.
///
/// # Errors
/// Neither says, they disagree, or the interval is impossible.
pub(crate) fn interval_s(
    file: &Path,
    stated_s: Option<f64>,
    options: &ReadOptions,
) -> Result<f64, RecordError> {
    let given_s = options.rate_hz.map(|rate| rate.recip());
    let interval_s = match (stated_s, given_s) {
        (Some(stated), Some(given)) if !options.trust_rate => agreed(file, stated, given)?,
        (_, Some(given)) => given,
        (Some(stated), None) => stated,
        (None, None) => return Err(RecordError::NoRate { file: name(file) }),
    };
    match interval_s.is_normal() && interval_s > 0.0 {
        true => Ok(interval_s),
        false => Err(RecordError::ImpossibleRate {
            file: name(file),
            interval_s,
        }),
    }
}

/// What is told where times without a unit were taken for seconds, and no rate
/// was given to hold them against.
pub(crate) fn seconds_taken(
    name: &str,
    unit_s: Option<f64>,
    options: &ReadOptions,
) -> Option<String> {
    let told = unit_s.or(options.time_unit_s).or(options.rate_hz).is_some();
    let called = match name {
        "" => "its first column".to_owned(),
        name => format!("{name:?}"),
    };
    (!told).then(|| {
        format!("{called} names no unit and was taken as times in s; --time-unit us says another")
    })
}

/// The option's interval, which is exact where an export rounds.
fn agreed(file: &Path, stated: f64, given: f64) -> Result<f64, RecordError> {
    match (stated - given).abs() <= SAME_RATE * given {
        true => Ok(given),
        false => Err(RecordError::WrongRate {
            file: name(file),
            stated_hz: stated.recip(),
            given_hz: given.recip(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names() -> Vec<String> {
        ["Time", "Ch A", "Ch B"].map(str::to_owned).to_vec()
    }

    fn asking(channel: &str) -> ReadOptions {
        ReadOptions {
            channels: vec![channel.to_owned()],
            ..ReadOptions::default()
        }
    }

    #[test]
    fn a_channel_is_found_by_name_in_any_letters_or_by_number() {
        for wanted in ["Ch B", "ch b", "3"] {
            let found = chosen(Path::new("x"), &names(), &asking(wanted));
            assert_eq!(found.unwrap(), [2], "{wanted}");
        }
        let error = chosen(Path::new("x"), &names(), &asking("4")).unwrap_err();
        assert!(error.to_string().contains("Time, Ch A, Ch B"), "{error}");
    }

    #[test]
    fn three_channels_need_a_choice() {
        let error = chosen(Path::new("x"), &names(), &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains("--channel"), "{error}");
    }

    #[test]
    fn a_rate_that_contradicts_the_file_is_refused_unless_insisted_on() {
        let mut options = ReadOptions {
            rate_hz: Some(5e5),
            ..ReadOptions::default()
        };
        let refused = interval_s(Path::new("x"), Some(1e-6), &options).unwrap_err();
        assert!(matches!(refused, RecordError::WrongRate { .. }));
        options.trust_rate = true;
        assert_eq!(
            interval_s(Path::new("x"), Some(1e-6), &options).unwrap(),
            2e-6
        );
    }

    #[test]
    fn impossible_intervals_are_refused() {
        let open = ReadOptions::default();
        for interval in [0.0, -1e-6, f64::NAN, f64::INFINITY] {
            assert!(interval_s(Path::new("x"), Some(interval), &open).is_err());
        }
        assert!(interval_s(Path::new("x"), None, &open).is_err());
    }
}
