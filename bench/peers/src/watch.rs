//! Peaks of the sensors while a peer steps, and the end of a shot.

use crate::case::Shot;
use crate::motion::{Sensor, State, derivative, signal};

/// A shot ends when the sensor bead's signal has fallen below this fraction of
/// the reflected peak.
pub const FALLEN: f64 = 0.05;

/// The reflected peak comes no sooner after the wall's than this many
/// incident times of flight.
pub const SOONEST: f64 = 0.8;

/// And no later than this many.
pub const LATEST: f64 = 3.0;

/// A shot that has not ended by then (in its own unit of time) has gone wrong.
pub const LONGEST: f64 = 400.0;

/// A peak: time and value.
type Peak = (f64, f64);

/// Follows both sensors from step to step.
#[derive(Clone, Debug)]
pub struct Watch {
    bead: Follower,
    wall: Follower,
    incident: Option<Peak>,
    wall_peak: Option<Peak>,
    reflected: Option<Peak>,
}

#[derive(Clone, Debug)]
struct Follower {
    sensor: Sensor,
    /// Slope at the end of the step before.
    slope: f64,
}

impl Follower {
    fn new(sensor: Sensor) -> Self {
        Self { sensor, slope: 0.0 }
    }

    /// A maximum within the step, if there is one.
    fn step(
        &mut self,
        shot: &Shot,
        (start, end): (f64, f64),
        y_end: &State,
        at: &mut impl FnMut(f64) -> State,
    ) -> Option<Peak> {
        let before = self.slope;
        if !self.sensor.feels(y_end) {
            self.slope = 0.0;
            return None;
        }
        self.slope = signal(shot, y_end, self.sensor).1;
        if before <= 0.0 || self.slope > 0.0 {
            return None;
        }
        Some(refined(
            |t| signal(shot, &at(t), self.sensor),
            (start, before),
            (end, self.slope),
        ))
    }
}

/// Root of the slope between two times by regula falsi (Illinois).
fn refined(mut at: impl FnMut(f64) -> (f64, f64), from: Peak, to: Peak) -> Peak {
    let ((mut a, mut fa), (mut b, mut fb)) = (from, to);
    let narrow = 1e-13 * b.abs().max(1.0);
    let mut best = (b, 0.0);
    for _ in 0..40 {
        let t = if fa == fb {
            0.5 * (a + b)
        } else {
            b - fb * (b - a) / (fb - fa)
        };
        let (value, slope) = at(t);
        best = (t, value);
        if slope * fb <= 0.0 {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        let moved = (t - b).abs();
        (b, fb) = (t, slope);
        if moved < narrow || slope == 0.0 {
            break;
        }
    }
    best
}

impl Watch {
    /// Of a shot about to start.
    pub fn new() -> Self {
        Self {
            bead: Follower::new(Sensor::Bead),
            wall: Follower::new(Sensor::Wall),
            incident: None,
            wall_peak: None,
            reflected: None,
        }
    }

    /// Takes in one accepted step with its dense output; `true` once the shot is over.
    pub fn step(
        &mut self,
        shot: &Shot,
        times: (f64, f64),
        y_end: &State,
        mut at: impl FnMut(f64) -> State,
    ) -> bool {
        if let Some(peak) = self.bead.step(shot, times, y_end, &mut at) {
            self.at_bead(peak);
        }
        if let Some(peak) = self.wall.step(shot, times, y_end, &mut at) {
            self.at_wall(peak);
        }
        self.over(shot, times.1, y_end)
    }

    fn at_bead(&mut self, peak: Peak) {
        let slot = match self.wall_peak {
            None => &mut self.incident,
            Some(_) => &mut self.reflected,
        };
        if slot.is_none_or(|best| peak.1 > best.1) {
            *slot = Some(peak);
        }
    }

    fn at_wall(&mut self, peak: Peak) {
        if self.wall_peak.is_none_or(|best| peak.1 > best.1) {
            self.wall_peak = Some(peak);
            self.reflected = None;
        }
    }

    /// Whether the reflected pulse has passed: it was seen, and the bead is quiet again.
    fn over(&self, shot: &Shot, time: f64, y_end: &State) -> bool {
        let (Some(incident), Some(wall)) = (self.incident, self.wall_peak) else {
            return time > LONGEST;
        };
        let flight = wall.0 - incident.0;
        let passed = |peak: Peak| {
            peak.0 > wall.0 + SOONEST * flight
                && signal(shot, y_end, Sensor::Bead).0 < FALLEN * peak.1
        };
        self.reflected.is_some_and(passed) || time > wall.0 + LATEST * flight
    }

    /// Incident and reflected time of flight in s; NaN where a pulse is missing.
    pub fn tofs_s(&self, shot: &Shot) -> (f64, f64) {
        let time = |peak: Option<Peak>| peak.map_or(f64::NAN, |peak| peak.0);
        let (t7, tw, t7r) = (
            time(self.incident),
            time(self.wall_peak),
            time(self.reflected),
        );
        ((tw - t7) * shot.time_s, (t7r - tw) * shot.time_s)
    }
}

/// A state within a step, for integrators without dense output: from the
/// step's start by short steps of RK4.
pub fn resolved(shot: &Shot, (start, y): (f64, &State), time: f64, parts: u32) -> State {
    let h = (time - start) / f64::from(parts);
    (0..parts).fold(*y, |state, _| rk4(shot, &state, h))
}

fn rk4(shot: &Shot, y: &State, h: f64) -> State {
    let mut k = [[0.0; crate::motion::STATE]; 4];
    derivative::<3>(shot, y, &mut k[0]);
    for (i, part) in [(1, 0.5), (2, 0.5), (3, 1.0)] {
        let stage = std::array::from_fn(|n| y[n] + part * h * k[i - 1][n]);
        derivative::<3>(shot, &stage, &mut k[i]);
    }
    std::array::from_fn(|n| y[n] + h / 6.0 * (k[0][n] + 2.0 * (k[1][n] + k[2][n]) + k[3][n]))
}
