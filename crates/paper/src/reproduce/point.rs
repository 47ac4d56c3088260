//! The numbers of one shot with their accuracies.

use crate::claims::ShotPoint;
use hertzchain_chain::observe::{Passage, RETURN_WITHIN, Signal};
use hertzchain_chain::settle::State;
use hertzchain_chain::wave::{Limits, run};
use hertzchain_chain::{Sensor, System};
use hertzchain_sim::accuracy::{adaptive, reached, tolerance};
use hertzchain_sim::{Flight, Plan, Shot, StudyError, shoot};

/// How many times as wrong as the accuracy asked the numbers of a shot are that was not computed
/// again, at most: measured on the paper's chains and speeds at 1e-5 to 1e-7 and rounded up. Times
/// are twice as wrong behind a strong loss, where a loosened chain amplifies errors.
mod unchecked {
    /// ToFs, relative.
    pub(super) const TOF: f64 = 4.0;
    /// Sensor, wall and returning peak, relative.
    pub(super) const PEAK: f64 = hertzchain_sim::OF_PEAKS;
    /// Second returning peak, in returning peaks, where it is no mere shoulder.
    pub(super) const SECOND_PEAK: f64 = 200.0;
    /// Widths, relative: that of a split pulse ends at a flat shoulder.
    pub(super) const WIDTH: f64 = 300.0;
    /// Velocities of the striker, in its own speed: they gather the errors of all steps.
    pub(super) const STRIKER: f64 = 30.0;
    /// Loosening, relative.
    pub(super) const LOOSENED: f64 = 200.0;
}

/// Below this accuracy rounding decides, not the step.
const FINEST: f64 = 1e-12;

/// Computes a shot, and again at a tenth of the tolerance: what this changes shows
/// the accuracy of every number. Where times of flight change by more than the
/// accuracy asked, the finer shot takes its place.
pub(super) fn checked(plan: &Plan, speed_m_s: f64) -> Result<ShotPoint, StudyError> {
    let at = |accuracy: f64| {
        let plan = plan.clone().with_accuracy(accuracy);
        let shot = shoot(&plan)?;
        let point = read_off(&plan, speed_m_s, &shot);
        Ok::<_, StudyError>(ShotPoint { excess_s: excess_s(&plan, &shot)?, ..point })
    };
    let mut accuracy = plan.accuracy;
    let mut point = at(accuracy)?;
    loop {
        let finer = at(0.1 * accuracy)?;
        let (tolerance, _) = tolerance(&plan.clone().with_accuracy(accuracy));
        let evaluated = evaluated(point, &finer, tolerance);
        if evaluated.accuracy_reached <= plan.accuracy || 0.1 * accuracy <= FINEST {
            return Ok(evaluated);
        }
        accuracy *= 0.1;
        point = finer;
    }
}

/// A point whose accuracies follow from a finer computation and the tolerance of a step.
fn evaluated(point: ShotPoint, finer: &ShotPoint, tolerance: f64) -> ShotPoint {
    let largest = |number: &dyn Fn(&ShotPoint) -> Vec<f64>, relative: bool| {
        let pairs = number(&point).into_iter().zip(number(finer));
        let off = pairs.map(|(a, b)| {
            let off = reached([(a - b).abs(), 0.0], 1.0, tolerance * b.abs());
            off / if relative { b.abs() } else { 1.0 }
        });
        // What neither shot gave is not wrong.
        off.filter(|off| !off.is_nan()).fold(0.0, f64::max)
    };
    let tofs = |p: &ShotPoint| vec![p.tof_incident_s, p.tof_reflected_s];
    let peaks = |p: &ShotPoint| vec![p.sensor_peak_n, p.wall_peak_n, p.returning_peak_n];
    let striker = |p: &ShotPoint| vec![p.striker_separation_m_s, p.striker_rebound_m_s];
    ShotPoint {
        accuracy_reached: largest(&tofs, true),
        peak_accuracy: largest(&peaks, true),
        second_peak_accuracy_n: largest(&|p| vec![p.second_returning_peak_n], false),
        width_accuracy: largest(&|p| p.widths_s.to_vec(), true),
        striker_accuracy_m_s: largest(&striker, false),
        excess_accuracy_s: largest(&|p| p.excess_s.to_vec(), false),
        loosened_accuracy_m: largest(&|p| vec![p.loosened_m], false),
        ..point
    }
}

/// The numbers of a shot, one point a pick of its plan.
pub(super) fn read_off_all(plan: &Plan, speed_m_s: f64, shot: &Shot) -> Vec<ShotPoint> {
    let point = read_off(plan, speed_m_s, shot);
    let flights = std::iter::once(&shot.flight).chain(&shot.compared);
    let timed = |flight: &Option<Flight>| ShotPoint {
        tof_incident_s: flight.map_or(f64::NAN, |f| f.incident_s),
        tof_reflected_s: flight.and_then(|f| f.reflected_s).unwrap_or(f64::NAN),
        ..point.clone()
    };
    flights.map(timed).collect()
}

