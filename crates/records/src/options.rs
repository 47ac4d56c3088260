//! What a file may leave open.

/// How recordings are to be read where they do not say themselves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Sampling rate in Hz.
    pub rate_hz: Option<f64>,
    /// Take that rate even where a file says another.
    pub trust_rate: bool,
    /// Channels, columns or arrays by name or by number from 1; all that a
    /// shot can have when empty.
    pub channels: Vec<String>,
    /// Cut longer records into shots of so many samples.
    pub shot_samples: Option<usize>,
    /// What the rows of a table of numbers are.
    pub rows: Rows,
}

/// What the first axis of a two-dimensional array is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rows {
    /// Time goes along the longer axis; the shorter one counts shots if it comes
    /// first, channels if it comes last.
    #[default]
    Auto,
    /// A row is a shot.
    Shots,
    /// A row is a channel.
    Channels,
    /// A row is a moment, a column a channel.
    Times,
}
