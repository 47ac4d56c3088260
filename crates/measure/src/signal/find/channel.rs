//! One channel: polarity, baseline, its first pulse, and smoothed stretches with their maxima.

use super::{Normalisation, Polarity, Pulse, PulseKind};
use crate::error::{MeasureError, Result, all_finite};
use crate::signal::baseline::{Baseline, baseline};
use crate::signal::filters::triangular_mean;
use crate::signal::statistics::{NORMAL_MAD, extremes, mean, median, median_and_spread};
use std::ops::Range;

/// Samples averaged for a coarse view: noise is halved, a pulse of some ten samples stays.
pub(super) const BLOCK: usize = 4;
const QUIET: usize = 32;
/// Most samples before the first pulse that the baseline is computed from.
const ENOUGH: usize = 8192;
/// Share of the largest swing that the first pulse exceeds: the wall's is at most twice as high in
/// one row of equal beads.
pub(super) const FIRST: f64 = 0.25;
/// The same where that finds no three pulses: the wall's sensor may be six times as sensitive.
pub(super) const FIRST_LOW: f64 = 0.08;
/// The same where that takes hum for a pulse.
pub(super) const FIRST_HIGH: f64 = 0.4;
/// Swing over noise below which nothing is a pulse: among 10⁶ blocks of noise the largest is at 5.
const LEAST_SWING: f64 = 6.0;
/// Largest noise, as a share of the highest pulse, that is not smoothed.
const CLEAN: f64 = 0.005;
/// Longest average, as a share of the first pulse's width.
const LONGEST: f64 = 0.25;
/// Share of a maximum's height by which the signal rises again beyond a valley that parts fragments.
pub(super) const VALLEY: f64 = 0.2;

pub(super) struct ChannelSignal<'a> {
    pub(super) samples: &'a [f64],
    pub(super) normalisation: Normalisation,
    blocks: Vec<f64>,
    /// Sample at which the first pulse passes a quarter of the largest swing.
    pub(super) first: usize,
    /// Rough full width at half maximum of the first pulse in samples.
    pub(super) width: f64,
}

impl<'a> ChannelSignal<'a> {
    /// The first pulse exceeds this share of the largest swing.
    pub(super) fn new(samples: &'a [f64], polarity: Polarity, share: f64) -> Result<Self> {
        MeasureError::enough(samples.len(), 16 * BLOCK)?;
        let (low, high) = extremes(samples);
        let blocks = blocks(samples, (low, high))?;
        if low == high {
            return Err(MeasureError::Constant(low));
        }
        let stride = blocks.len().div_ceil(2048);
        let some: Vec<f64> = blocks.iter().copied().step_by(stride).collect();
        let (offset, _) = median_and_spread(&some).unwrap_or_default();
        let (sign, swing) = direction(&blocks, offset, polarity);
        let above = |block: &f64| sign * (block - offset) > share * swing;
        let crosses = |pair: &[f64]| pair.iter().all(above);
        let cross = blocks.windows(2).position(crosses).unwrap_or(0);
        let width = rough_width(&blocks, cross, |b| sign * (b - offset));
        let quiet = (cross as f64 - 1.5 * width).max(0.0) as usize * BLOCK;
        let baseline = quiet_baseline(&samples[..quiet], samples, offset)?;
        // The largest swing must stand out of the noise of blocks.
        let broad = baseline.broad_noise() / (BLOCK as f64).sqrt();
        let swing_to_noise = swing / broad.min(baseline.noise);
        if !(swing > 0.0 && (swing_to_noise >= LEAST_SWING || baseline.noise == 0.0)) {
            return Err(MeasureError::NoPulse(swing_to_noise));
        }
        Ok(Self {
            samples,
            normalisation: Normalisation { sign, baseline, step: 0.0 },
            blocks,
            first: cross * BLOCK,
            width: width * BLOCK as f64,
        })
    }

    pub(super) fn largest_block(&self, from: f64, to: f64) -> Option<(usize, f64)> {
        let block = |sample: f64| (sample / BLOCK as f64).clamp(0.0, self.blocks.len() as f64);
        let blocks = self.blocks.iter().enumerate().take(block(to) as usize);
        let heights = blocks.map(|(at, mean)| (at * BLOCK, self.normalisation.height(*mean)));
        heights
            .skip(block(from) as usize)
            .reduce(|best, next| if next.1 > best.1 { next } else { best })
    }
}

