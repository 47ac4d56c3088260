//! Spikes: one or two samples that stand out of a signal that is smooth for its noise.

use crate::signal::linear::{LinearSolution, powers};
use crate::signal::statistics::{Estimate, NORMAL_MAD, median};
use std::borrow::Cow;
use std::collections::HashSet;

/// Candidates that are fitted, beside one sample in a hundred.
const MOST_CANDIDATES: usize = 1000;
/// Samples on either side that a sample is interpolated from: many average noise, few follow pulses
/// of few samples.
const REACHES: [usize; 3] = [12, 8, 5];
const DEGREE: usize = 4;
/// Standard errors by which a spike stands out: by chance once in 10¹⁰ samples.
const STANDS_OUT: f64 = 6.5;
/// The same of the screen, which selects one sample of noise in 50,000.
const SCREEN: f64 = 4.5;
const MOST_NEIGHBOURS: usize = 3;
/// Fewer degrees of freedom leave too little of narrow tops to distinguish them from spikes.
const LEAST_FREEDOM: usize = 5;
/// Noise, as a share of the record's range, below which a sample that stands out moves nothing.
const LEAST_NOISE: f64 = 1e-5;
/// A digitiser rounds by up to half a step, its standard deviation is 0.29.
const ROUNDING: f64 = 0.3;

/// Samples in which spikes are replaced by interpolation, and the spikes' numbers.
///
/// A spike has one or two samples; three in a row are left, as a pulse of few samples has. A
/// polynomial is fitted to the neighbours alone, without such as stand out themselves; a
/// sample is a spike if it is off by 6.5 standard errors, of the noise or, where that is more, of
/// what the polynomial leaves of the neighbours. So neither noise nor the top of a narrow pulse is one.
pub fn without_spikes(samples: &[f64]) -> (Cow<'_, [f64]>, Vec<usize>) {
    let Some((noise, candidates)) = screened(samples) else {
        return (Cow::Borrowed(samples), Vec::new());
    };
    let mut repaired = Cow::Borrowed(samples);
    let mut spikes = Vec::new();
    for at in candidates {
        if let Some(value) = expected(&repaired, at, noise) {
            repaired.to_mut()[at] = value;
            spikes.push(at);
        }
    }
    spikes.sort_unstable();
    let runs = spikes.chunk_by(|a, b| b - a == 1);
    let (short, long): (Vec<&[usize]>, Vec<&[usize]>) = runs.partition(|run| run.len() <= 2);
    for at in long.concat() {
        repaired.to_mut()[at] = samples[at];
    }
    (repaired, short.concat())
}

/// Noise of a sample, and samples that are no smooth continuation of their neighbours, the worst
/// first. `None` if there are too few samples.
fn screened(samples: &[f64]) -> Option<(f64, Vec<usize>)> {
    let single = |w: &[f64]| (w[2] - (4.0 * (w[1] + w[3]) - w[0] - w[4]) / 6.0).abs();
    let double =
        |w: &[f64]| (0.5 * (w[2] + w[3]) - 0.78125 * (w[1] + w[4]) + 0.28125 * (w[0] + w[5])).abs();
    // Roots of the sums of squares of their weights, 70/36 and 1.879: what noise makes of them.
    let gains = [(70.0_f64 / 36.0).sqrt(), 1.879_f64.sqrt()];
    let stride = samples.len().div_ceil(4096).max(1);
    let some: Vec<f64> = samples.windows(5).step_by(stride).map(single).collect();
    let noise = (NORMAL_MAD * median(&some)? / gains[0]).max(least_noise(samples, stride));
    let least = gains.map(|gain| SCREEN * gain * noise);
    let mut found: Vec<(usize, f64)> = Vec::new();
    for (at, w) in samples.windows(5).enumerate() {
        let off = single(w);
        if off > least[0] {
            found.push((at + 2, off));
        }
    }
    for (at, w) in samples.windows(6).enumerate() {
        let off = double(w);
        if off > least[1] {
            found.extend([(at + 2, off), (at + 3, off)]);
        }
    }
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    // Where noise comes and goes it would be most of a record.
    found.truncate(MOST_CANDIDATES + samples.len() / 100);
    let mut seen = HashSet::new();
    let candidates = found.into_iter().map(|(at, _)| at);
    Some((noise, candidates.filter(|at| seen.insert(*at)).collect()))
}

/// Noise below which nothing stands out: a digitiser's rounding, and a small share of the range.
fn least_noise(samples: &[f64], stride: usize) -> f64 {
    let pairs = samples.windows(2).step_by(stride);
    let steps = pairs.map(|pair| (pair[1] - pair[0]).abs());
    let step = steps.filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    let rounding = if step.is_finite() { ROUNDING * step } else { 0.0 };
    let from_first = samples.iter().map(|x| (x - samples[0]).abs());
    rounding.max(LEAST_NOISE * from_first.fold(0.0, f64::max))
}

/// What a sample should be, if it is a spike.
fn expected(samples: &[f64], at: usize, noise: f64) -> Option<f64> {
    let tries = REACHES.iter().filter_map(|reach| interpolated(samples, at, *reach, noise));
    let best = tries.min_by(|a, b| a.sigma.total_cmp(&b.sigma))?;
    let off = (samples[at] - best.value).abs();
    (off > STANDS_OUT * best.sigma).then_some(best.value)
}

/// A sample by the neighbours within reach, without those that stand out themselves, and the standard
/// error of its difference from that.
fn interpolated(samples: &[f64], at: usize, reach: usize, noise: f64) -> Option<Estimate> {
    let window = at.saturating_sub(reach)..(at + reach + 1).min(samples.len());
    let mut members: Vec<usize> = window.filter(|sample| *sample != at).collect();
    for _ in 0..=MOST_NEIGHBOURS {
        let (interpolated, worst) = interpolate(samples, &members, (at, reach), noise)?;
        let Some(worst) = worst else {
            // A sample whose neighbours both stand out is no spike of one or two samples.
            let beside = |member: &usize| member.abs_diff(at) == 1;
            return members.iter().any(beside).then_some(interpolated);
        };
        members.remove(worst);
    }
    None
}

/// What a polynomial through the members says of a sample, and the member that stands out most.
fn interpolate(
    samples: &[f64],
    members: &[usize],
    (at, reach): (usize, usize),
    noise: f64,
) -> Option<(Estimate, Option<usize>)> {
    let freedom = members.len().checked_sub(DEGREE + 1)?;
    let freedom = Some(freedom).filter(|freedom| *freedom >= LEAST_FREEDOM)? as f64;
    let row = |sample: usize| powers((sample as f64 - at as f64) / reach as f64);
    let equations = members.iter().map(|member| (row(*member), samples[*member]));
    let fit = LinearSolution::of(DEGREE + 1, equations)?;
    let miss = |member: &usize| (samples[*member] - fit.value(&row(*member))).powi(2);
    let squares: f64 = members.iter().map(miss).sum();
    // Residuals of members left out one by one follow from one fit: r²/(1 − h).
    let studentised = |member: &usize| {
        let without = miss(member) / (1.0 - fit.variance(&row(*member))).max(1e-6);
        without / ((squares - without) / (freedom - 1.0)).max(noise * noise)
    };
    let ratios = members.iter().map(studentised).enumerate();
    let (worst, ratio) = ratios.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let own = row(at);
    let deviation = (squares / freedom).sqrt().max(noise);
    let sigma = deviation * (1.0 + fit.variance(&own)).sqrt();
    let interpolated = Estimate { value: fit.value(&own), sigma };
    Some((interpolated, (ratio > STANDS_OUT * STANDS_OUT).then_some(worst)))
}
