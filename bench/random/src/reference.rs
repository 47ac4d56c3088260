//! Maxima of a row's signals by the independent integration, and how right they are.

use crate::arrival::{Signals, largest};
use crate::motion::{Maximum, Motion, Scales, Stuck};
use crate::physics::{Contact, Equations};
use crate::row::Row;

/// Tolerances of a step: of the quick reference; of the tight one, and of the run that shows how
/// right that is.
const QUICK: f64 = 1e-11;
const TIGHT: [f64; 2] = [1e-13, 3e-12];
/// A pulse's height times time is at least this share of the momentum of the lightest body at the
/// striker's speed: docs/reference/conventions.md.
const FAINTEST: f64 = 1e-3;
/// The reference goes on for this many times what is needed.
pub(crate) const BEYOND: f64 = 1.02;
/// Longest step over the shortest time of the contacts that are watched.
const LONGEST_STEP: f64 = 0.1;

/// Least height of a maximum that must be listed above the dips beside it, over the largest.
const PROMINENT: f64 = 1e-2;

/// A row's signals by the independent integration.
pub(crate) struct Reference {
    least_n_s: f64,
    /// The reference, and where its error is to be known a looser one.
    runs: Vec<Motion>,
    prominent: [Vec<Maximum>; 2],
}

/// Time in s in which two bodies turn round: of a contact, by its elastic terms and their mass.
fn turning_s(contact: &Contact, mass_kg: f64, speed_m_s: f64) -> f64 {
    let rest_m = contact.rest_m.max(0.0);
    let goal = 0.5 * mass_kg * speed_m_s * speed_m_s;
    // Work of the force beyond the load, by the trapezoid rule in growing steps.
    let force = |d: f64| contact.closed(rest_m + d, 0.0, 0.0) - contact.load_n.max(0.0);
    let (mut overlap_m, mut work) = (1e-15, 0.0);
    while work < goal && overlap_m < 1.0 {
        let next = 1.02 * overlap_m;
        work += 0.5 * (force(overlap_m) + force(next)) * (next - overlap_m);
        overlap_m = next;
    }
    overlap_m / speed_m_s
}

fn scales(row: &Row, equations: &Equations, tolerance: f64) -> Scales {
    let inverse = &equations.inverse_mass;
    let times: Vec<f64> = (equations.contacts.iter().enumerate())
        .map(|(c, contact)| turning_s(contact, 1.0 / (inverse[c] + inverse[c + 1]), row.speed_m_s))
        .collect();
    let shortest = |times: &[f64]| times.iter().copied().fold(f64::INFINITY, f64::min);
    let count = row.beads.len();
    let watched = [times[row.sensor - 1], times[row.sensor], times[count]];
    Scales {
        speed_m_s: row.speed_m_s,
        time_s: shortest(&times),
        step_s: LONGEST_STEP * shortest(&watched),
        tolerance,
    }
}

impl Reference {
    /// Of a row, quickly: how right it is remains unknown.
    pub(crate) fn quick(row: &Row) -> Self {
        Self::with(row, &[QUICK])
    }

    /// Of a row, as right as can be, and how right.
    pub(crate) fn tight(row: &Row) -> Self {
        Self::with(row, &TIGHT)
    }

    fn with(row: &Row, tolerances: &[f64]) -> Self {
        let equations = Equations::new(row);
        let motion = |tolerance: &f64| {
            let scales = scales(row, &equations, *tolerance);
            Motion::new(equations.clone(), row.sensor, scales)
        };
        let masses = equations.inverse_mass.iter().map(|inverse| inverse.recip());
        Self {
            least_n_s: FAINTEST * row.speed_m_s * masses.fold(f64::INFINITY, f64::min),
            runs: tolerances.iter().map(motion).collect(),
            prominent: [Vec::new(), Vec::new()],
        }
    }

    /// Goes on until a time at least, and until the search for the arrival is over.
    pub(crate) fn cover(&mut self, until_s: f64) -> Result<(), Stuck> {
        // Without a time, growing ones until there is an arrival.
        let mut until_s = until_s;
        if until_s <= 0.0 {
            return self.until_arrival();
        }
        loop {
            for run in &mut self.runs {
                run.run(until_s)?;
            }
            match self.signals().arrival() {
                Some(arrival) if arrival.search_ends_s() >= until_s => {
                    until_s = BEYOND * arrival.search_ends_s();
                }
                _ => break,
            }
        }
        let run = &self.runs[0];
        self.prominent = [0, 1].map(|at| prominent(run.maxima(at), &run.dips[at]));
        Ok(())
    }

    /// Goes on until there is an arrival, and its search is over.
    fn until_arrival(&mut self) -> Result<(), Stuck> {
        let mut until_s = self.runs[0].scales().time_s;
        while self.signals().arrival().is_none() {
            for run in &mut self.runs {
                run.run(until_s)?;
            }
            until_s *= 2.0;
        }
        self.cover(until_s)
    }

    /// The maxima of both signals.
    pub(crate) fn signals(&self) -> Signals<'_> {
        let [sensor, wall] = [0, 1].map(|at| self.runs[0].maxima(at));
        Signals { sensor, wall, least_n_s: self.least_n_s }
    }

    /// Those maxima of the sensor bead and of the wall that stand out on both sides.
    pub(crate) fn prominent(&self) -> &[Vec<Maximum>; 2] {
        &self.prominent
    }

    /// How uncertain the time of a maximum of the sensor (0) or wall (1) is, in s.
    pub(crate) fn error_s(&self, signal: usize, maximum: &Maximum) -> f64 {
        let Some(looser) = self.runs.get(1) else {
            return 0.0;
        };
        let again = nearest(looser.maxima(signal), maximum.time_s);
        again.map_or(f64::INFINITY, |again| (again.time_s - maximum.time_s).abs())
    }
}

/// Maxima that rise above the dips beside them by some of the largest; the last one may still grow.
fn prominent(maxima: &[Maximum], dips: &[f64]) -> Vec<Maximum> {
    let least = PROMINENT * largest(maxima, |_| true).map_or(0.0, |maximum| maximum.height_n);
    let beside = maxima.iter().zip(dips.windows(2));
    let stands = |(maximum, dips): (&Maximum, &[f64])| {
        (maximum.height_n - dips[0].max(dips[1]) > least).then_some(*maximum)
    };
    beside.filter_map(stands).collect()
}

/// The maximum nearest to a time.
pub(crate) fn nearest(maxima: &[Maximum], time_s: f64) -> Option<Maximum> {
    let distance = |maximum: &Maximum| (maximum.time_s - time_s).abs();
    maxima.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b)))
}
