//! Which maximum is which pulse.

use super::Finding;
use super::significance::{LEAST as LEAST_SEEN, error_of_height};
use super::smooth::Maximum;
use super::track::{BLOCK, Track};

/// Beads a wave passes while a sensor bead sees half its maximum or more, in a
/// row of equal Hertz beads: the wave passes 33 beads in 16 such times.
const BEADS_A_WIDTH: f64 = 2.07;
/// How far off that may be, either way, in rows with losses or a push.
const LOOSELY: f64 = 2.5;
/// Earliest return in a summed channel, as a share of the incident time: before
/// that comes what the wall's own pulse trails behind.
const EARLIEST: f64 = 0.6;
/// Least height of the wall's pulse over the passing one's. Of computed rows it is 0.48 (weak
/// shots in gear oil) to 1.9 (dry); a returning pulse has 0.20 to 0.35 of the wall's.
const LEAST_WALL: f64 = 0.42;
/// The same where no third pulse is there and nobody knows the row: returning pulses have up to 0.67
/// of the passing one's height.
const HIGHEST_RETURN: f64 = 0.7;
/// Least height of a return over the wall's pulse in computed rows, dry and wet.
const LEAST_RETURN: f64 = 0.15;
/// Expected incident times between what a time to the wall and one to the wall and back can be.
const TO_AND_FRO: f64 = 1.5;

/// The chosen maxima.
#[derive(Default)]
pub(super) struct Chosen {
    pub(super) passing: Option<Maximum>,
    pub(super) wall: Option<Maximum>,
    pub(super) returning: Option<Maximum>,
    pub(super) order_doubtful: bool,
    /// One of the three is not there, and it is not plain which.
    pub(super) lost: bool,
    /// Between which samples each was the largest; nothing of one that is not there.
    pub(super) windows: [(f64, f64); 3],
}

/// Largest of the maxima between two samples.
pub(super) fn largest(maxima: &[Maximum], from: f64, to: f64) -> Option<Maximum> {
    let inside = |m: &&Maximum| (m.at as f64) > from && (m.at as f64) < to;
    let higher = |best: Maximum, next: Maximum| {
        if next.height > best.height {
            next
        } else {
            best
        }
    };
    maxima.iter().filter(inside).copied().reduce(higher)
}

/// When the wall's pulse can come after the passing one, in samples.
fn due(finding: &Finding, width: f64) -> (f64, f64) {
    finding.beads.map_or((width, f64::INFINITY), |beads| {
        let expected = expected(beads, width);
        ((expected / LOOSELY).max(width), expected * LOOSELY)
    })
}

/// Incident time that the width of the passing pulse lets expect, in samples.
fn expected((beads, sensor): (usize, usize), width: f64) -> f64 {
    (beads as f64 - sensor as f64 + 0.5) / BEADS_A_WIDTH * width
}

/// Largest block of a track between two samples, as a sample.
pub(super) fn largest_block(track: &Track<'_>, from: f64, to: f64) -> Option<usize> {
    let block = |sample: f64| (sample / BLOCK as f64).clamp(0.0, track.blocks.len() as f64);
    let range = block(from) as usize..block(to) as usize;
    let higher = |best: usize, next: usize| {
        let larger = track.block_height(next) > track.block_height(best);
        if larger { next } else { best }
    };
    range.reduce(higher).map(|block| block * BLOCK)
}

/// Last sample that matters in a summed channel: three incident times after the wall's pulse.
pub(super) fn end_of_interest(track: &Track<'_>, finding: &Finding) -> usize {
    let (from, to) = due(finding, track.width);
    // Beyond the first pulse's own fall, which may be higher than all that follows.
    let from = from.max(3.0 * track.width);
    let passing = track.first as f64 + 0.5 * track.width;
    let wall = largest_block(track, passing + from, passing + to);
    let end = wall.map_or(passing, |wall| {
        let wall = wall as f64;
        wall + 3.0 * (wall - passing)
    });
    (end + 3.0 * track.width) as usize
}

