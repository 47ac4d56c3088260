//! Shots over time, for pictures.

use super::ReproduceError;
use super::cases::{Cases, failed};
use super::gather::plan;
use hertzchain_chain::Sensor;
use hertzchain_chain::wave::Budget;
use hertzchain_sim::shoot;
use rayon::prelude::*;

/// Case and speed in m/s of the four panels of the paper's Fig. 2.
const SIGNAL_SHOTS: [(&str, f64); 4] =
    [("dry", 0.1368), ("pump", 1.152), ("gear", 0.1396), ("motor", 0.3993)];

/// Shots that are followed bead by bead, at the speed of the paper's split pulse, Fig. 2 (d).
const FILM_SHOTS: [(&str, f64); 2] = [("dry", 0.3993), ("motor", 0.3993)];

/// The paper's channel, bead sensor plus wall, of one shot.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SignalShot {
    pub case: String,
    pub speed_m_s: f64,
    pub time_s: Vec<f64>,
    /// Dynamic force of the bead sensor and the wall, added, in N.
    pub channel_n: Vec<f64>,
    /// Time in s and force in N of the incoming, wall and returning peak.
    pub peaks: Vec<(f64, f64)>,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Film {
    pub case: String,
    pub speed_m_s: f64,
    pub time_s: Vec<f64>,
    /// Velocity of each body in m/s, the striker first; one column a body.
    pub velocity_m_s: Vec<Vec<f64>>,
    pub budgets: Vec<Budget>,
}

/// Samples of a signal are this far apart, in s: the paper's 1 MS/s.
const SIGNAL_SAMPLE_S: f64 = 1e-6;

/// Frames of a film are this far apart, in s.
const FRAME_S: f64 = 2e-6;

/// Accuracy of a film, whose budget residual is of its size.
const FILM_ACCURACY: f64 = 1e-9;

pub(super) fn signals(cases: &Cases, accuracy: f64) -> Result<Vec<SignalShot>, ReproduceError> {
    let signal = |&(case, speed_m_s): &(&str, f64)| {
        let plan = plan(cases.get(case)?, speed_m_s, accuracy)?.for_flights();
        let channel = Sensor::BeadPlusWall(plan.sensor_bead);
        let shot = shoot(&plan.watching(vec![channel], Some(SIGNAL_SAMPLE_S)))
            .map_err(|error| failed(case, speed_m_s, error))?;
        let trace = shot.trace.unwrap_or_default();
        let peaks = shot.passage.map_or(Vec::new(), |p| {
            let all = [Some(p.incident), Some(p.wall), p.reflected];
            all.into_iter().flatten().map(|peak| (peak.time_s, peak.value)).collect()
        });
        Ok(SignalShot {
            case: case.to_owned(),
            speed_m_s,
            time_s: trace.time_s,
            channel_n: trace.columns.into_iter().next().unwrap_or_default(),
            peaks,
        })
    };
    SIGNAL_SHOTS.par_iter().map(signal).collect()
}

pub(super) fn films(cases: &Cases) -> Result<Vec<Film>, ReproduceError> {
    let film = |&(case, speed_m_s): &(&str, f64)| {
        let plan = plan(cases.get(case)?, speed_m_s, FILM_ACCURACY)?.for_flights();
        let bodies = (0..=plan.chain.beads.len()).map(Sensor::Velocity).collect();
        let shot = shoot(&plan.with_budget().watching(bodies, Some(FRAME_S)))
            .map_err(|error| failed(case, speed_m_s, error))?;
        let trace = shot.trace.unwrap_or_default();
        Ok(Film {
            case: case.to_owned(),
            speed_m_s,
            time_s: trace.time_s,
            velocity_m_s: trace.columns,
            budgets: trace.budgets,
        })
    };
    FILM_SHOTS.par_iter().map(film).collect()
}
