//! One shot: the wave, and what follows until rest.

use crate::StudyError;
use crate::rig::bench::Bench;
use crate::rig::tape::{Tape, Taping};
use hertzchain_chain::observe::Passages;
use hertzchain_chain::settle::{Rest, State};
use hertzchain_chain::wave::{DormandPrince, Limits, Outcome, run};
use hertzchain_chain::{Sensor, System};

/// Largest error per step of the wave. Incident times of flight of the paper's chains
/// are right to 10 ps, reflected ones to half a nanosecond.
const TOLERANCE: f64 = 1e-8;

/// The wave loop hands over to the slow scheme when the reflected pulse has
/// passed the sensor, or after this time in s.
const LONGEST_WAVE_S: f64 = 0.02;

/// What happened in the chain.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Incident time of flight in s, by peaks; NaN if no pulse was seen.
    pub incident_s: f64,
    /// Reflected time of flight in s; NaN likewise.
    pub reflected_s: f64,
    /// Times in s after the first touch of the incident, the wall's and the
    /// reflected peak.
    pub peaks_s: [f64; 3],
    /// Their heights in N.
    pub peaks_n: [f64; 3],
    /// Velocity in m/s with which the striker went for good; negative is away
    /// from the chain, NaN if it stayed at it.
    pub rebound_m_s: f64,
    /// Positions and velocities before the shot, the striker wherever it had been left.
    pub before: State,
    /// And after it.
    pub after: State,
    /// Gaps in m of contacts 1..=N before the shot.
    pub gaps_before_m: Vec<f64>,
    /// And after it.
    pub gaps_after_m: Vec<f64>,
    /// Overlaps in m of contacts 1..=N before the shot, negative across a gap: the loads
    /// that friction held, by the contacts' law at the shot's speed.
    pub overlaps_before_m: Vec<f64>,
    /// When the chain was at rest again, in s after the first touch.
    pub rest_s: f64,
}

/// Shoots with a speed in m/s and tapes the forces of both sensors.
///
/// # Errors
/// A shot that can't be computed.
pub fn shoot(
    bench: &mut Bench<'_>,
    sensor_bead: usize,
    speed_m_s: f64,
    tape: &mut Tape,
) -> Result<Shot, StudyError> {
    let (before, gaps_before_m) = (bench.state().clone(), bench.gaps_m());
    let (system, shot) = bench.aim(speed_m_s)?;
    let wall = shot.beads();
    let overlaps_before_m = (1..=wall).map(|contact| before.overlap_m(&system, contact));
    let overlaps_before_m = overlaps_before_m.collect();
    let mut passages = Passages::new(sensor_bead, wall, true);
    let outcome = {
        let sensors = [Sensor::Bead(sensor_bead), Sensor::Contact(wall)];
        let mut taping = Taping { tape, sensors };
        let method = DormandPrince {
            tolerance: TOLERANCE,
        };
        let limits = Limits::until(LONGEST_WAVE_S);
        run(&shot, &method, limits, &mut [&mut passages, &mut taping])?
    };
    let rest = slow(bench, (&system, &shot), &outcome, sensor_bead, tape)?;
    let [incident, wall, reflected] = peaks(&passages);
    Ok(Shot {
        incident_s: wall.0 - incident.0,
        reflected_s: reflected.0 - wall.0,
        peaks_s: [incident.0, wall.0, reflected.0],
        peaks_n: [incident.1, wall.1, reflected.1],
        rebound_m_s: rest
            .withdrawn
            .map_or(f64::NAN, |striker| striker.velocity_m_s),
        before,
        after: bench.state().clone(),
        gaps_before_m,
        gaps_after_m: bench.gaps_m(),
        overlaps_before_m,
        rest_s: outcome.time_s + rest.time_s,
    })
}

/// The slow phase after a wave, on the same tape.
fn slow(
    bench: &mut Bench<'_>,
    (system, shot): (&System, &System),
    outcome: &Outcome,
    sensor_bead: usize,
    tape: &mut Tape,
) -> Result<Rest, StudyError> {
    let still_n = |contact: usize| shot.static_contact(contact).force_n;
    let contacts = [sensor_bead - 1, sensor_bead, shot.beads()];
    let still_n = contacts.map(still_n);
    let mut note = |time_s: f64, forces_n: &[f64]| {
        let moving = |at: usize| forces_n.get(contacts[at]).map_or(0.0, |n| n - still_n[at]);
        let sensor_n = 0.5 * (moving(0) + moving(1));
        tape.note(outcome.time_s + time_s, [sensor_n, moving(2)]);
    };
    bench.rest_after(system, State::after(shot, outcome), &mut note)
}

/// Times in s and heights in N of the incident, the wall's and the reflected peak.
fn peaks(passages: &Passages) -> [(f64, f64); 3] {
    let nothing = (f64::NAN, f64::NAN);
    match passages.peaks() {
        Ok((incident, wall, reflected)) => [
            (incident.time_s, incident.value),
            (wall.time_s, wall.value),
            reflected.map_or(nothing, |peak| (peak.time_s, peak.value)),
        ],
        Err(_) => [nothing; 3],
    }
}
