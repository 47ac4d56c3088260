//! One shot's samples, kept to be looked at.

use crate::Shot;

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