pub(crate) fn read_off(plan: &Plan, speed_m_s: f64, shot: &Shot) -> ShotPoint {
    let passage = shot.passage.as_ref().ok();
    let or_nan = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let rebound = shot.rebound;
    let returning_peak_n = or_nan(passage.and_then(|p| p.reflected).map(|peak| peak.value));
    let loosened_m = or_nan(loosened(shot));
    let both_ways_s = passage.and_then(|p| Some(p.tof_incident_s() + p.tof_reflected_s()?));
    let asked = shot.accuracy_asked;
    ShotPoint {
        speed_m_s,
        tof_incident_s: or_nan(shot.flight.map(|f| f.incident_s)),
        tof_reflected_s: or_nan(shot.flight.and_then(|f| f.reflected_s)),
        sensor_peak_n: or_nan(passage.map(|p| p.incident.value)),
        wall_peak_n: or_nan(passage.map(|p| p.wall.value)),
        returning_peak_n,
        second_returning_peak_n: or_nan(passage.and_then(|p| second_return(plan, p))),
        widths_s: [
            or_nan(passage.and_then(|p| p.incident_width_s)),
            or_nan(passage.and_then(|p| p.wall_width_s)),
            or_nan(passage.and_then(|p| p.reflected_width_s)),
        ],
        striker_separation_m_s: or_nan(rebound.and_then(|r| r.first).map(|(_, v)| v)),
        striker_rebound_m_s: or_nan(rebound.and_then(|r| r.end_m_s)),
        excess_s: [f64::NAN; 2],
        loosened_m,
        accuracy_reached: shot.accuracy_reached.unwrap_or(unchecked::TOF * asked),
        peak_accuracy: unchecked::PEAK * asked,
        second_peak_accuracy_n: unchecked::SECOND_PEAK * asked * returning_peak_n,
        width_accuracy: unchecked::WIDTH * asked,
        striker_accuracy_m_s: unchecked::STRIKER * asked * speed_m_s,
        excess_accuracy_s: unchecked::TOF * asked * or_nan(both_ways_s),
        loosened_accuracy_m: unchecked::LOOSENED * asked * loosened_m.abs(),
    }
}

/// Reflected less incident ToF by peaks, in s: of a shot, and of the same with the
/// gaps behind the pulse closed as it meets the wall. Not a number without a pulse.
pub(super) fn excess_s(plan: &Plan, shot: &Shot) -> Result<[f64; 2], StudyError> {
    let Ok(passage) = &shot.passage else {
        return Ok([f64::NAN; 2]);
    };
    let closed_s = reflected_s(plan, passage, close_gaps)?;
    let ways = [passage.tof_reflected_s(), closed_s];
    Ok(ways.map(|way_s| way_s.unwrap_or(f64::NAN) - passage.tof_incident_s()))
}

/// Maxima closer than this part of the pulse's width are one top.
const APART: f64 = 0.25;

/// Lower returning maxima, over the first, are no pulses: where a viscoelastic contact opens its
/// force rises to 0 with infinite slope, which makes a maximum on the tail of a pulse (0.014 of
/// Hertz beads with losses at 0.16 m/s) that loose steps do not resolve.
const LEAST_SECOND: f64 = 0.02;

/// Largest returning maximum beside the first, in N, or 0. What comes later than twice
/// the way from the sensor bead to the near end takes may be an echo from there.
fn second_return(plan: &Plan, passage: &Passage) -> Option<f64> {
    let (first, width) = (passage.reflected?, passage.reflected_width_s?);
    let back = passage.tof_reflected_s()?;
    let (n, beads) = (plan.sensor_bead as f64, plan.chain.beads.len() as f64);
    let until = first.time_s + 2.0 * n / (beads - n) * back;
    let others = passage.returning_maxima.iter().filter(|maximum| {
        maximum.time_s < until
            && (maximum.time_s - first.time_s).abs() > APART * width
            && maximum.value > LEAST_SECOND * first.value
    });
    Some(others.map(|maximum| maximum.value).fold(0.0, f64::max))
}

/// By how much beads 1 and N are farther apart than at rest, in m, once the pulse has returned.
fn loosened(shot: &Shot) -> Option<f64> {
    let (trace, passage) = (shot.trace.as_ref()?, shot.passage.as_ref().ok()?);
    let until = passage.wall.time_s + 3.0 * passage.tof_incident_s();
    let seen = trace.time_s.partition_point(|time| *time <= until);
    let at = |column: usize| trace.columns.get(column)?.get(seen.checked_sub(1)?).copied();
    Some(at(1)? - at(0)?)
}

/// Reflected ToF in s, by peaks, of a shot whose state is changed at the wall's peak.
fn reflected_s(
    plan: &Plan,
    passage: &Passage,
    change: impl FnOnce(&System, &mut State),
) -> Result<Option<f64>, StudyError> {
    let method = adaptive(plan, tolerance(plan).0);
    let system = System::new(&plan.chain)?;
    let until_wall = Limits::until(passage.wall.time_s);
    let met = run(&system, &method, until_wall, &mut [])?;
    let mut state = State::after(&system, &met);
    change(&system, &mut state);
    let from = system.from_state(&state)?;
    let mut sensor = Signal::new(Sensor::Bead(plan.sensor_bead));
    let way_back = Limits::until(RETURN_WITHIN * passage.tof_incident_s());
    run(&from, &method, way_back, &mut [&mut sensor])?;
    let returning = sensor.maxima().iter();
    let returning = returning.filter(|peak| peak.time_s > 0.0 && peak.value > 0.0);
    let largest = returning.max_by(|a, b| a.value.total_cmp(&b.value));
    Ok(largest.map(|peak| peak.time_s))
}

/// Sets all open contacts to just touching: whatever lies before a gap moves
/// toward the wall by it. Overlaps of closed contacts and velocities stay.
fn close_gaps(system: &System, state: &mut State) {
    let overlaps_m = (0..system.contacts()).map(|c| state.overlap_m(system, c));
    let overlaps_m: Vec<f64> = overlaps_m.collect();
    let mut shift_m = 0.0;
    let bodies = state.displacement_m.iter_mut().zip(overlaps_m).rev();
    for (place_m, overlap_m) in bodies.filter(|(_, overlap_m)| overlap_m.is_finite()) {
        shift_m -= overlap_m.min(0.0);
        *place_m += shift_m;
    }
}

#[cfg(test)]
#[path = "tests/closing.rs"]
mod tests;
