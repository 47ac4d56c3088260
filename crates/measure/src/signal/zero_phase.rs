//! Low-pass without delay: a Butterworth filter run forward and backward.

use crate::signal::error::{SignalError, all_finite};

/// A low-pass to be run over samples in both directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowPass {
    /// Where one run has lost 3 dB; both together lose 6 dB there.
    pub cutoff_hz: f64,
    /// Order of one run: 2 or 4.
    pub order: usize,
}

/// A second-order section with gain 1 at rest, transposed direct form II.
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

impl LowPass {
    /// The filtered samples, as many as were given, none delayed.
    ///
    /// Butterworth sections by the bilinear transform with its frequency
    /// prewarped, run forward, then backward, over samples that are continued
    /// beyond either end by 3 (order + 1) samples turned about the end one.
    /// Noise after it is no longer white: its neighbours go together.
    ///
    /// # Errors
    /// Order not 2 or 4; cutoff not between 0 and half the sampling rate; too
    /// few or not finite samples.
    pub fn apply(&self, samples: &[f64], interval_s: f64) -> Result<Vec<f64>, SignalError> {
        let sections = self.sections(interval_s)?;
        let edge = 3 * (self.order + 1);
        SignalError::enough(samples.len(), edge + 1)?;
        all_finite(samples)?;
        let mut all = continued(samples, edge);
        for _direction in 0..2 {
            for section in &sections {
                section.run(&mut all);
            }
            all.reverse();
        }
        all.truncate(edge + samples.len());
        all.drain(..edge);
        Ok(all)
    }

    fn sections(&self, interval_s: f64) -> Result<Vec<Section>, SignalError> {
        SignalError::positive("sampling interval in s", interval_s)?;
        let turns = self.cutoff_hz * interval_s;
        if !(turns > 0.0 && turns < 0.5) {
            return Err(SignalError::Option {
                name: "cutoff of the low-pass in Hz",
                value: self.cutoff_hz,
                expected: "a number between 0 and half the sampling rate",
            });
        }
        if self.order != 2 && self.order != 4 {
            return Err(SignalError::Option {
                name: "order of the low-pass",
                value: self.order as f64,
                expected: "2 or 4",
            });
        }
        let order = self.order as f64;
        let angle = |i: usize| std::f64::consts::PI * (2 * i + 1) as f64 / (2.0 * order);
        let pairs = 0..self.order / 2;
        Ok(pairs.map(|i| Section::new(turns, angle(i).sin())).collect())
    }
}

impl Section {
    /// Poles at `damping` = −cos of their angle on the unit circle of the analogue filter.
    fn new(turns: f64, damping: f64) -> Self {
        let k = (std::f64::consts::PI * turns).tan();
        let norm = (1.0 + 2.0 * damping * k + k * k).recip();
        let b0 = k * k * norm;
        let a2 = (1.0 - 2.0 * damping * k + k * k) * norm;
        Self {
            b: [b0, 2.0 * b0, b0],
            a: [2.0 * (k * k - 1.0) * norm, a2],
        }
    }

    /// Filters in place, as if the first sample had lasted for ever before.
    fn run(&self, samples: &mut [f64]) {
        let first = samples.first().copied().unwrap_or(0.0);
        let mut z1 = first * (1.0 - self.b[0]);
        let mut z2 = first * (self.b[2] - self.a[1]);
        for sample in samples {
            let x = *sample;
            let y = self.b[0] * x + z1;
            z1 = self.b[1] * x - self.a[0] * y + z2;
            z2 = self.b[2] * x - self.a[1] * y;
            *sample = y;
        }
    }
}

/// Samples with `edge` more at either end, turned by half a turn about the end sample.
fn continued(samples: &[f64], edge: usize) -> Vec<f64> {
    let n = samples.len();
    let turned = |end: f64, at: usize| 2.0 * end - samples[at];
    let before = (0..edge).map(|i| turned(samples[0], edge - i));
    let after = (0..edge).map(|i| turned(samples[n - 1], n - 2 - i));
    before.chain(samples.iter().copied()).chain(after).collect()
}
