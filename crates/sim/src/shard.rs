//! Parts of work, for several machines.

use std::fmt::{Display, Formatter, Result as Formatted};
use std::str::FromStr;

/// One of several parts of a sweep or a campaign: shots or series are dealt out
/// like cards, so that parts take as long as each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Shard {
    /// Which part, from 1.
    number: usize,
    /// How many there are.
    of: usize,
}

/// A part that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no part: expected i/n, such as 1/4 for the first of four")]
pub struct ShardError(String);

impl Shard {
    /// All of it.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// A part by its number from 1.
    ///
    /// # Errors
    /// A number that is not among them.
    pub fn new(number: usize, of: usize) -> Result<Self, ShardError> {
        match (1..=of).contains(&number) {
            true => Ok(Self { number, of }),
            false => Err(ShardError(format!("{number}/{of}"))),
        }
    }

    /// All parts of work that is cut into so many.
    pub fn all(of: usize) -> impl Iterator<Item = Self> {
        (1..=of).map(move |number| Self { number, of })
    }

    /// Which part it is, from 1.
    #[must_use]
    pub fn number(self) -> usize {
        self.number
    }

    /// How many parts there are.
    #[must_use]
    pub fn of(self) -> usize {
        self.of
    }

    /// Whether a shot or a series, by its place from 0, is in this part.
    #[must_use]
    pub fn holds(self, place: usize) -> bool {
        place % self.of == self.number - 1
    }

    /// The places from 0 of what is in this part, of so many in all.
    pub fn places(self, count: usize) -> impl Iterator<Item = usize> {
        (self.number - 1..count).step_by(self.of)
    }
}

impl Display for Shard {
    fn fmt(&self, f: &mut Formatter<'_>) -> Formatted {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let refused = || ShardError(text.to_owned());
        let (number, of) = text.split_once('/').ok_or_else(refused)?;
        let whole = |part: &str| part.trim().parse::<usize>().map_err(|_| refused());
        Self::new(whole(number)?, whole(of)?).map_err(|_| refused())
    }
}

#[cfg(test)]
#[path = "tests/shard.rs"]
mod tests;
