//! Times of flight from the pulses that were seen.

use crate::plan::Pick;
use hertzchain_chain::observe::{Passage, Passages, Signal};
use hertzchain_measure::signal::delay_by_cross_correlation;

/// How long the pulse took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Incident time of flight in s: from the sensor bead to the wall.
    pub incident_s: f64,
    /// Reflected time of flight in s: from the wall back to the sensor bead.
    pub reflected_s: Option<f64>,
}

/// Pulses are correlated over this many incident widths to either side.
const WIDTHS: f64 = 2.0;

/// Samples in one incident width.
const SAMPLES: f64 = 100.0;

impl Flight {
    /// Picked from a passage.
    pub(crate) fn picked(pick: Pick, seen: &Passages, passage: &Passage) -> Option<Self> {
        match pick {
            Pick::Peak => Some(Self {
                incident_s: passage.tof_incident_s(),
                reflected_s: passage.tof_reflected_s(),
            }),
            Pick::Flank(fraction) => {
                let [sensor, wall, back] = seen.flanks(passage, fraction);
                let wall = wall?;
                Some(Self {
                    incident_s: wall - sensor?,
                    reflected_s: back.map(|back| back - wall),
                })
            }
            Pick::CrossCorrelation => correlated(seen, passage),
        }
    }

    /// Largest relative difference of two flights; infinite if only one has a
    /// reflected pulse.
    #[must_use]
    pub fn change(&self, other: &Self) -> f64 {
        let incident = relative(self.incident_s, other.incident_s);
        match (self.reflected_s, other.reflected_s) {
            (Some(one), Some(two)) => incident.max(relative(one, two)),
            (None, None) => incident,
            _ => f64::INFINITY,
        }
    }
}

pub(crate) fn relative(one: f64, two: f64) -> f64 {
    if one == two {
        0.0
    } else {
        ((one - two) / two).abs()
    }
}

fn correlated(seen: &Passages, passage: &Passage) -> Option<Flight> {
    let width = passage.incident_width_s?;
    let incident = sampled(seen.sensor(), passage.incident.time_s, width);
    let wall = sampled(seen.wall(), passage.wall.time_s, width);
    let lag = |one: &[f64], two: &[f64]| delay_by_cross_correlation(one, two, width / SAMPLES);
    let reflected_s = passage.reflected.and_then(|peak| {
        let back = sampled(seen.sensor(), peak.time_s, width);
        Some(peak.time_s - passage.wall.time_s + lag(&wall, &back)?)
    });
    Some(Flight {
        incident_s: passage.tof_incident_s() + lag(&incident, &wall)?,
        reflected_s,
    })
}

/// A signal around a time, which is the middle sample.
fn sampled(signal: &Signal, middle_s: f64, width_s: f64) -> Vec<f64> {
    let half = (WIDTHS * SAMPLES) as i32;
    let at = |i: i32| signal.at(middle_s + f64::from(i) * width_s / SAMPLES);
    (-half..=half).map(at).collect()
}
