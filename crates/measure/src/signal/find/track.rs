//! A first look at one channel: which way is up, where quiet ends.

use super::digitiser::extremes;
use super::{Polarity, Upright};
use crate::signal::Level;
use crate::signal::error::{SignalError, all_finite};
use crate::signal::level::{NORMAL_MAD, level, median, median_and_spread};

/// Samples averaged for the first look: noise is halved, a pulse of some ten samples stays.
pub(super) const BLOCK: usize = 4;
/// Least samples for a baseline of its own.
const QUIET: usize = 32;
/// Samples before the first pulse that are looked at: more would tell no more.
const ENOUGH: usize = 8192;
/// Share of the largest swing that the first pulse passes: the wall's is at
/// most twice as high in one row of equal beads.
const FIRST: f64 = 0.25;
/// Swing over noise below which nothing is a pulse: among 10⁶ blocks of noise the
/// largest is at 5.
const LEAST_SWING: f64 = 6.0;

/// One channel with its baseline, noise and direction.
pub(super) struct Track<'a> {
    pub(super) samples: &'a [f64],
    pub(super) upright: Upright,
    /// Means of every `BLOCK` samples.
    pub(super) blocks: Vec<f64>,
    /// Sample at which the first pulse passes a quarter of the largest swing.
    pub(super) first: usize,
    /// Rough full width at half maximum of the first pulse in samples.
    pub(super) width: f64,
}

impl<'a> Track<'a> {
    pub(super) fn new(samples: &'a [f64], polarity: Polarity) -> Result<Self, SignalError> {
        SignalError::enough(samples.len(), 16 * BLOCK)?;
        let (low, high) = extremes(samples);
        let blocks = blocks(samples, (low, high))?;
        if low == high {
            return Err(SignalError::Constant { value: low });
        }
        let stride = blocks.len().div_ceil(2048);
        let some: Vec<f64> = blocks.iter().copied().step_by(stride).collect();
        let (offset, _) = median_and_spread(&some).unwrap_or_default();
        let (sign, swing) = direction(&blocks, offset, polarity);
        let above = |block: &f64| sign * (block - offset) > FIRST * swing;
        let crosses = |pair: &[f64]| pair.iter().all(above);
        let cross = blocks.windows(2).position(crosses).unwrap_or(0);
        let width = rough_width(&blocks, cross, |b| sign * (b - offset));
        let quiet = (cross as f64 - 1.5 * width).max(0.0) as usize * BLOCK;
        let level = quiet_level(&samples[..quiet], samples, offset)?;
        let track = Self {
            samples,
            upright: Upright {
                sign,
                level,
                step: 0.0,
            },
            blocks,
            first: cross * BLOCK,
            width: width * BLOCK as f64,
        };
        track.significant(swing).map(|()| track)
    }

    /// The largest swing must stand out of the noise of blocks.
    fn significant(&self, swing: f64) -> Result<(), SignalError> {
        let level = &self.upright.level;
        let broad = level.broad_noise() / (BLOCK as f64).sqrt();
        let swing_to_noise = swing / broad.min(level.noise);
        let found = swing > 0.0 && (swing_to_noise >= LEAST_SWING || level.noise == 0.0);
        found
            .then_some(())
            .ok_or(SignalError::NoPulse { swing_to_noise })
    }

    /// Height of a block above the baseline.
    pub(super) fn block_height(&self, block: usize) -> f64 {
        let value = self.blocks.get(block).copied();
        value.map_or(0.0, |value| self.upright.height(value))
    }
}

/// Means of `BLOCK` samples each; what is left over at the end counts for nothing.
fn blocks(samples: &[f64], (low, high): (f64, f64)) -> Result<Vec<f64>, SignalError> {
    let (whole, rest) = samples.as_chunks::<BLOCK>();
    let scale = (BLOCK as f64).recip();
    let means: Vec<f64> = whole
        .iter()
        .map(|[a, b, c, d]| ((a + b) + (c + d)) * scale)
        .collect();
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

/// Level before the first pulse; a rough one of the whole record if there is no such part.
fn quiet_level(quiet: &[f64], samples: &[f64], rough: f64) -> Result<Level, SignalError> {
    let quiet = &quiet[quiet.len().saturating_sub(ENOUGH)..];
    if quiet.len() >= QUIET {
        return level(quiet);
    }
    let stride = samples.len().div_ceil(4096);
    let steps = samples.windows(2).step_by(stride);
    let steps: Vec<f64> = steps.map(|pair| (pair[1] - pair[0]).abs()).collect();
    let typical = median(&steps).unwrap_or(0.0);
    Ok(Level {
        offset: rough,
        noise: NORMAL_MAD * typical / std::f64::consts::SQRT_2,
        correlation: 1.0,
        quiet_samples: 0,
    })
}
