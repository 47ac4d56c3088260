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
    /// What a unit of times is in s, where neither title nor name tells one.
    pub time_unit_s: Option<f64>,
    /// How longer records are divided.
    pub parts: Parts,
    /// What the rows of a table of numbers are.
    pub rows: Rows,
}

impl ReadOptions {
    /// What the rows of an array of this shape are, where its shape tells.
    pub(crate) fn rows_of(&self, shape: &[usize]) -> Rows {
        match (self.rows, shape) {
            (Rows::Auto, &[rows, columns])
                if columns < rows && columns > MOST_COLUMNS && self.channels.is_empty() =>
            {
                Rows::Moments
            }
            (rows, _) => rows,
        }
    }

    /// Whether a rate is given that counts whatever a file says.
    pub(crate) fn rate_is_trusted(&self) -> bool {
        self.trust_rate && self.rate_hz.is_some()
    }
}

/// How records are divided that are longer than a shot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Parts {
    /// Not at all: a record is a shot.
    #[default]
    Whole,
    /// Into shots of so many samples.
    Shots(usize),
    /// Into pieces of at most so many samples, in which somebody else looks for
    /// shots; [`Record::first_sample`](crate::records::Record::first_sample) tells where
    /// each begins.
    Pieces(usize),
}

impl Parts {
    /// Most samples of a part.
    pub(crate) fn most(self) -> Option<usize> {
        match self {
            Self::Whole => None,
            Self::Shots(most) | Self::Pieces(most) => Some(most.max(1)),
        }
    }
}

/// What the first axis of a two-dimensional array is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rows {
    /// Time goes along the longer axis; the shorter one counts shots if it comes
    /// first, channels if it comes last; more than eight columns of which none is asked for
    /// by its number are shots.
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

/// Most columns that can be channels unasked, beside which times may stand.
const MOST_COLUMNS: usize = 8;