/// Means of `BLOCK` samples each; what is left over at the end is not used.
fn blocks(samples: &[f64], (low, high): (f64, f64)) -> Result<Vec<f64>> {
    let (whole, rest) = samples.as_chunks::<BLOCK>();
    let scale = (BLOCK as f64).recip();
    let means = whole.iter().map(|[a, b, c, d]| ((a + b) + (c + d)) * scale);
    let means: Vec<f64> = means.collect();
    // A not finite sample makes its block's mean so; opposite giants would cancel.
    if !(means.iter().all(|m| m.is_finite()) && all_finite(rest).is_ok())
        || all_finite(&[low, high]).is_err()
    {
        all_finite(samples)?;
    }
    Ok(means)
}

/// Sign of the larger swing, or of the one asked for, and that swing: as far as
/// two blocks in a row go, so that a spike of a sample or two is none.
fn direction(blocks: &[f64], offset: f64, polarity: Polarity) -> (f64, f64) {
    let (mut low, mut high) = (offset, offset);
    for pair in blocks.windows(2) {
        let (least, most) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
        high = high.max(least);
        low = low.min(most);
    }
    let (up, down) = (high - offset, offset - low);
    match polarity {
        Polarity::Positive => (1.0, up),
        Polarity::Negative => (-1.0, down),
        Polarity::Auto if down > up => (-1.0, down),
        Polarity::Auto => (1.0, up),
    }
}

/// Full width at half maximum, in blocks, of the pulse that rises at `cross`.
fn rough_width(blocks: &[f64], cross: usize, height: impl Fn(f64) -> f64) -> f64 {
    let mut top = cross;
    let mut end = cross;
    for (i, block) in blocks.iter().enumerate().skip(cross) {
        end = i;
        if height(*block) > height(blocks[top]) {
            top = i;
        } else if height(*block) < 0.5 * height(blocks[top]) {
            break;
        }
    }
    let half = 0.5 * height(blocks[top]);
    let before = blocks[..top].iter().rev();
    let rise = before.take_while(|b| height(**b) >= half).count();
    ((end - top + rise) as f64).max(2.0)
}

/// Baseline before the first pulse; a rough one of the whole record if there is no such part, which is
/// off by up to what opened contacts held at rest: as far as it is from the first samples.
fn quiet_baseline(quiet: &[f64], samples: &[f64], rough: f64) -> Result<Baseline> {
    let quiet = &quiet[quiet.len().saturating_sub(ENOUGH)..];
    if quiet.len() >= QUIET {
        return baseline(quiet);
    }
    let stride = samples.len().div_ceil(4096);
    let steps = samples.windows(2).step_by(stride);
    let steps: Vec<f64> = steps.map(|pair| (pair[1] - pair[0]).abs()).collect();
    let typical = median(&steps).unwrap_or(0.0);
    Ok(Baseline {
        offset: rough,
        noise: NORMAL_MAD * typical / std::f64::consts::SQRT_2,
        correlation: 1.0,
        quiet_samples: 0,
        offset_sigma: (mean(&samples[..QUIET / BLOCK]) - rough).abs(),
    })
}

#[derive(Clone, Copy, Debug)]
pub(super) struct SmoothedMaximum {
    pub(super) at: usize,
    pub(super) height: f64,
}

/// Heights above the baseline of a stretch, smoothed without delay, and their maxima.
pub(super) struct Smoothed<'a> {
    pub(super) channel: &'a ChannelSignal<'a>,
    first: usize,
    values: Vec<f64>,
    pub(super) noise: f64,
    length: usize,
    /// Fall on both sides of a maximum by which it stands out of noise and of the highest pulse's hundredths.
    pub(super) least_fall: f64,
    /// Maxima that do.
    pub(super) maxima: Vec<SmoothedMaximum>,
}

impl<'a> Smoothed<'a> {
    /// Smooths a stretch by as much as a pulse of this height requires, and finds its maxima.
    pub(super) fn new(channel: &'a ChannelSignal<'a>, stretch: Range<usize>, height: f64) -> Self {
        let end = stretch.end.min(channel.samples.len());
        let first = stretch.start.min(end);
        let raw = channel.samples[first..end].iter();
        let values: Vec<f64> = raw.map(|x| channel.normalisation.height(*x)).collect();
        let baseline = &channel.normalisation.baseline;
        let wanted = (baseline.noise / height / CLEAN).powi(2);
        let most = (LONGEST * channel.width).max(1.0);
        let length = if wanted < most { wanted } else { most };
        let length = (length as usize) | 1;
        let n = length as f64;
        // Two averages of n weigh as a triangle, whose squares sum to this.
        let white = ((2.0 * n * n + 1.0) / (3.0 * n * n * n)).sqrt();
        // Of noise whose neighbours differ in sign, averages leave what their ends do.
        let left = (baseline.broad_noise() * white).max(baseline.noise * n.powf(-1.5));
        let mut smoothed = Self {
            channel,
            first,
            values: triangular_mean(&values, length),
            noise: baseline.noise.min(left),
            length,
            least_fall: 0.0,
            maxima: Vec::new(),
        };
        let least = (5.0 * smoothed.noise).max(0.005 * height);
        smoothed.least_fall = least;
        smoothed.maxima = smoothed.maxima(least);
        smoothed.maxima.retain(|m| m.height > least);
        smoothed
    }

