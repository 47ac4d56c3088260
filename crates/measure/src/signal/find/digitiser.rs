//! What a digitiser does to pulses: ends of its range and its steps.

use super::{Channels, Doubt, Finding, Found, Place, Pulse};
use crate::signal::Rails;
use crate::signal::picks::{Sight, clipped_top};
use crate::signal::saturation::has_run;

/// Looks at the pulses as they were recorded: filters leave neither rails nor steps.
pub(super) fn judge(found: &mut Found, recorded: Channels<'_>, finding: &Finding) {
    let channels = [recorded.sensor(), recorded.wall()];
    let own = channels.map(extremes);
    let rails = finding.rails_of(recorded);
    let mut doubts = Vec::new();
    let mut steps = [f64::INFINITY; 2];
    let pulses = [&mut found.passing, &mut found.wall, &mut found.returning];
    for pulse in pulses.into_iter().flatten() {
        let which = usize::from(pulse.place == Place::Wall);
        let (from, to) = pulse.extent;
        let inside = channels[which].get(from..=to).unwrap_or_default();
        if let Some(rails) = saturated(inside, own[which], pulse, rails[which]) {
            doubts.push(Doubt::Saturation(pulse.place));
            pulse.clipped = clipped(inside, from, rails);
        }
        steps[which] = steps[which].min(step(inside));
    }
    if let Channels::Summed(_) = recorded {
        steps = [steps[0].min(steps[1]); 2];
    }
    let steps = steps.map(|step| if step.is_finite() { step } else { 0.0 });
    (found.sensor.step, found.wall_channel.step) = (steps[0], steps[1]);
    let coarse = found
        .pulses()
        .filter(|pulse| found.upright(pulse.place).is_coarse(pulse.height));
    let coarse: Vec<Place> = coarse.map(|pulse| pulse.place).collect();
    doubts.extend(coarse.iter().copied().map(Doubt::CoarseSteps));
    found.doubt(doubts);
    let flat_tops = flat_tops(found, recorded, &coarse);
    found.doubt(flat_tops);
    // A top of few steps is flat by itself.
    let flat = |pulse: &&mut Pulse| {
        let which = usize::from(pulse.place == Place::Wall);
        rails[which].is_none() && coarse.contains(&pulse.place)
    };
    let pulses = [&mut found.passing, &mut found.wall, &mut found.returning];
    for pulse in pulses.into_iter().flatten().filter(flat) {
        pulse.clipped = None;
    }
}

/// Share of a whole pulse's height below which no other pulse of its channel is clipped.
const AS_HIGH: f64 = 0.9;

/// Marks the tops that something before the digitiser has clipped.
fn flat_tops(found: &mut Found, recorded: Channels<'_>, coarse: &[Place]) -> Vec<Doubt> {
    let channels = [recorded.sensor(), recorded.wall()];
    let uprights = [found.sensor, found.wall_channel];
    let summed = matches!(recorded, Channels::Summed(_));
    let channel = |pulse: &Pulse| usize::from(pulse.place == Place::Wall && !summed);
    let pulses = [&mut found.passing, &mut found.wall, &mut found.returning];
    let whole = pulses.into_iter().flatten().filter(|p| p.clipped.is_none());
    let mut whole: Vec<&mut Pulse> = whole.collect();
    let mut highest = [0.0_f64; 2];
    for pulse in &mut whole {
        let which = usize::from(pulse.place == Place::Wall);
        let sight = Sight {
            samples: channels[which],
            upright: uprights[which],
            rails: None,
            summed,
            wall: None,
            inverse: [0.0; 2],
        };
        if !coarse.contains(&pulse.place) {
            pulse.clipped = clipped_top(&sight, pulse);
        }
        if pulse.clipped.is_none() {
            highest[channel(pulse)] = highest[channel(pulse)].max(pulse.height);
        }
    }
    let mut doubts = Vec::new();
    for pulse in whole {
        // One channel ends at one level.
        let end = AS_HIGH * highest[channel(pulse)];
        pulse.clipped = pulse.clipped.filter(|_| pulse.height > end);
        doubts.extend(pulse.clipped.map(|_| Doubt::Saturation(pulse.place)));
    }
    doubts
}

/// Least difference of neighbours. Of samples that are not rounded, the least of some
/// hundred is far below their noise.
fn step(samples: &[f64]) -> f64 {
    let differences = samples.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let differ = differences.filter(|d| *d > 0.0);
    differ.fold(f64::INFINITY, f64::min)
}

/// The rails on which a pulse has a run of samples: the record's extremes, or known ones, of
/// which a single sample is enough.
fn saturated(
    inside: &[f64],
    (low, high): (f64, f64),
    pulse: &Pulse,
    known: Option<Rails>,
) -> Option<Rails> {
    // A round top of a hundred steps has a run of a tenth of its width.
    let longest = (0.15 * pulse.width_samples).max(4.0) as usize;
    let own = (Rails { low, high }, longest);
    let (rails, shortest) = known.map_or(own, |rails| (rails, 1));
    has_run(inside, rails, shortest).then_some(rails)
}

/// First and last sample on a rail, counted in the record.
fn clipped(inside: &[f64], from: usize, rails: Rails) -> Option<(usize, usize)> {
    let on_rail = |sample: &f64| rails.hold(*sample);
    let first = inside.iter().position(on_rail)?;
    let last = inside.iter().rposition(on_rail)?;
    Some((from + first, from + last))
}

/// Least and largest, eight lanes at a time.
pub(super) fn extremes(samples: &[f64]) -> (f64, f64) {
    let start = samples.first().copied().unwrap_or(0.0);
    let (mut low, mut high) = ([start; 8], [start; 8]);
    let (whole, rest) = samples.as_chunks::<8>();
    for chunk in whole {
        for (lane, x) in chunk.iter().enumerate() {
            low[lane] = if *x < low[lane] { *x } else { low[lane] };
            high[lane] = if *x > high[lane] { *x } else { high[lane] };
        }
    }
    let low = low.iter().chain(rest).copied().fold(start, f64::min);
    let high = high.iter().chain(rest).copied().fold(start, f64::max);
    (low, high)
}
