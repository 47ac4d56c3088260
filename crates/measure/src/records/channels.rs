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
#[path = "tests/channels.rs"]
mod tests;
