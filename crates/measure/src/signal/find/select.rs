//! Which maximum is which pulse.

use super::FindOptions;
use super::channel::{ChannelSignal, Smoothed, SmoothedMaximum};
use crate::signal::linear::LinearSolution;
use std::f64::consts::LN_2;
use std::ops::Range;

/// Factor by which the time to the wall may differ from the expected one, in rows with losses or
/// precompression.
const LOOSELY: f64 = 2.5;
/// Earliest reflected pulse in a summed channel, as a share of the incident time: before that comes
/// the tail of the wall's own pulse.
const EARLIEST: f64 = 0.6;
/// Expected incident times between the longest to the wall and the shortest to the wall and back.
const TO_AND_FRO: f64 = 1.5;
/// Standard errors of its height above the background that a reflected pulse has at least: noise
/// alone reaches as many in less than 0.2 % of shots.
const LEAST_SIGNIFICANCE: f64 = 4.3;

#[derive(Clone, Default)]
pub(super) struct PulseSelection {
    pub(super) maxima: [Option<SmoothedMaximum>; 3],
    pub(super) order_doubtful: bool,
    /// One of the three is missing, and it is open which.
    pub(super) unidentified: bool,
    /// Between which samples each was the largest; empty of a missing one.
    pub(super) windows: [(f64, f64); 3],
}

/// Times in samples that follow from the first pulse's width and the row, where it is known.
struct Timing<'a> {
    width: f64,
    options: &'a FindOptions,
}

impl Timing<'_> {
    fn expected(&self) -> Option<f64> {
        let (beads, sensor) = self.options.beads?;
        Some((beads as f64 - sensor as f64 + 0.5) / self.options.limits.width_beads * self.width)
    }

    fn wall_window(&self) -> (f64, f64) {
        let bounds = |expected: f64| ((expected / LOOSELY).max(self.width), expected * LOOSELY);
        let unknown = (self.width, f64::INFINITY);
        self.expected().map_or(unknown, bounds)
    }

    /// Latest reflected pulse in incident times: before the wall is reached a second time.
    fn latest_reflected(&self) -> f64 {
        self.options.beads.map_or(2.0, |(beads, sensor)| {
            let to_and_fro = 2.0 * sensor as f64 / (beads - sensor) as f64;
            (0.9 * (2.0 + to_and_fro)).min(3.0)
        })
    }

    /// Reflected over incident times of flight. Both ways are as long, and the reflected pulse is
    /// weaker and slower: 1.03 to 1.15 in computed rows that are compact. In a known row bounds
    /// lie between that and what comes next at the sensor or at the wall, by way of the striker's
    /// end.
    fn reflected_over_incident(&self) -> Range<f64> {
        self.options.beads.map_or(0.8..1.8, |(beads, sensor)| {
            let next = 2.0 * sensor as f64 / (beads - sensor) as f64;
            0.85..(1.0 + 0.75 * next).clamp(1.25, 1.8)
        })
    }

    /// Whether an incident time differs by a factor of two from the expected one.
    fn is_unexpected(&self, incident: f64) -> bool {
        let expected = self.expected();
        expected.is_some_and(|expected| !(0.5..2.0).contains(&(incident / expected)))
    }

    /// Whether a pulse is too low beside the incident one to be the wall's.
    fn is_too_low_for_wall(&self, pulse: &SmoothedMaximum, incident: &SmoothedMaximum) -> bool {
        pulse.height < self.options.limits.wall_over_incident_min * incident.height
    }
}

/// Largest of the maxima between two samples; the first of equals.
pub(super) fn largest(maxima: &[SmoothedMaximum], from: f64, to: f64) -> Option<SmoothedMaximum> {
    let inside = |m: &&SmoothedMaximum| (m.at as f64) > from && (m.at as f64) < to;
    let inside = maxima.iter().filter(inside).copied();
    inside.reduce(|best, next| if next.height > best.height { next } else { best })
}

/// Last sample that matters in a summed channel: three incident times after the wall's pulse.
pub(super) fn end_of_interest(channel: &ChannelSignal<'_>, options: &FindOptions) -> usize {
    let (from, to) = Timing { width: channel.width, options }.wall_window();
    // Beyond the first pulse's own fall, which may be higher than all that follows.
    let from = from.max(3.0 * channel.width);
    let incident = channel.first as f64 + 0.5 * channel.width;
    let wall = channel.largest_block(incident + from, incident + to);
    let end = wall.map_or(incident, |(wall, _)| {
        let wall = wall as f64;
        wall + 3.0 * (wall - incident)
    });
    (end + 3.0 * channel.width) as usize
}