/// Passing, wall, returning in one channel, in this order.
pub(super) fn summed(maxima: &[Maximum], track: &Track<'_>, finding: &Finding) -> Chosen {
    let width = track.width;
    let start = track.first as f64 - width;
    let first = largest(maxima, start, track.first as f64 + 1.5 * width);
    let Some(first) = first.or_else(|| largest(maxima, start, f64::INFINITY)) else {
        return Chosen::default();
    };
    let (from, to) = due(finding, width);
    let began = first.at as f64;
    let Some(wall) = largest(maxima, began + from, began + to) else {
        return Chosen {
            passing: Some(first),
            ..Chosen::default()
        };
    };
    let wall = sooner(maxima, first, wall, finding, width);
    let reached = wall.at as f64;
    let passing = largest(maxima, 0.0, reached - width).unwrap_or(first);
    let incident = reached - passing.at as f64;
    let latest = reached + latest_return(finding) * incident;
    let back = reached + (EARLIEST * incident).max(width);
    let returning = largest(maxima, back, latest);
    let order_doubtful = doubtful(maxima, [first, passing, wall], returning, finding, width);
    let chosen = Chosen {
        passing: Some(passing),
        wall: Some(wall),
        returning,
        order_doubtful,
        lost: false,
        // The wall's own: what comes back is another pulse.
        windows: [(0.0, reached - width), (began + from, back), (back, latest)],
    };
    match returning {
        Some(_) => chosen,
        None => of_two(chosen, [passing, wall], track, finding),
    }
}

/// What two pulses are, of which the second was taken for the wall's.
///
/// A second pulse much lower than the first is a return, and what is lost is the passing pulse, or
/// the wall's if the time is nearer to that of the whole way to and fro. Without the row that
/// is not plain; then a second pulse that is high enough is no proof either if the record is long
/// enough to show a third one.
fn of_two(
    chosen: Chosen,
    [first, second]: [Maximum; 2],
    track: &Track<'_>,
    finding: &Finding,
) -> Chosen {
    let time = (second.at - first.at) as f64;
    let falls = is_no_wall(&second, &first);
    let may_be_back = second.height < HIGHEST_RETURN * first.height;
    let noise = track.upright.level.broad_noise();
    let seen =
        LEAST_RETURN * second.height > 2.0 * LEAST_SEEN * noise * error_of_height(track.width);
    let shows_all = seen && !ends_early(first.at, second.at, track.samples.len());
    let to_and_fro = |beads| time > TO_AND_FRO * expected(beads, track.width);
    match (falls, finding.beads) {
        (_, Some(beads)) if may_be_back && to_and_fro(beads) => Chosen {
            wall: None,
            returning: Some(second),
            windows: [(0.0, 0.0); 3],
            ..chosen
        },
        (true, Some(_)) => Chosen {
            passing: None,
            wall: Some(first),
            returning: Some(second),
            windows: [(0.0, 0.0); 3],
            ..chosen
        },
        (false, Some(_)) => chosen,
        (_, None) => Chosen {
            lost: may_be_back || shows_all,
            ..chosen
        },
    }
}

/// Whether a pulse is too low beside the passing one to be the wall's.
fn is_no_wall(pulse: &Maximum, passing: &Maximum) -> bool {
    pulse.height < LEAST_WALL * passing.height
}

/// Whether a record ends before a return could have been missed.
pub(super) fn ends_early(passing: usize, wall: usize, samples: usize) -> bool {
    let incident = wall.saturating_sub(passing);
    (samples as f64) < wall as f64 + 1.8 * incident as f64
}

/// The wall's pulse, if what was taken for it is the return: another pulse
/// stands half way, where a sensor bead at rest shows none. One of half the
/// height will do; less if the passing pulse's width says that half way is right.
fn sooner(
    maxima: &[Maximum],
    first: Maximum,
    wall: Maximum,
    finding: &Finding,
    width: f64,
) -> Maximum {
    let (began, whole) = (first.at as f64, (wall.at - first.at) as f64);
    let half_way = largest(maxima, began + 0.4 * whole, began + 0.6 * whole);
    let least = finding.beads.map_or(0.5, |beads| {
        let expected = expected(beads, width);
        let nearer = (0.5 * whole / expected).ln().abs() < (whole / expected).ln().abs();
        if nearer { 0.2 } else { f64::INFINITY }
    });
    half_way
        .filter(|other| other.height >= least * wall.height)
        .unwrap_or(wall)
}

