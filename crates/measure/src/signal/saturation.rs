//! Runs of samples at an end of the digitiser's range.

/// The two ends of a digitiser's range, in the samples' unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rails {
    /// Nothing below this can be recorded.
    pub low: f64,
    /// Nothing above this can be recorded.
    pub high: f64,
}

impl Rails {
    /// Whether a sample stands on a rail or beyond, to 10⁻⁹ of the range: converting
    /// digits to volts rounds.
    #[must_use]
    pub fn hold(&self, sample: f64) -> bool {
        let range = self.high - self.low;
        let rounding = if range.is_finite() { 1e-9 * range } else { 0.0 };
        sample <= self.low + rounding || sample >= self.high - rounding
    }
}

/// Whether at least `shortest` samples in a row stand on or beyond a rail.
///
/// Without knowledge of the digitiser give the record's own extremes and a
/// `shortest` that no round top reaches: a bell of width w (full width at
/// half maximum, in samples) and H steps high has some 0.9 w/√H equal samples.
pub(crate) fn has_run(samples: &[f64], rails: Rails, shortest: usize) -> bool {
    let mut runs = samples.chunk_by(|a, b| rails.hold(*a) == rails.hold(*b));
    runs.any(|run| run.len() >= shortest && rails.hold(run[0]))
}

#[cfg(test)]
#[path = "tests/saturation.rs"]
mod tests;
