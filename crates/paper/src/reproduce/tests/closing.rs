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
        assert!((again_s / back_s - 1.0).abs() < 2e-8, "{speed_m_s}: {again_s:e} {back_s:e}");
    }
}

#[test]
fn closed_gaps_just_touch_and_overlaps_and_velocities_stay() {
    let (plan, _) = Plan::from_experiment(&preset("dry").unwrap(), Some(0.1)).unwrap();
    let system = System::new(&plan.chain).unwrap();
    let wall_s = shoot(&plan).unwrap().passage.unwrap().wall.time_s;
    let met = run(&system, &adaptive(&plan, 1e-9), Limits::until(wall_s), &mut []).unwrap();
    let open = State::after(&system, &met);
    let mut closed = open.clone();
    close_gaps(&system, &mut closed);
    assert_eq!(open.velocity_m_s, closed.velocity_m_s);
    let contacts = 0..system.contacts();
    let gaps = contacts.clone().filter(|&c| open.overlap_m(&system, c) < -1e-9);
    // Behind a wave with losses only the first contacts are open.
    assert!(gaps.count() >= 5, "the wave leaves gaps behind");
    for contact in contacts {
        let was_m = open.overlap_m(&system, contact);
        // Displacements are fractions of a millimetre: rounding of their sums.
        let off_m = closed.overlap_m(&system, contact) - was_m.max(0.0);
        assert!(off_m.abs() < 1e-17, "{contact}: {off_m:e}");
    }
}
