//! Clipped tops, digitiser steps, and competing maxima of the pulses found.

use super::channel::{Smoothed, SmoothedMaximum, VALLEY};
use super::select::NARROWEST;
use super::{
    Channels, CompetingMaximum, DigitiserRange, FindOptions, Found, Pulse, PulseKind, QualityFlag,
};
use crate::signal::Estimate;
use crate::signal::pick::{ChannelView, clipped_top, maximum_by_fit};
use crate::signal::statistics::extremes;

/// Share of a whole pulse's height below which no other pulse of its channel is clipped.
const AS_HIGH: f64 = 0.9;

/// Flags clipped pulses and those of few digitiser steps, from the samples as they were recorded:
/// filters leave neither ends of the range nor steps.
pub(super) fn flag_digitiser(found: &mut Found, recorded: Channels<'_>, options: &FindOptions) {
    let channels = recorded.both();
    let own = channels.map(extremes);
    let ranges = options.ranges(recorded);
    let steps = digitiser_steps(found, recorded);
    let mut flags = Vec::new();
    for pulse in found.pulses_mut() {
        let which = usize::from(pulse.kind == PulseKind::Wall);
        let (from, to) = pulse.extent;
        let inside = channels[which].get(from..=to).unwrap_or_default();
        let run = top_run(pulse, steps[which]);
        if let Some(range) = saturated(inside, own[which], run, ranges[which]) {
            flags.push(QualityFlag::Saturation(pulse.kind));
            let first = inside.iter().position(|sample| range.clips(*sample));
            let last = inside.iter().rposition(|sample| range.clips(*sample));
            pulse.clipped = first.zip(last).map(|(first, last)| (from + first, from + last));
        }
    }
    (found.sensor.step, found.wall_channel.step) = (steps[0], steps[1]);
    let coarse =
        found.pulses().filter(|pulse| found.normalisation(pulse.kind).is_coarse(pulse.height));
    let coarse: Vec<PulseKind> = coarse.map(|pulse| pulse.kind).collect();
    flags.extend(coarse.iter().copied().map(QualityFlag::CoarseSteps));
    flags.extend(clip_by_shape(found, recorded, &coarse));
    found.flag(flags);
    // A top of few steps is flat by itself.
    for pulse in found.pulses_mut() {
        let which = usize::from(pulse.kind == PulseKind::Wall);
        if ranges[which].is_none() && coarse.contains(&pulse.kind) {
            pulse.clipped = None;
        }
    }
}

/// Marks the tops that something before the digitiser has clipped.
fn clip_by_shape(
    found: &mut Found,
    recorded: Channels<'_>,
    coarse: &[PulseKind],
) -> Vec<QualityFlag> {
    let normalisations = [found.sensor, found.wall_channel];
    let separate = !recorded.is_summed();
    let channel = |pulse: &Pulse| usize::from(pulse.kind == PulseKind::Wall && separate);
    let whole = found.pulses_mut().filter(|p| p.clipped.is_none());
    let mut whole: Vec<&mut Pulse> = whole.collect();
    let mut highest = [0.0_f64; 2];
    for pulse in &mut whole {
        let which = usize::from(pulse.kind == PulseKind::Wall);
        let view = ChannelView::new(recorded, pulse.kind, normalisations[which]);
        if !coarse.contains(&pulse.kind) {
            pulse.clipped = clipped_top(&view, pulse);
        }
        if pulse.clipped.is_none() {
            highest[channel(pulse)] = highest[channel(pulse)].max(pulse.height);
        }
    }
    let mut flags = Vec::new();
    for pulse in whole {
        // One channel ends at one level.
        let end = AS_HIGH * highest[channel(pulse)];
        pulse.clipped = pulse.clipped.filter(|_| pulse.height > end);
        flags.extend(pulse.clipped.map(|_| QualityFlag::Saturation(pulse.kind)));
    }
    flags
}