pub(super) fn summed(smoothed: &Smoothed<'_>, options: &FindOptions) -> PulseSelection {
    let (channel, maxima) = (smoothed.channel, &smoothed.maxima);
    let timing = Timing { width: channel.width, options };
    let width = channel.width;
    let start = channel.first as f64 - width;
    let first = largest(maxima, start, channel.first as f64 + 1.5 * width);
    let Some(first) = first.or_else(|| largest(maxima, start, f64::INFINITY)) else {
        return PulseSelection::default();
    };
    let (from, to) = timing.wall_window();
    let began = first.at as f64;
    let Some(wall) = largest(maxima, began + from, began + to) else {
        return PulseSelection { maxima: [Some(first), None, None], ..PulseSelection::default() };
    };
    let wall = half_way(maxima, first, wall, &timing);
    let reached = wall.at as f64;
    let incident = largest(maxima, 0.0, reached - width).unwrap_or(first);
    let time = reached - incident.at as f64;
    let latest = reached + timing.latest_reflected() * time;
    let back = reached + (EARLIEST * time).max(width);
    let reflected = largest(maxima, back, latest);
    let selection = PulseSelection {
        order_doubtful: is_doubtful(maxima, [first, incident, wall], reflected, &timing),
        maxima: [Some(incident), Some(wall), reflected],
        unidentified: false,
        // The wall's own window: what comes back is another pulse.
        windows: [(0.0, reached - width), (began + from, back), (back, latest)],
    };
    match reflected {
        Some(_) => selection,
        None => identify_two(selection, [incident, wall], channel, &timing),
    }
}

/// Identifies two pulses, of which the second was taken for the wall's.
///
/// A second pulse much lower than the first is a reflected one, and what is missing is the incident
/// pulse, or the wall's if the time is nearer to that of the whole way to and fro. Without the row
/// that is open; then a second pulse that is high enough is no proof either if the record is long
/// enough to show a third one.
fn identify_two(
    selection: PulseSelection,
    [first, second]: [SmoothedMaximum; 2],
    channel: &ChannelSignal<'_>,
    timing: &Timing<'_>,
) -> PulseSelection {
    let limits = &timing.options.limits;
    let time = (second.at - first.at) as f64;
    let may_be_reflected = second.height < limits.reflected_over_incident_max * first.height;
    if let Some(expected) = timing.expected() {
        let wall_is_missing = may_be_reflected && time > TO_AND_FRO * expected;
        let maxima = match wall_is_missing {
            true => [Some(first), None, Some(second)],
            false if timing.is_too_low_for_wall(&second, &first) => {
                [None, Some(first), Some(second)]
            }
            false => return selection,
        };
        return PulseSelection { maxima, windows: [(0.0, 0.0); 3], ..selection };
    }
    let noise = channel.normalisation.baseline.broad_noise();
    // Standard error of the height of a Gaussian beside a line fitted over 2.5 widths.
    let least = 2.0 * LEAST_SIGNIFICANCE * noise * (1.6 / timing.width.sqrt());
    let seen = limits.reflected_over_wall_min * second.height > least;
    let shows_all = seen && !ends_early(first.at, second.at, channel.samples.len());
    PulseSelection { unidentified: may_be_reflected || shows_all, ..selection }
}

/// Whether a record ends before a reflected pulse could have been missed.
pub(super) fn ends_early(incident: usize, wall: usize, samples: usize) -> bool {
    let time = wall.saturating_sub(incident);
    (samples as f64) < wall as f64 + 1.8 * time as f64
}

/// The wall's pulse, if what was taken for it is the reflected one: another pulse stands half way,
/// where a sensor bead at rest shows none. One of half the height will do; less if the incident
/// pulse's width makes half way likelier.
fn half_way(
    maxima: &[SmoothedMaximum],
    first: SmoothedMaximum,
    wall: SmoothedMaximum,
    timing: &Timing<'_>,
) -> SmoothedMaximum {
    let (began, whole) = (first.at as f64, (wall.at - first.at) as f64);
    let least = timing.expected().map_or(0.5, |expected| {
        let nearer = (0.5 * whole / expected).ln().abs() < (whole / expected).ln().abs();
        if nearer { 0.2 } else { f64::INFINITY }
    });
    largest(maxima, began + 0.4 * whole, began + 0.6 * whole)
        .filter(|other| other.height >= least * wall.height)
        .unwrap_or(wall)
}

/// Whether something else could be the wall's or the reflected pulse.
fn is_doubtful(
    maxima: &[SmoothedMaximum],
    [first, incident, wall]: [SmoothedMaximum; 3],
    reflected: Option<SmoothedMaximum>,
    timing: &Timing<'_>,
) -> bool {
    let (began, time) = (incident.at as f64, (wall.at - incident.at) as f64);
    let between = largest(maxima, began + 0.25 * time, began + 0.75 * time);
    let unusual = |back: SmoothedMaximum| {
        let ratio = (back.at - wall.at) as f64 / time;
        back.height > 0.9 * wall.height || !timing.reflected_over_incident().contains(&ratio)
    };
    first.at != incident.at
        || between.is_some_and(|other| other.height > 0.35 * wall.height)
        || reflected.is_some_and(unusual)
        || timing.is_unexpected(time)
        || timing.is_too_low_for_wall(&wall, &incident)
}

