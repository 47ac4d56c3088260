//! The way back of a pulse without the gaps that it left behind.

use hertzchain_chain::observe::{Passage, RETURN_WITHIN, Signal};
use hertzchain_chain::settle::State;
use hertzchain_chain::wave::{Limits, run};
use hertzchain_chain::{Sensor, System};
use hertzchain_sim::accuracy::{adaptive, tolerance};
use hertzchain_sim::{Plan, StudyError};

/// Reflected ToF in s, by peaks, of a plan's shot whose state is changed at the
/// wall's peak; `None` when no pulse comes back.
pub(super) fn reflected_s(
    plan: &Plan,
    passage: &Passage,
    change: impl FnOnce(&System, &mut State),
) -> Result<Option<f64>, StudyError> {
    let method = adaptive(tolerance(plan).0);
    let system = System::new(&plan.chain)?;
    let until_wall = Limits::until(passage.wall.time_s);
    let met = run(&system, &*method, until_wall, &mut [])?;
    let mut state = State::after(&system, &met);
    change(&system, &mut state);
    let from = system.from_state(&state)?;
    let mut sensor = Signal::new(Sensor::Bead(plan.sensor_bead));
    let way_back = Limits::until(RETURN_WITHIN * passage.tof_incident_s());
    run(&from, &*method, way_back, &mut [&mut sensor])?;
    let returning = sensor.maxima().iter();
    let returning = returning.filter(|peak| peak.time_s > 0.0 && peak.value > 0.0);
    let largest = returning.max_by(|a, b| a.value.total_cmp(&b.value));
    Ok(largest.map(|peak| peak.time_s))
}

/// Sets all open contacts to just touching: whatever lies before a gap moves
/// toward the wall by it. Overlaps of closed contacts and velocities stay.
pub(super) fn close_gaps(system: &System, state: &mut State) {
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
