//! One shot's samples, kept to be looked at.

use crate::Shot;
use crate::records::Record;

/// A shot with its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Example {
    /// What was measured.
    pub shot: Shot,
    /// Names of the channels.
    pub names: Vec<String>,
    /// Samples in V, a channel each.
    pub volts: Vec<Vec<f64>>,
}

impl Example {
    /// A shot of a record, of which it may be a part.
    pub(crate) fn of(shot: &Shot, record: &Record, range: Option<(usize, usize)>) -> Self {
        let (from, to) = range.unwrap_or((0, record.len()));
        let channels = record.part(from, to - from).channels;
        Self {
            shot: shot.clone(),
            volts: channels.iter().map(|c| c.samples.volts()).collect(),
            names: channels.into_iter().map(|c| c.name).collect(),
        }
    }
}
