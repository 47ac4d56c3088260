//! A stretch of a channel, smoothed as far as its noise asks for, and its maxima.

use std::ops::Range;

use super::track::Track;
use crate::signal::running;

/// Largest noise, as a share of the highest pulse, that is left alone.
const CLEAN: f64 = 0.005;
/// Longest average, as a share of the first pulse's width.
const LONGEST: f64 = 0.25;

/// Heights above the baseline of a stretch, smoothed without delay.
pub(super) struct Smooth {
    /// Sample of the first value.
    pub(super) first: usize,
    pub(super) values: Vec<f64>,
    /// Standard deviation of what noise is left.
    pub(super) noise: f64,
    /// Samples in each of the two averages.
    length: usize,
}

/// A maximum of the smoothed stretch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Maximum {
    pub(super) at: usize,
    pub(super) height: f64,
}

impl Smooth {
    pub(super) fn of(track: &Track<'_>, stretch: Range<usize>, highest: f64) -> Self {
        let end = stretch.end.min(track.samples.len());
        let first = stretch.start.min(end);
        let raw = track.samples[first..end].iter();
        let values: Vec<f64> = raw.map(|x| track.upright.height(*x)).collect();
        let level = &track.upright.level;
        let length = length(level.noise / highest, track.width);
        let n = length as f64;
        // Two averages of n weigh as a triangle, whose squares sum to this.
        let white = ((2.0 * n * n + 1.0) / (3.0 * n * n * n)).sqrt();
        Self {
            first,
            values: running::triangle(&values, length),
            // Of noise whose neighbours differ in sign, averages leave what their ends do.
            noise: level
                .noise
                .min((level.broad_noise() * white).max(level.noise * n.powf(-1.5))),
            length,
        }
    }

    /// Maxima from which the signal falls by `drop` on both sides, in order.
    pub(super) fn maxima(&self, drop: f64) -> Vec<Maximum> {
        let mut maxima = Vec::new();
        let (mut top, mut valley, mut rising) = (0, f64::INFINITY, true);
        for (i, value) in self.values.iter().enumerate() {
            if rising && *value > self.values[top] {
                top = i;
            } else if rising && *value < self.values[top] - drop {
                maxima.push(top);
                (valley, rising) = (*value, false);
            } else if !rising && *value > valley + drop {
                (top, rising) = (i, true);
            } else {
                valley = valley.min(*value);
            }
        }
        // What only falls from the start on was cut off, not found.
        maxima.retain(|top| *top > 0);
        let maximum = |top: usize| Maximum {
            at: self.first + top,
            height: self.values[top],
        };
        maxima.into_iter().map(maximum).collect()
    }

    /// Smoothed height at a sample; 0 outside.
    pub(super) fn height(&self, at: usize) -> f64 {
        let value = at.checked_sub(self.first).and_then(|i| self.values.get(i));
        value.copied().unwrap_or(0.0)
    }

    /// Both sides of the full width at half maximum about a maximum, the
    /// smoothing's share taken off.
    pub(super) fn sides(&self, of: &Maximum) -> (f64, f64) {
        let (left, right) = self.reach(of, 0.5 * of.height);
        let seen = right - left;
        let n = self.length as f64;
        // Variances add: two averages have (n² − 1)/6; a bell's width is 2.355 deviations.
        let added = 5.545 * (n * n - 1.0) / 6.0;
        let share = (1.0 - added / (seen * seen)).max(0.25).sqrt();
        let top = of.at as f64;
        (share * (top - left), share * (right - top))
    }

    /// Where the signal last falls to `height` on either side of a maximum, between samples.
    pub(super) fn reach(&self, of: &Maximum, height: f64) -> (f64, f64) {
        let top = of.at.saturating_sub(self.first);
        let below = |i: &usize| self.values[*i] < height;
        let left = (0..top).rev().find(below);
        let right = (top..self.values.len()).find(below);
        let between = |out: usize, inner: usize| {
            let (low, high) = (self.values[out], self.values[inner]);
            let part = ((height - low) / (high - low)).clamp(0.0, 1.0);
            out as f64 + part * (inner as f64 - out as f64)
        };
        let left = left.map_or(0.0, |i| between(i, i + 1));
        let last = self.values.len().saturating_sub(1) as f64;
        let right = right.filter(|i| *i > 0).map_or(last, |i| between(i, i - 1));
        (self.first as f64 + left, self.first as f64 + right)
    }
}

/// Odd number of samples in each average.
fn length(relative_noise: f64, width: f64) -> usize {
    let wanted = (relative_noise / CLEAN).powi(2);
    let most = (LONGEST * width).max(1.0);
    let length = if wanted < most { wanted } else { most };
    (length as usize) | 1
}
