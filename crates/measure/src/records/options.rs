//! Options of reading, and the choice of channels.

use crate::error::{MeasureError, Result, file_name};
use crate::records::arrays::last;
use std::path::Path;

/// How recordings are read where they do not state it themselves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Sampling rate in Hz.
    pub rate_hz: Option<f64>,
    /// Use that rate even where a file states another.
    pub trust_rate: bool,
    /// Channels, columns or arrays by name or by number from 1; empty for the default choice.
    pub channels: Vec<String>,
    /// Unit of times in s where neither title nor name has one.
    pub time_unit_s: Option<f64>,
    /// How longer records are divided.
    pub parts: Parts,
    /// Meaning of the rows of a table of numbers.
    pub rows: Rows,
}

impl ReadOptions {
    pub(crate) fn rows_of(&self, shape: &[usize]) -> Rows {
        match (self.rows, shape) {
            (Rows::Auto, &[rows, columns])
                if columns < rows && columns > MOST_COLUMNS && self.channels.is_empty() =>
            {
                Rows::Moments
            }
            // Channels can only be chosen where there are some.
            (Rows::Auto, &[rows, columns]) if rows <= columns && !self.channels.is_empty() => {
                Rows::Channels
            }
            (rows, _) => rows,
        }
    }

    pub(crate) fn trusted_rate_hz(&self) -> Option<f64> {
        self.rate_hz.filter(|_| self.trust_rate)
    }
}

/// How records are divided that are longer than a shot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Parts {
    /// A record is a shot.
    #[default]
    Whole,
    /// Shots of so many samples.
    Shots(usize),
    /// Pieces of at most so many samples, to be searched for shots;
    /// [`Record::first_sample`](crate::records::Record::first_sample) is where each begins.
    Pieces(usize),
}

impl Parts {
    pub(crate) fn most(self) -> Option<usize> {
        match self {
            Self::Whole => None,
            Self::Shots(most) | Self::Pieces(most) => Some(most.max(1)),
        }
    }
}

/// Meaning of the first axis of a two-dimensional array.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rows {
    /// Time runs along the longer axis; the shorter one counts shots if it comes first,
    /// channels if it comes last; more than eight columns, none of them chosen, are shots.
    #[default]
    Auto,
    /// A row is a shot.
    Shots,
    /// A row is a channel.
    Channels,
    /// A row is a moment, a column a channel.
    Times,
    /// A row is a moment, a column a shot.
    Moments,
}

/// Most columns that are channels without being chosen, times included.
pub(crate) const MOST_COLUMNS: usize = 8;

/// Most channels of a shot: the bead's sensor and the wall's.
pub(crate) const MOST_CHANNELS: usize = 2;

const SHOWN: usize = 12;

pub(crate) fn chosen(file: &Path, names: &[String], options: &ReadOptions) -> Result<Vec<usize>> {
    if !options.channels.is_empty() {
        let one = |wanted: &String| {
            position(names, wanted).ok_or_else(|| no_channel(file, wanted, names))
        };
        return options.channels.iter().map(one).collect();
    }
    match names.len() {
        0 => Err(MeasureError::empty(file_name(file))),
        count => match by_title(names) {
            Some(both) => Ok(both.to_vec()),
            None if count > MOST_CHANNELS => Err(ambiguous(file, names)),
            None => Ok((0..count).collect()),
        },
    }
}

pub(crate) fn no_channel(file: &Path, wanted: &str, names: &[String]) -> MeasureError {
    let there = list(names);
    MeasureError::Channels(file_name(file), format!("has no channel {wanted:?}; it has {there}"))
}

pub(crate) fn ambiguous(file: &Path, names: &[String]) -> MeasureError {
    let detail = format!(
        "has {} channels ({}); say which with --channel: one that sums both sensors, or two, the \
         sensor bead's first; of an array of which each column is a shot, --rows moments",
        names.len(),
        list(names)
    );
    MeasureError::Channels(file_name(file), detail)
}

/// The sensor bead's channel and the wall's, where titles name one of each. Of two channels, one
/// that is the wall's makes the other the bead's.
fn by_title(names: &[String]) -> Option<[usize; 2]> {
    let only = |is: &dyn Fn(&str) -> bool| {
        let mut such = (0..names.len()).filter(|at| is(&names[*at]));
        such.next().filter(|_| such.next().is_none())
    };
    let is_wall = |name: &str| has_word(name, &["wall"]);
    let wall = only(&is_wall)?;
    let bead = match names.len() {
        2 => only(&|name| !is_wall(name)),
        _ => only(&|name| !is_wall(name) && has_word(name, &["bead", "sensor"])),
    };
    Some([bead?, wall])
}

/// Whether a word of a title begins so: "Wall (V)", "bead_7".
fn has_word(title: &str, beginnings: &[&str]) -> bool {
    let title = title.to_lowercase();
    let mut words = title.split(|letter: char| !letter.is_alphanumeric());
    words.any(|word| beginnings.iter().any(|begin| word.starts_with(begin)))
}

/// By name, by name in any case, by the last part of a path, or by number from 1.
fn position(names: &[String], wanted: &str) -> Option<usize> {
    let folded = |text: &str| text.trim().to_lowercase();
    let number = || wanted.parse().ok().and_then(|n: usize| n.checked_sub(1));
    let exact = names.iter().position(|name| name == wanted);
    exact
        .or_else(|| names.iter().position(|name| folded(name) == folded(wanted)))
        .or_else(|| names.iter().position(|name| folded(last(name)) == folded(wanted)))
        .or_else(|| number().filter(|index| *index < names.len()))
}

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