/// The digitiser's step in both channels: of samples that are not rounded, the least difference of some
/// hundred is far below their noise.
fn digitiser_steps(found: &Found, recorded: Channels<'_>) -> [f64; 2] {
    let mut steps = [f64::INFINITY; 2];
    for pulse in found.pulses() {
        let which = usize::from(pulse.kind == PulseKind::Wall);
        let (from, to) = pulse.extent;
        let inside = recorded.both()[which].get(from..=to).unwrap_or_default();
        let differences = inside.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let step = differences.filter(|d| *d > 0.0);
        steps[which] = steps[which].min(step.fold(f64::INFINITY, f64::min));
    }
    if recorded.is_summed() {
        steps = [steps[0].min(steps[1]); 2];
    }
    steps.map(|step| if step.is_finite() { step } else { 0.0 })
}

/// Most samples of a whole pulse at its highest step: a top falls by one step within ± 0.6 widths over
/// the root of its steps as a Gaussian does, the flattest computed ones within ± 0.8.
fn top_run(pulse: &Pulse, step: f64) -> usize {
    let share = (1.7 * (step / pulse.height).abs().sqrt()).max(0.15);
    (share * pulse.width_samples).max(4.0) as usize
}

/// The range at whose end a pulse has a run of as many samples: the record's extremes, or the known one,
/// of which a single sample is enough.
fn saturated(
    inside: &[f64],
    (low, high): (f64, f64),
    run: usize,
    known: Option<DigitiserRange>,
) -> Option<DigitiserRange> {
    let (range, shortest) = known.map_or((DigitiserRange { low, high }, run), |range| (range, 1));
    range.clips_run(inside, shortest).then_some(range)
}

/// Standard errors below the largest within which maxima of the smoothed signal are compared by
/// fits: of both the error is 1.4 times the remaining noise.
const CLOSE: f64 = 7.0;
/// Most of them: a reflected pulse has two or three fragments of like height.
const MOST: usize = 2;
/// Share of the width within which two maxima are noise, or digitiser steps, on one top, unless the
/// signal falls by a share of the lower one between them.
const APART: f64 = 0.5;
/// Share of the fall that makes a pulse of a maximum which is enough of a valley between fragments: they
/// are as high as each other, and noise fills it.
const VALLEY_DEPTH: f64 = 0.5;
/// Widths of the first pulse from the largest within which such fragments are: farther off, noise has as
/// high ones.
const FRAGMENTS: f64 = 3.0;
/// Half widths of the rise before a maximum where its pulse has hardly begun.
const BEGUN: f64 = 2.6;
/// Standard errors of a difference in height beyond which it is no chance: 0.13 %.
const SIGNIFICANT: f64 = 3.0;

/// The highest others of a pulse's maxima, of those that noise could have made the lower. A reflected
/// pulse, which is low, may have fragments without a valley that noise leaves.
pub(super) fn other_maxima(
    smoothed: &Smoothed<'_>,
    (from, to): (f64, f64),
    chosen: &SmoothedMaximum,
    kind: PulseKind,
) -> Vec<SmoothedMaximum> {
    let (rise, fall) = smoothed.sides(chosen);
    let under = smoothed.height(chosen.at.saturating_sub((BEGUN * rise) as usize)).max(0.0);
    let least = chosen.height - CLOSE * smoothed.noise - under;
    let apart = (APART * (rise + fall)) as usize;
    let fall = VALLEY_DEPTH * smoothed.least_fall;
    let reach = FRAGMENTS * smoothed.channel.width;
    // A fragment beside another may stand out of a straight line too little to be a pulse alone; a narrow
    // one is noise, of whose top a fit may make any height.
    let may_be_fragment = |m: &SmoothedMaximum| {
        let (rise, fall) = smoothed.sides(m);
        let is_wide = rise + fall > NARROWEST * smoothed.channel.width;
        is_wide && (m.height > chosen.height || (m.at.abs_diff(chosen.at) as f64) < reach)
    };
    let may_be_pulse = |m: &SmoothedMaximum| {
        let is_own = smoothed.maxima.iter().any(|own| own.at == m.at);
        let is_low = kind == PulseKind::Reflected;
        is_own || is_low && (may_be_fragment(m) || smoothed.is_significant(m))
    };
    let mut near = smoothed.maxima(fall);
    near.retain(|m| {
        let at = m.at as f64;
        at > from && at < to && m.height > least.max(fall) && may_be_pulse(m)
    });
    near.sort_by(|a, b| b.height.total_cmp(&a.height));
    let mut tops = vec![*chosen];
    for maximum in near {
        let is_other = |top: &SmoothedMaximum| {
            let valley = (1.0 - VALLEY) * maximum.height.min(top.height);
            top.at.abs_diff(maximum.at) > apart || smoothed.least(top.at, maximum.at) < valley
        };
        if tops.len() <= MOST && tops.iter().all(is_other) {
            tops.push(maximum);
        }
    }
    tops.split_off(1)
}