/// Latest return in incident times: before the wall is reached a second time.
fn latest_return(finding: &Finding) -> f64 {
    finding.beads.map_or(2.0, |(beads, sensor)| {
        let to_and_fro = 2.0 * sensor as f64 / (beads - sensor) as f64;
        (0.9 * (2.0 + to_and_fro)).min(3.0)
    })
}

/// Whether something else could be the wall's or the returning pulse.
fn doubtful(
    maxima: &[Maximum],
    [first, passing, wall]: [Maximum; 3],
    returning: Option<Maximum>,
    finding: &Finding,
    width: f64,
) -> bool {
    let (began, incident) = (passing.at as f64, (wall.at - passing.at) as f64);
    let between = largest(maxima, began + 0.25 * incident, began + 0.75 * incident);
    let rival = between.is_some_and(|other| other.height > 0.35 * wall.height);
    let odd_return = returning.is_some_and(|back| {
        let ratio = (back.at - wall.at) as f64 / incident;
        back.height > 0.9 * wall.height || !times_back(finding).contains(&ratio)
    });
    let odd_time = is_odd_time(finding, incident, width);
    first.at != passing.at || rival || odd_return || odd_time || is_no_wall(&wall, &passing)
}

/// Whether an incident time is not what the passing pulse's width lets expect of a known row.
fn is_odd_time(finding: &Finding, incident: f64, width: f64) -> bool {
    finding.beads.is_some_and(|beads| {
        let ratio = incident / expected(beads, width);
        !(0.5..2.0).contains(&ratio)
    })
}

/// Reflected over incident times of flight. Both ways are as long, and what returns is weaker
/// and slower: 1.03 to 1.15 in computed rows that are compact. In a known row bounds
/// lie between that and what comes next at the sensor or at the wall, by way of the striker's end.
fn times_back(finding: &Finding) -> std::ops::Range<f64> {
    finding.beads.map_or(0.8..1.8, |(beads, sensor)| {
        let next = 2.0 * sensor as f64 / (beads - sensor) as f64;
        0.85..(1.0 + 0.75 * next).clamp(1.25, 1.8)
    })
}

/// As [`summed`], with the wall in a channel of its own.
///
/// By crosstalk either channel may show the other's pulses at their own times: none of the sensor's
/// pulses is looked for within half a width of the wall's.
pub(super) fn separate(
    sensor: &[Maximum],
    wall: &[Maximum],
    track: &Track<'_>,
    finding: &Finding,
) -> Chosen {
    let Some(wall) = largest(wall, 0.0, f64::INFINITY) else {
        return Chosen {
            passing: largest(sensor, 0.0, f64::INFINITY),
            ..Chosen::default()
        };
    };
    let (width, reached) = (track.width, wall.at as f64);
    let before = reached - 0.5 * width;
    let Some(passing) = largest(sensor, 0.0, before) else {
        return Chosen {
            wall: Some(wall),
            order_doubtful: true,
            ..Chosen::default()
        };
    };
    let incident = reached - passing.at as f64;
    let back = reached + (EARLIEST * incident).max(0.5 * width);
    let latest = reached + 3.0 * incident;
    let returning = largest(sensor, back, latest);
    let early = (passing.at as f64) < track.first as f64 - width;
    let late = passing.at as f64 > track.first as f64 + 2.0 * width;
    let odd_return = returning.is_some_and(|found| {
        let ratio = (found.at as f64 - reached) / incident;
        found.height > passing.height || !times_back(finding).contains(&ratio)
    });
    Chosen {
        passing: Some(passing),
        wall: Some(wall),
        returning,
        order_doubtful: early || late || odd_return || is_odd_time(finding, incident, width),
        lost: false,
        windows: [(0.0, before), (0.0, f64::INFINITY), (back, latest)],
    }
}