/// As [`summed`], with the wall in a channel of its own.
///
/// By crosstalk either channel may show the other's pulses at their own times: none of the sensor's
/// pulses is searched for within half a width of the wall's.
pub(super) fn separate(
    sensor: &Smoothed<'_>,
    wall: &Smoothed<'_>,
    options: &FindOptions,
) -> PulseSelection {
    let (channel, sensor) = (sensor.channel, &sensor.maxima);
    let timing = Timing { width: channel.width, options };
    let Some(wall) = largest(&wall.maxima, 0.0, f64::INFINITY) else {
        return PulseSelection {
            maxima: [largest(sensor, 0.0, f64::INFINITY), None, None],
            ..PulseSelection::default()
        };
    };
    let (width, reached) = (channel.width, wall.at as f64);
    let before = reached - 0.5 * width;
    let Some(incident) = largest(sensor, 0.0, before) else {
        return PulseSelection {
            maxima: [None, Some(wall), None],
            order_doubtful: true,
            ..PulseSelection::default()
        };
    };
    let at = incident.at as f64;
    let time = reached - at;
    let back = reached + (EARLIEST * time).max(0.5 * width);
    let latest = reached + 3.0 * time;
    let reflected = largest(sensor, back, latest);
    let first = channel.first as f64;
    let unusual = |found: SmoothedMaximum| {
        let ratio = (found.at as f64 - reached) / time;
        found.height > incident.height || !timing.reflected_over_incident().contains(&ratio)
    };
    PulseSelection {
        order_doubtful: at < first - width
            || at > first + 2.0 * width
            || reflected.is_some_and(unusual)
            || timing.is_unexpected(time),
        maxima: [Some(incident), Some(wall), reflected],
        unidentified: false,
        windows: [(0.0, before), (0.0, f64::INFINITY), (back, latest)],
    }
}

/// Widths on either side of a maximum over which background and pulse are fitted.
const REACH: f64 = 1.25;
/// Widths of the first pulse from which on a maximum may be a hump of the background; reflected
/// pulses of computed rows have up to 2.1.
const HUMP: f64 = 3.0;
/// Least and largest width of a reflected pulse in widths of the first pulse.
pub(super) const NARROWEST: f64 = 0.5;
const WIDEST: f64 = 2.5;

impl Smoothed<'_> {
    /// Keeps, of the maxima between two samples, those that stand out of the noise on a falling
    /// background; returns whether any did not.
    pub(super) fn retain_significant(&mut self, (from, to): (f64, f64)) -> bool {
        let mut maxima = std::mem::take(&mut self.maxima);
        let before = maxima.len();
        maxima.retain(|maximum| {
            let at = maximum.at as f64;
            at <= from || at >= to || self.is_significant(maximum)
        });
        self.maxima = maxima;
        self.maxima.len() < before
    }

    /// Least squares of a Gaussian as wide as the maximum is, and of a straight line: a background
    /// that falls ever more slowly lies below its chord and only makes the Gaussian lower. What is
    /// so wide that it may be the background's own hump must hold a pulse as wide as the first one
    /// beside a parabola.
    pub(super) fn is_significant(&self, maximum: &SmoothedMaximum) -> bool {
        let width = self.channel.width;
        let (rise, fall) = self.sides(maximum);
        if 2.0 * rise.min(fall) > HUMP * width {
            return self.significance(maximum, width, 4) > LEAST_SIGNIFICANCE;
        }
        // Noise may have made the maximum narrower than its pulse.
        let own = (rise + fall).clamp(NARROWEST * width, WIDEST * width);
        let mut widths = [own, width].into_iter();
        widths.any(|width| self.significance(maximum, width, 3) > LEAST_SIGNIFICANCE)
    }

    /// Height of a Gaussian of this width beside a polynomial, in its standard errors.
    fn significance(&self, maximum: &SmoothedMaximum, width: f64, terms: usize) -> f64 {
        let ChannelSignal { samples, normalisation, .. } = self.channel;
        let reach = (REACH * width) as usize;
        let first = maximum.at.saturating_sub(reach);
        let last = (maximum.at + reach + 1).min(samples.len());
        let equations = samples[first..last].iter().enumerate().map(|(i, sample)| {
            let u = ((first + i) as f64 - maximum.at as f64) / width;
            ([(-4.0 * LN_2 * u * u).exp(), 1.0, u, u * u], normalisation.height(*sample))
        });
        let noise = normalisation.baseline.broad_noise();
        LinearSolution::of(terms, equations)
            .map_or(0.0, |found| found.values[0] / (noise * found.inverse[0][0].sqrt()))
    }
}