/// Compares the heights of pulses found with those of others of their kind, by fits to the samples
/// about each: the highest is the pulse, the next competes with it. Flags pairs that noise leaves
/// ambiguous.
pub(super) fn compare_maxima(found: &mut Found, others: &[Pulse], channels: Channels<'_>) {
    for kind in PulseKind::ALL {
        let own = found.pulses().find(|own| own.kind == kind);
        let Some(own) = own.filter(|own| own.clipped.is_none()).copied() else {
            continue;
        };
        let others = others.iter().filter(|other| other.kind == kind);
        let pulses: Vec<Pulse> = std::iter::once(own).chain(others.copied()).collect();
        if pulses.len() < 2 {
            continue;
        }
        let mut tops: Vec<(Pulse, f64, Estimate)> = Vec::new();
        for pulse in pulses {
            let (time, height) = top_by_fit(found, &pulse, channels);
            // A fit to the lower one may end at the higher.
            let is_same = |(other, at, _): &(Pulse, f64, Estimate)| {
                (at - time).abs() < APART * other.at.abs_diff(pulse.at) as f64
            };
            if !tops.iter().any(is_same) {
                tops.push((pulse, time, height));
            }
        }
        tops.sort_by(|a, b| b.2.value.total_cmp(&a.2.value));
        let [(first, at, most), (pulse, other, next), ..] = tops[..] else {
            continue;
        };
        let reflected = kind == PulseKind::Reflected;
        let superposition = match found.wall.filter(|_| reflected) {
            Some(wall) => ChannelView::new(channels, kind, *found.normalisation(kind))
                .after(&wall)
                .difference_under(&first, [at, other]),
            None => 0.0,
        };
        if let Some(own) = found.pulses_mut().find(|own| own.kind == kind) {
            *own = first;
        }
        let lower =
            Estimate { value: most.value - next.value, sigma: most.sigma.hypot(next.sigma) };
        found.competing.push(CompetingMaximum { pulse, lower, superposition });
        let sigma = lower.sigma.hypot(superposition);
        if lower.value < SIGNIFICANT * sigma || lower.value <= 0.0 {
            found.flag([QualityFlag::AmbiguousMaximum(kind)]);
        }
    }
}

/// Sample and height of a maximum by a fit to the samples about it; those of the smoothed signal
/// where none succeeds.
fn top_by_fit(found: &Found, pulse: &Pulse, channels: Channels<'_>) -> (f64, Estimate) {
    let normalisation = *found.normalisation(pulse.kind);
    let view = ChannelView::new(channels, pulse.kind, normalisation);
    let (at, value, sigma) = maximum_by_fit(&view, pulse)
        .map_or((pulse.at as f64, pulse.height, normalisation.baseline.noise), |picked| {
            (picked.time_s, picked.height, picked.height_sigma)
        });
    (at, Estimate { value, sigma })
}
