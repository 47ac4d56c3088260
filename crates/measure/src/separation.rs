//! Several shots in one record: where quiet separates them.

use crate::records::Channel;
use crate::signal::median;

/// Samples of a block, of which one in a few is compared, with the next: pulses are some ten samples wide,
/// spikes one.
const BLOCK: usize = 32;
const EVERY: usize = 4;
/// Share of a channel's largest swing from which on something is a pulse; and that the largest
/// pulse of every shot has.
const PULSE: f64 = 0.2;
const SIMILAR: f64 = 0.4;
/// Quiet between two shots over quiet between the pulses of one: waves run to and fro in about
/// equal times.
const QUIET: usize = 4;
/// Swing of quiet blocks over which a pulse stands.
const ABOVE_NOISE: f64 = 4.0;

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Content {
    One,
    /// Several, that quiet keeps apart: first sample and end of each.
    Plain(Vec<(usize, usize)>),
    /// Several, but what belongs to which is not plain.
    Mixed,
}

/// A pulse, or a shot: its first and its last block, and the largest swing as a
/// share of its channel's.
#[derive(Clone, Copy, Debug)]
struct Burst {
    from: usize,
    to: usize,
    swing: f64,
    pulses: usize,
}

pub(crate) fn content(channels: &[Channel]) -> Content {
    let samples = channels.first().map_or(0, |one| one.volts.len());
    let mut shares = vec![0.0_f64; samples.div_ceil(BLOCK)];
    for channel in channels {
        for (share, own) in shares.iter_mut().zip(shares_of(&channel.volts)) {
            *share = share.max(own);
        }
    }
    let loud = shares.iter().enumerate().filter(|(_, share)| **share > 0.0);
    let blocks = loud.map(|(at, share)| Burst { from: at, to: at, swing: *share, pulses: 1 });
    let pulses = joined(blocks, 3, |_| 0);
    let Some(quiet) = division(&pulses) else {
        return Content::One;
    };
    let bursts = joined(pulses.into_iter(), quiet, |burst| burst.pulses);
    // The first and the wall's pulse at least make a shot.
    let whole = |burst: &&Burst| burst.pulses > 1 && burst.swing >= SIMILAR;
    match bursts.iter().filter(whole).count() {
        0 | 1 => Content::One,
        count if count == bursts.len() => Content::Plain(ranges(&bursts, quiet, samples)),
        _ => Content::Mixed,
    }
}

/// Largest swing in every block as a share of the largest of all; 0 without a pulse.
fn shares_of(volts: &[f64]) -> Vec<f64> {
    let stride = volts.len().div_ceil(4096).max(1);
    let some: Vec<f64> = volts.iter().copied().step_by(stride).collect();
    let middle = median(&some).unwrap_or(0.0);
    let off = |volt: f64| (volt - middle).abs();
    let swing = |block: &[f64]| {
        let pairs = block.windows(2).step_by(EVERY);
        pairs.map(|pair| off(pair[0]).min(off(pair[1]))).fold(0.0, f64::max)
    };
    let swings: Vec<f64> = volts.chunks(BLOCK).map(swing).collect();
    let largest = swings.iter().copied().fold(0.0, f64::max);
    let noise = median(&swings).unwrap_or(0.0);
    let level = (PULSE * largest).max(ABOVE_NOISE * noise);
    let share = |swing: f64| if swing > level { swing / largest } else { 0.0 };
    swings.into_iter().map(share).collect()
}

/// Joins what is less than so many blocks apart.
fn joined(
    parts: impl Iterator<Item = Burst>,
    apart: usize,
    pulses: impl Fn(&Burst) -> usize,
) -> Vec<Burst> {
    let mut all: Vec<Burst> = Vec::new();
    for part in parts {
        match all.last_mut() {
            Some(last) if part.from - last.to < apart => {
                last.to = part.to;
                last.swing = last.swing.max(part.swing);
                last.pulses += pulses(&part);
            }
            _ => all.push(part),
        }
    }
    all
}

/// The least quiet between shots: where the quiet between pulses grows most from
/// one to the next longer one, if it grows enough.
fn division(pulses: &[Burst]) -> Option<usize> {
    let quiet = pulses.windows(2).map(|pair| pair[1].from - pair[0].to);
    let mut quiet: Vec<usize> = quiet.collect();
    quiet.sort_unstable();
    let growth = |pair: &&[usize]| pair[1] as f64 / pair[0] as f64;
    let most = quiet.windows(2).max_by(|a, b| growth(a).total_cmp(&growth(b)))?;
    (most[1] >= QUIET * most[0]).then_some(most[1])
}

/// Where shots of equal length begin and end, with a margin before the first
/// pulse and after the longest shot's last.
fn ranges(bursts: &[Burst], quiet: usize, samples: usize) -> Vec<(usize, usize)> {
    let longest = bursts.iter().map(|burst| burst.to - burst.from + 1).max();
    let longest = longest.unwrap_or(1);
    let margin = longest.min(quiet / 2);
    let range = |burst: &Burst| {
        let from = burst.from.saturating_sub(margin) * BLOCK;
        (from, (from + (longest + 2 * margin) * BLOCK).min(samples))
    };
    bursts.iter().map(range).collect()
}

#[cfg(test)]
#[path = "tests/separation.rs"]
mod tests;
