//! Which channels: what file and options say together.

use crate::records::error::{RecordError, name};
use crate::records::options::ReadOptions;
use std::path::Path;

/// Most channels that a shot has: the bead's sensor and the wall's.
const MOST: usize = 2;

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
    if let Some(both) = by_title(names) {
        return Ok(both.to_vec());
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

/// The sensor bead's channel and the wall's, where titles tell one of each. Of two, one
/// that is the wall's makes the other the bead's.
fn by_title(names: &[String]) -> Option<[usize; 2]> {
    let only = |is: &dyn Fn(&str) -> bool| {
        let mut such = (0..names.len()).filter(|at| is(&names[*at]));
        such.next().filter(|_| such.next().is_none())
    };
    let wall = only(&is_of_wall)?;
    let bead = match names.len() {
        2 => only(&|name| !is_of_wall(name)),
        _ => only(&|name| !is_of_wall(name) && has_word(name, &["bead", "sensor"])),
    };
    Some([bead?, wall])
}

fn is_of_wall(name: &str) -> bool {
    has_word(name, &["wall"])
}

/// Whether a word of a title begins so: "Wall (V)", "bead_7".
fn has_word(title: &str, beginnings: &[&str]) -> bool {
    let title = title.to_lowercase();
    let mut words = title.split(|letter: char| !letter.is_alphanumeric());
    words.any(|word| beginnings.iter().any(|begin| word.starts_with(begin)))
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
    fn channels_that_are_called_after_wall_and_bead_are_these_in_whatever_order() {
        let asked = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            chosen(Path::new("x"), &names, &ReadOptions::default())
        };
        assert_eq!(asked(&["wall", "bead"]).unwrap(), [1, 0]);
        assert_eq!(asked(&["Sensor_7", "Wall (V)"]).unwrap(), [0, 1]);
        assert_eq!(asked(&["wall sensor", "CH2"]).unwrap(), [1, 0]);
        assert_eq!(asked(&["trigger", "wall", "bead 7"]).unwrap(), [2, 1]);
        // Nothing is told by these.
        assert_eq!(asked(&["CH1", "CH2"]).unwrap(), [0, 1]);
        assert_eq!(asked(&["sensor 1", "sensor 2"]).unwrap(), [0, 1]);
        assert!(asked(&["wall", "CH1", "CH2"]).is_err());
    }

    #[test]
    fn three_channels_need_a_choice() {
        let error = chosen(Path::new("x"), &names(), &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains("--channel"), "{error}");
    }
}
