//! Parts of a campaign, for several machines.

use std::str::FromStr;

/// One of several parts of a campaign: series are dealt out like cards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

    /// Whether a series, by its number from 0, is in this part.
    #[must_use]
    pub fn holds(self, series: usize) -> bool {
        series % self.of == self.number - 1
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let refused = || ShardError(text.to_owned());
        let (number, of) = text.split_once('/').ok_or_else(refused)?;
        let whole = |part: &str| part.trim().parse::<usize>().map_err(|_| refused());
        let (number, of) = (whole(number)?, whole(of)?);
        match (1..=of).contains(&number) {
            true => Ok(Self { number, of }),
            false => Err(refused()),
        }
    }
}
