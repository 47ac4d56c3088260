//! Whether the reflected pulse has passed, from samples alone.

use super::number::Number;
use super::record::Samples;
use crate::observe::{RETURN_WITHIN, WALL_WITHIN};

/// When a shot is over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// After its duration.
    Duration,
    /// When no later maximum can be the wall's peak or the reflected pulse: later
    /// than 3 tw and tw + 3 (tw − t7). The second sensor is the wall.
    Reflected,
    /// When the first sensor has fallen below 5 % of its maximum since the
    /// wall's peak, once the pulse has had the time to return. A later and
    /// larger maximum, which is then not seen, would be none of the first
    /// pulse to return. On chains on which nothing but contacts acts, bodies
    /// far behind that pulse on its way back are left as they are: they cannot
    /// overtake it.
    Passed,
    /// So many times as late after the wall's peak as the first sensor's largest sample since, once
    /// the pulse has had the time to return: for rows whose other maxima are known to be earlier.
    Behind(f64),
}

/// The sensor signal has passed below this fraction of its maximum.
const FALLEN: f64 = 0.05;

/// A pulse takes at least this share of its way to the wall to come back.
const SOONEST: f64 = 0.8;

/// A pulse that loses as much on its way back as on its way to the wall, where
/// it doubles, returns with wall²/(4 incident). What is below this share of
/// wall²/incident is a ripple, and the pulse may be yet to come.
const RETURNED: f64 = 0.1;

/// Samples after a maximum that its interpolation may use.
const MARGIN: usize = 8;

#[derive(Clone, Copy, Debug, Default)]
struct SamplePeak {
    value: f64,
    step: usize,
}

impl SamplePeak {
    fn look(&mut self, value: f64, step: usize) -> bool {
        let larger = value > self.value;
        if larger {
            *self = Self { value, step };
        }
        larger
    }
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Passing {
    least: f64,
    highest: SamplePeak,
    incident: SamplePeak,
    wall: SamplePeak,
    returned: SamplePeak,
    now: f64,
    seen: usize,
}

impl Passing {
    /// Of a lane in which a pulse has at least this height times step.
    pub(super) fn new(least: f64) -> Self {
        Self { least, ..Self::default() }
    }

    /// Whether a value at a step is a pulse's.
    fn is_pulse(&self, value: f64, step: usize) -> bool {
        value * step as f64 >= self.least
    }

    /// Looks at the samples up to a step, closely where any is the largest yet.
    pub(super) fn look<N: Number<W>, const W: usize>(
        &mut self,
        sensor: Samples<'_, N, W>,
        wall: Samples<'_, N, W>,
        step: usize,
    ) {
        let first = self.seen + 1;
        // A wall that is pressed harder than ever means a larger pulse: what
        // the sensor has shown until then is that pulse on its way in.
        let at_wall = wall.crest() > self.wall.value;
        let at_sensor = sensor.crest().max(self.now) > self.highest.value;
        if at_wall || at_sensor {
            let mut pressed = wall.since(first);
            let mut latest = [sensor.at(self.seen.saturating_sub(1).max(1)), self.now];
            for (at, after) in (first..).zip(sensor.since(first)) {
                let [before, now] = latest;
                if at > 2 && now >= before && now > after && self.is_pulse(now, at - 1) {
                    self.highest.look(now, at - 1);
                }
                latest = [now, after];
                let higher = |wall: f64| self.is_pulse(wall, at) && self.wall.look(wall, at);
                if at_wall && pressed.next().is_some_and(higher) {
                    (self.incident, self.returned) = (self.highest, SamplePeak::default());
                }
            }
        }
        let back = self.back();
        if step as f64 > back && sensor.crest() > self.returned.value {
            let later = (first..).zip(sensor.since(first));
            for (at, value) in later.filter(|&(at, _)| at as f64 > back) {
                self.returned.look(value, at);
            }
        }
        self.now = sensor.at(step);
        self.seen = step;
    }

    /// What the sensor showed at the wall's largest sample; 0 where none was followed.
    pub(super) fn at_wall_n<N: Number<W>, const W: usize>(&self, sensor: Samples<'_, N, W>) -> f64 {
        match self.wall.step {
            0 => 0.0,
            step => sensor.at(step),
        }
    }

    /// Step from which on a maximum can be the returned pulse; never before
    /// the wall has seen any.
    fn back(&self) -> f64 {
        match self.wall.value > 0.0 {
            true => self.wall.step as f64 + SOONEST * self.way(),
            false => f64::INFINITY,
        }
    }

    /// Steps from the incident peak to the wall's; 0 where there is none before it.
    fn way(&self) -> f64 {
        match self.incident.value > 0.0 {
            true => self.wall.step.saturating_sub(self.incident.step) as f64,
            false => 0.0,
        }
    }

    pub(super) fn is_over(&self, end: End, silent_n: f64) -> bool {
        if end == End::Duration || self.wall.value <= silent_n {
            return false;
        }
        let wall = self.wall.step as f64;
        let too_late = (WALL_WITHIN * wall).max(wall + RETURN_WITHIN * self.way());
        let back = self.returned;
        let returned = RETURNED * self.wall.value * self.wall.value;
        let is_back = back.value > silent_n && back.value * self.incident.value > returned;
        let passed = match end {
            End::Passed => self.now < FALLEN * back.value && self.seen > back.step + MARGIN,
            End::Behind(ways) => {
                let behind = wall + ways * (back.step as f64 - wall);
                self.seen as f64 > behind + MARGIN as f64
            }
            End::Duration | End::Reflected => false,
        };
        self.seen as f64 > too_late + MARGIN as f64 || (is_back && passed)
    }
}
