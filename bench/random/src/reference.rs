//! Maxima of a row's signals by the independent integration, and how right they are.

use crate::motion::{Maximum, Motion, Scales, Stuck};
use crate::physics::{Contact, Equations};
use crate::program::Peaks;
use crate::row::Row;

/// Tolerances of a step: of the reference, and of the run that shows how right it is.
const TOLERANCES: [f64; 2] = [1e-13, 3e-12];
/// Longest step over the shortest time of the contacts that are watched.
const LONGEST_STEP: f64 = 0.1;

/// Least height of a maximum that must be listed above the dips beside it, over the largest.
const PROMINENT: f64 = 1e-2;

/// The maxima of both signals until a time, and the same computed less tightly.
pub struct Reference {
    pub until_s: f64,
    /// Sensor bead, wall.
    pub maxima: [Vec<Maximum>; 2],
    /// Those of them that stand out on both sides.
    pub prominent: [Vec<Maximum>; 2],
    looser: [Vec<Maximum>; 2],
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
    /// Until a time.
    pub fn new(row: &Row, until_s: f64) -> Result<Self, Stuck> {
        let equations = Equations::new(row);
        let run = |tolerance| {
            let scales = scales(row, &equations, tolerance);
            let mut motion = Motion::new(&equations, row.sensor, scales);
            motion.run(until_s).map(|()| motion)
        };
        let [tight, loose] = TOLERANCES.map(run);
        let (tight, loose) = (tight?, loose?);
        let prominent = [0, 1].map(|at| prominent(&tight.maxima[at], &tight.dips[at]));
        Ok(Self {
            until_s,
            maxima: tight.maxima,
            prominent,
            looser: loose.maxima,
        })
    }

    /// Incident and reflected time of flight in s between the maxima nearest to peaks; NaN for the
    /// latter where none was picked.
    pub fn flights(&self, peaks: &Peaks) -> Option<[f64; 2]> {
        let incident_s = nearest(&self.maxima[0], peaks.incident.time_s)?.time_s;
        let wall_s = nearest(&self.maxima[1], peaks.wall.time_s)?.time_s;
        let back = peaks
            .reflected
            .and_then(|peak| nearest(&self.maxima[0], peak.time_s));
        Some([
            wall_s - incident_s,
            back.map_or(f64::NAN, |back| back.time_s - wall_s),
        ])
    }

    /// How uncertain the time of a maximum of the sensor (0) or wall (1) is, in s.
    pub fn error_s(&self, signal: usize, maximum: &Maximum) -> f64 {
        let again = nearest(&self.looser[signal], maximum.time_s);
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
pub fn nearest(maxima: &[Maximum], time_s: f64) -> Option<Maximum> {
    let distance = |maximum: &Maximum| (maximum.time_s - time_s).abs();
    maxima
        .iter()
        .copied()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// The largest maximum of those wanted.
pub fn largest(maxima: &[Maximum], wanted: impl Fn(&Maximum) -> bool) -> Option<Maximum> {
    let wanted = maxima.iter().copied().filter(|maximum| wanted(maximum));
    wanted.max_by(|a, b| a.height_n.total_cmp(&b.height_n))
}
