//! The arrival as docs/reference/conventions.md defines it ("Times of flight"), from lists of maxima alone.

use crate::motion::Maximum;

/// The wall's peak is looked for until this many times its time at least, and until it is later by
/// this many times of flight.
const WITHIN: f64 = 3.0;
/// Shares of a peak from which on earlier maxima, and others, compete with it.
const EARLIER: f64 = 0.1;
const OTHERS: f64 = 0.5;
/// Maxima of the wall compete until this many times its peak's time, or where they exceed it.
const ECHO: f64 = 2.0;

/// Names of the pulses, in the order of all arrays here.
pub(crate) const PULSES: [&str; 3] = ["incident", "wall", "reflected"];

/// Maxima of the sensor bead and of the wall, and the least height times time of a pulse.
#[derive(Clone, Copy)]
pub(crate) struct Signals<'a> {
    pub sensor: &'a [Maximum],
    pub wall: &'a [Maximum],
    pub least_n_s: f64,
}

/// How wrong a run may be that is to be compared: relative errors of heights and of times.
#[derive(Clone, Copy)]
pub(crate) struct Margin {
    pub height: f64,
    pub time: f64,
}

/// The peaks: that of the wall, and where they are, those of the sensor bead.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival {
    pub incident: Option<Maximum>,
    pub wall: Maximum,
    pub reflected: Option<Maximum>,
}

impl Arrival {
    /// When the search for the wall's peak and the reflected pulse ends, in s.
    pub(crate) fn search_ends_s(&self) -> f64 {
        let flight_s = self.incident.map_or(0.0, |it| self.wall.time_s - it.time_s);
        (WITHIN * self.wall.time_s).max(self.wall.time_s + WITHIN * flight_s)
    }
}

/// The largest maximum of those wanted.
pub(crate) fn largest(maxima: &[Maximum], wanted: impl Fn(&Maximum) -> bool) -> Option<Maximum> {
    let wanted = maxima.iter().copied().filter(|maximum| wanted(maximum));
    wanted.max_by(|a, b| a.height_n.total_cmp(&b.height_n))
}

impl Signals<'_> {
    fn is_pulse(&self, maximum: &Maximum, margin: f64) -> bool {
        let size = maximum.height_n * maximum.time_s;
        maximum.height_n > 0.0 && size * (1.0 + margin) >= self.least_n_s
    }

    /// The arrival, as far as these maxima go; none where no maximum of the wall is a pulse.
    pub(crate) fn arrival(&self) -> Option<Arrival> {
        let pulses = self.wall.iter().filter(|maximum| self.is_pulse(maximum, 0.0));
        let at = |wall: &Maximum| Arrival {
            incident: self.incident(wall.time_s),
            wall: *wall,
            reflected: None,
        };
        let stands = |arrival: &Arrival| !self.is_exceeded(arrival, 0.0, arrival.search_ends_s());
        let mut arrival = pulses.map(at).find(stands)?;
        arrival.reflected = self.reflected(&arrival);
        Some(arrival)
    }

    fn is_exceeded(&self, arrival: &Arrival, margin: f64, until_s: f64) -> bool {
        let later = |it: &&Maximum| it.time_s > arrival.wall.time_s && it.time_s <= until_s;
        let least_n = arrival.wall.height_n * (1.0 + margin);
        self.wall.iter().filter(later).any(|it| it.height_n > least_n)
    }

    fn incident(&self, wall_s: f64) -> Option<Maximum> {
        largest(self.sensor, |it| it.time_s < wall_s && self.is_pulse(it, 0.0))
    }

    fn reflected(&self, arrival: &Arrival) -> Option<Maximum> {
        let wall_s = arrival.wall.time_s;
        let until_s = wall_s + WITHIN * (wall_s - arrival.incident?.time_s);
        largest(self.sensor, |it| it.time_s > wall_s && it.time_s <= until_s)
    }

    /// The first pulse of which a pick is not the peak, within a margin; its peak here.
    pub(crate) fn refutes(
        &self,
        picked: &Arrival,
        margin: Margin,
    ) -> Option<(usize, Option<Maximum>)> {
        let Margin { height, time } = margin;
        let right = self.arrival();
        let wall_s = picked.wall.time_s;
        let must_be = |wall: &Maximum| {
            let other =
                Arrival { incident: self.incident(wall.time_s), wall: *wall, reflected: None };
            let until_s = other.search_ends_s();
            !self.is_exceeded(&other, -height, until_s * (1.0 + time))
        };
        let earlier = self.wall.iter().filter(|it| it.time_s < wall_s * (1.0 - time));
        let wrong = !self.is_pulse(&picked.wall, height)
            || self.is_exceeded(picked, height, picked.search_ends_s() * (1.0 - time))
            || earlier.filter(|it| self.is_pulse(it, -height)).any(must_be);
        if wrong {
            return Some((1, right.map(|it| it.wall)));
        }
        let before = |it: &Maximum| it.time_s < wall_s * (1.0 - time);
        let incident = largest(self.sensor, |it| before(it) && self.is_pulse(it, -height));
        if !is_highest(picked.incident, incident, height) {
            return Some((0, incident));
        }
        let flight_s = wall_s - picked.incident?.time_s;
        let from_s = wall_s + time * flight_s;
        let until_s = wall_s + (WITHIN - time) * flight_s;
        let back = largest(self.sensor, |it| it.time_s > from_s && it.time_s <= until_s);
        let back =
            back.filter(|it| it.height_n > 1e-3 * picked.incident.map_or(0.0, |it| it.height_n));
        (!is_highest(picked.reflected, back, height)).then_some((2, back))
    }

    /// Maxima that compete with the peaks, with their share of the peak: until which shares
    /// from which on they do.
    pub(crate) fn competing(&self, arrival: &Arrival, pulse: usize) -> Vec<(Maximum, f64)> {
        let (wall_s, flight_s) = match (arrival.incident, pulse) {
            (None, 0) => return Vec::new(),
            (incident, _) => {
                let wall_s = arrival.wall.time_s;
                (wall_s, incident.map_or(0.0, |it| wall_s - it.time_s))
            }
        };
        let peak = [arrival.incident, Some(arrival.wall), arrival.reflected][pulse];
        let Some(peak) = peak else { return Vec::new() };
        let within = |it: &&Maximum| match pulse {
            0 => it.time_s < wall_s && self.is_pulse(it, 0.0),
            1 => {
                let is_echo = it.time_s > ECHO * wall_s && it.height_n <= peak.height_n;
                !is_echo && self.is_pulse(it, 0.0)
            }
            _ => it.time_s > wall_s && it.time_s <= wall_s + WITHIN * flight_s,
        };
        let maxima = if pulse == 1 { self.wall } else { self.sensor };
        let others = maxima.iter().filter(within).filter(|it| **it != peak);
        let over = |it: &Maximum| {
            let is_early = it.time_s < peak.time_s && pulse != 2;
            let least = if is_early { EARLIER } else { OTHERS };
            (*it, it.height_n / peak.height_n / least)
        };
        others.map(over).collect()
    }
}

/// Whether a pick is as high as the highest, within a margin.
fn is_highest(picked: Option<Maximum>, highest: Option<Maximum>, margin: f64) -> bool {
    match (picked, highest) {
        (Some(picked), Some(highest)) => picked.height_n * (1.0 + margin) >= highest.height_n,
        (_, None) => true,
        (None, Some(_)) => false,
    }
}
