//! What the flanks of a clipped pulse tell of the whole one, roughly.

use super::Sight;
use super::normal::{MOST, Normal};
use crate::signal::Pulse;

/// Share of the height at which it is clipped down to which flanks are looked at.
const FOOT: f64 = 0.25;

impl Sight<'_> {
    /// First and last sample about a pulse's maximum above a height, single ones below it aside.
    pub(super) fn run_above(&self, pulse: &Pulse, height: f64) -> (usize, usize) {
        let is_above = |at: usize| {
            let sample = self.samples.get(at);
            sample.is_some_and(|x| self.upright.height(*x) > height)
        };
        let (mut first, mut last) = (pulse.at, pulse.at);
        while first > 1 && (is_above(first - 1) || is_above(first - 2)) {
            first -= 1;
        }
        while is_above(last + 1) || is_above(last + 2) {
            last += 1;
        }
        (first, last)
    }
}

/// Fewest samples of the longer flank that are looked at.
const FEWEST: usize = 4;

/// A bell through the flanks of a clipped pulse; in samples.
pub(super) struct Flanks {
    /// Its maximum.
    pub(super) at: f64,
    height: f64,
    /// Full width at half maximum.
    width: f64,
}

impl Flanks {
    /// By the parabola through the logarithms of the samples beside the clipped ones. Weights
    /// are squares of heights: so much less is the logarithm's noise.
    pub(super) fn of(sight: &Sight<'_>, pulse: &Pulse) -> Option<Self> {
        let clipped = pulse.clipped?;
        let middle = 0.5 * (clipped.0 as f64 + clipped.1 as f64);
        let half = pulse.width_samples.max(4.0);
        let mut normal = Normal::new(3);
        for (sample, height) in beside(sight, pulse, clipped) {
            let u = (sample - middle) / half;
            let mut row = [0.0; MOST];
            row[..3].copy_from_slice(&[height, height * u, height * u * u]);
            normal.add(&row, height * height.ln());
        }
        let [constant, slope, bend, ..] = normal.solve()?.values;
        let u = -0.5 * slope / bend;
        let found = Self {
            at: middle + half * u,
            height: (constant + 0.5 * slope * u).exp(),
            width: 2.0 * half * (std::f64::consts::LN_2 / -bend).sqrt(),
        };
        let inside = (found.at - middle).abs() < half && found.height >= pulse.height;
        (bend < 0.0 && inside).then_some(found)
    }

    /// The pulse as it would be without a digitiser's end.
    pub(super) fn pulse(&self, clipped: &Pulse) -> Pulse {
        Pulse {
            height: self.height,
            width_samples: self.width,
            sides_samples: (0.5 * self.width, 0.5 * self.width),
            ..*clipped
        }
    }

    /// From the maximum to where the flanks are at their feet.
    pub(super) fn half(&self, clipped: &Pulse) -> f64 {
        let foot = FOOT * clipped.height / self.height;
        let deep = (-foot.ln() / std::f64::consts::LN_2).sqrt();
        (0.5 * self.width * deep).max(4.0)
    }
}

/// Samples and heights from the clipped ones to the foot on the steeper side, and as far on the other:
/// what a pulse trails behind, or stands on, is no flank.
fn beside(sight: &Sight<'_>, pulse: &Pulse, (first, last): (usize, usize)) -> Vec<(f64, f64)> {
    let foot = FOOT * pulse.height;
    let height = |at: &usize| sight.samples.get(*at).map(|x| sight.upright.height(*x));
    let tall = |at: usize| Some((at as f64, height(&at).filter(|height| *height > foot)?));
    let before = (0..first).rev().filter(|at| !pulse.is_clipped(*at));
    let after = (last..sight.samples.len()).filter(|at| !pulse.is_clipped(*at));
    let before: Vec<(f64, f64)> = before.map_while(tall).collect();
    let after: Vec<(f64, f64)> = after.map_while(tall).collect();
    let shorter = before.len().min(after.len()).max(FEWEST);
    let both = before.into_iter().take(shorter);
    both.chain(after.into_iter().take(shorter)).collect()
}
