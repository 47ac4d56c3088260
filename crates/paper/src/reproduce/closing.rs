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
mod tests {
    use super::*;
    use hertzchain_experiment::preset;
    use hertzchain_sim::shoot;

    #[test]
    fn a_shot_that_goes_on_unchanged_has_its_own_way_back() {
        let dry = preset("dry").unwrap();
        for speed_m_s in [0.1, 1.0] {
            let (plan, _) = Plan::from_experiment(&dry, Some(speed_m_s)).unwrap();
            let plan = plan.with_accuracy(1e-8);
            let passage = shoot(&plan).unwrap().passage.unwrap();
            let back_s = passage.tof_reflected_s().unwrap();
            let again_s = reflected_s(&plan, &passage, |_, _| {}).unwrap().unwrap();
            // Both are right to 1e-8; steps begin anew at the wall's peak.
            assert!(
                (again_s / back_s - 1.0).abs() < 2e-8,
                "{speed_m_s}: {again_s:e} {back_s:e}"
            );
        }
    }

    #[test]
    fn closed_gaps_just_touch_and_overlaps_and_velocities_stay() {
        let (plan, _) = Plan::from_experiment(&preset("dry").unwrap(), Some(0.1)).unwrap();
        let system = System::new(&plan.chain).unwrap();
        let wall_s = shoot(&plan).unwrap().passage.unwrap().wall.time_s;
        let met = run(&system, &*adaptive(1e-9), Limits::until(wall_s), &mut []).unwrap();
        let open = State::after(&system, &met);
        let mut closed = open.clone();
        close_gaps(&system, &mut closed);
        assert_eq!(open.velocity_m_s, closed.velocity_m_s);
        let contacts = 0..system.contacts();
        let gaps = contacts
            .clone()
            .filter(|&c| open.overlap_m(&system, c) < -1e-9);
        // Behind a wave with losses only the first contacts are open.
        assert!(gaps.count() >= 5, "the wave leaves gaps behind");
        for contact in contacts {
            let was_m = open.overlap_m(&system, contact);
            // Displacements are fractions of a millimetre: rounding of their sums.
            let off_m = closed.overlap_m(&system, contact) - was_m.max(0.0);
            assert!(off_m.abs() < 1e-17, "{contact}: {off_m:e}");
        }
    }
}
