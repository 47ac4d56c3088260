//! How wrong heights may be before another maximum is taken for a pulse's peak.
//!
//! Two runs that agree may both take the same maximum for the highest, or both miss one
//! that is hardly any. What a signal's shape leaves open is found here; whether heights are as
//! wrong as that is the estimate's question.

use hertzchain_chain::System;
use hertzchain_chain::observe::{
    Competing, Maximum, Passage, Passages, Pulse, RETURN_WITHIN, Signal, Stretch, WALL_WITHIN,
};

/// Another maximum that could be a pulse's peak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OtherPick {
    /// Least error of heights, over the largest, with which it is.
    pub height_error: f64,
    /// What it changes in a time of flight, relatively.
    pub time_error: f64,
}

/// Stretches shorter than this share of the shortest contact time have slopes of rounding.
const SHORTEST: f64 = 1e-3;

/// Maxima that errors of heights could make the peak of a pulse.
///
/// Errors of given steps go with the signal itself: where it is silent, they are none.
pub(crate) fn other_picks(
    seen: &Passages,
    passage: &Passage,
    (system, given_steps): (&System, bool),
) -> Vec<OtherPick> {
    let largest = passage.incident.value.max(passage.wall.value);
    let pick =
        |(height, time_error): (f64, f64)| OtherPick { height_error: height / largest, time_error };
    let as_high = passage.competing.iter().map(|other| as_high(other, passage));
    let after = after_wall(seen, passage);
    // An error may rise to its whole size during the shortest contact.
    let flattest = flattest(&after, passage, system.scales().time_s);
    let slight = passage.reflected.map(|peak| (prominence(&after, peak), 1.0));
    let faint = (!system.flies_free())
        .then(|| faintest(seen.wall(), passage, given_steps))
        .into_iter()
        .flatten();
    as_high.chain(flattest).chain(slight).chain(faint).map(pick).collect()
}

/// By how much forces that a wall shows before the wave arrives, under load or through open contacts, are
/// above or below the least height of a pulse, if their search would be over before the wall's peak.
fn faintest(
    wall: &Signal,
    passage: &Passage,
    given_steps: bool,
) -> impl Iterator<Item = (f64, f64)> {
    let (peak, until_s) = (passage.wall, passage.wall.time_s / WALL_WITHIN);
    // What is not kept, or is no maximum at looser steps, may be anything up to the error.
    let silent = (!given_steps).then_some(Maximum { time_s: until_s, value: 0.0 });
    let early = wall.maxima().iter().copied().filter(move |it| it.time_s < until_s || *it == peak);
    let off = |it: Maximum| ((it.value - wall.least_height(it.time_s)).abs(), 1.0);
    early.chain(silent).map(off)
}

/// By how much another maximum is lower, and how far away it is.
fn as_high(other: &Competing, passage: &Passage) -> (f64, f64) {
    let (peak, flight_s) = match other.pulse {
        Pulse::Incident => (passage.incident, passage.tof_incident_s()),
        Pulse::Wall => (passage.wall, passage.tof_incident_s()),
        Pulse::Reflected => {
            let reflected = passage.reflected.unwrap_or(passage.wall);
            (reflected, reflected.time_s - passage.wall.time_s)
        }
    };
    let off_s = (other.maximum.time_s - peak.time_s).abs();
    ((peak.value - other.maximum.value).abs(), off_s / flight_s)
}

/// The sensor bead's signal where the reflected pulse is looked for.
fn after_wall<'a>(seen: &'a Passages, passage: &Passage) -> Vec<&'a Stretch> {
    let wall_s = passage.wall.time_s;
    let end_s = wall_s + RETURN_WITHIN * passage.tof_incident_s();
    let stretches = seen.sensor().stretches();
    let first = stretches.partition_point(|it| it.start_s < wall_s);
    let after = stretches[first..].iter();
    after.take_while(|it| it.end_s() < end_s).collect()
}

/// Where a signal that is above the reflected peak, because it has been falling since the
/// wall's, falls least: by how much in the time of a contact, and what a maximum there would change.
fn flattest(after: &[&Stretch], passage: &Passage, least_s: f64) -> Option<(f64, f64)> {
    let picked = passage.reflected.map_or(0.0, |peak| peak.value);
    let wall_s = passage.wall.time_s;
    let change = |time_s: f64| match passage.reflected {
        Some(peak) => (time_s - peak.time_s).abs() / (peak.time_s - wall_s),
        None => 1.0,
    };
    let above = |it: &&&Stretch| it.values.iter().all(|value| *value > picked);
    let long = |it: &&&Stretch| it.length_s > SHORTEST * least_s;
    let falls = after.iter().take_while(above).filter(long).flat_map(|it| {
        let per_contact = 4.0 * least_s / it.length_s;
        let falls = it.values.windows(2);
        falls.map(move |pair| ((pair[0] - pair[1]).abs() * per_contact, change(it.start_s)))
    });
    falls.min_by(|one, two| one.0.total_cmp(&two.0))
}

/// How far a peak stands out above the lowest value on its lower side.
fn prominence(after: &[&Stretch], peak: Maximum) -> f64 {
    let lowest = |side: &[&Stretch]| {
        let values = side.iter().flat_map(|it| it.values);
        // What is not kept is far below any peak.
        let gaps =
            side.windows(2).any(|pair| pair[1].start_s > pair[0].end_s() + 0.01 * pair[0].length_s);
        values.fold(if gaps { 0.0 } else { peak.value }, f64::min)
    };
    let at = after.partition_point(|it| it.start_s < peak.time_s);
    let (before, behind) = after.split_at(at);
    peak.value - lowest(before).max(lowest(behind))
}