    /// From before a channel's first pulse on.
    pub(super) fn of_all(channel: &'a ChannelSignal<'a>, end: usize) -> Self {
        let start = channel.first.saturating_sub((3.0 * channel.width) as usize);
        let highest = channel.largest_block(start as f64, end as f64);
        Self::new(channel, start..end, highest.map_or(0.0, |(_, height)| height))
    }

    /// Maxima from which the signal falls by `drop` on both sides, in order.
    pub(super) fn maxima(&self, drop: f64) -> Vec<SmoothedMaximum> {
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
        let maximum =
            |top: usize| SmoothedMaximum { at: self.first + top, height: self.values[top] };
        maxima.into_iter().map(maximum).collect()
    }

    pub(super) fn height(&self, at: usize) -> f64 {
        let value = at.checked_sub(self.first).and_then(|i| self.values.get(i));
        value.copied().unwrap_or(0.0)
    }

    /// The least height between two samples.
    pub(super) fn least(&self, one: usize, other: usize) -> f64 {
        (one.min(other)..=one.max(other)).map(|at| self.height(at)).fold(f64::INFINITY, f64::min)
    }

    /// Both sides of the full width at half maximum about a maximum, corrected for the smoothing; a
    /// side ends before at the valley to another fragment.
    pub(super) fn sides(&self, of: &SmoothedMaximum) -> (f64, f64) {
        let (left, right) = self.reach(of, 0.5 * of.height);
        let seen = right - left;
        let n = self.length as f64;
        // Variances add: two averages have (n² − 1)/6; a bell's width is 2.355 deviations.
        let added = 5.545 * (n * n - 1.0) / 6.0;
        let share = (1.0 - added / (seen * seen)).max(0.25).sqrt();
        let top = of.at as f64;
        let to_valley = |way: &mut dyn Iterator<Item = usize>| {
            self.valley(of, way).map_or(f64::INFINITY, |at| top - at as f64).abs()
        };
        let rise = to_valley(&mut (left.ceil() as usize..of.at).rev());
        let fall = to_valley(&mut (of.at..right as usize));
        ((share * (top - left)).min(rise), (share * (right - top)).min(fall))
    }

    /// On a way away from a maximum, the least height before the signal has risen by a share of the
    /// maximum's that no noise makes.
    fn valley(&self, of: &SmoothedMaximum, mut way: impl Iterator<Item = usize>) -> Option<usize> {
        let rise = (VALLEY * of.height).max(5.0 * self.noise);
        let mut lowest = of.at;
        let rises = way.any(|at| {
            let height = self.height(at);
            if height < self.height(lowest) {
                lowest = at;
            }
            height > self.height(lowest) + rise
        });
        rises.then_some(lowest)
    }

    /// Where the signal last falls to `height` on either side of a maximum, between samples.
    fn reach(&self, of: &SmoothedMaximum, height: f64) -> (f64, f64) {
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

    pub(super) fn pulse(&self, kind: PulseKind, maximum: &SmoothedMaximum) -> Pulse {
        let (from, to) = self.reach(maximum, 0.1 * maximum.height);
        let sides_samples = self.sides(maximum);
        let last = self.channel.samples.len().saturating_sub(1);
        Pulse {
            kind,
            at: maximum.at,
            height: maximum.height,
            width_samples: sides_samples.0 + sides_samples.1,
            sides_samples,
            extent: (from as usize, (to.ceil() as usize).min(last)),
            clipped: None,
        }
    }

    /// Whether another maximum between two samples and within five widths of a pulse has a quarter
    /// of its height or more.
    pub(super) fn is_split(&self, pulse: &Pulse, (from, to): (usize, usize)) -> bool {
        let reach = (5.0 * pulse.width_samples) as usize;
        let from = from.max(pulse.at.saturating_sub(reach));
        let to = to.min(pulse.at + reach);
        let maxima = self.maxima((5.0 * self.noise).max(0.1 * pulse.height));
        let near = maxima.iter().filter(|m| (from..=to).contains(&m.at));
        near.filter(|m| m.height >= 0.25 * pulse.height).count() > 1
    }

    /// Whether the signal between two pulses stays above a tenth of the lower.
    pub(super) fn overlaps(&self, one: &Pulse, other: &Pulse) -> bool {
        let lower = one.height.min(other.height);
        self.least(one.at, other.at) > (0.1 * lower).max(5.0 * self.noise)
    }
}
