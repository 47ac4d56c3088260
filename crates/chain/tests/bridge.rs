//! Liquid bridges: against Young and Laplace's equation, and two bodies whose energy is known.

use crate::common::ensemble::settings;
use crate::common::{self, BALL, STEEL, close, hertz, row};
use hertzchain_chain::ensemble::{Precision, Shot, fire};
use hertzchain_chain::laws::{Closed, Columns, Law, find};
use hertzchain_chain::settle::{SlowPhase, State, settle};
use hertzchain_chain::wave::{Limits, Method, Outcome, run};
use hertzchain_chain::*;
use std::f64::consts::PI;
use std::sync::Arc;

const TENSION_N_M: f64 = 0.03;
const VOLUME_M3: f64 = 1e-10;

fn liquid(volume_m3: f64, angle_rad: f64) -> Arc<dyn Law> {
    let given =
        [("surface_tension", TENSION_N_M), ("volume", volume_m3), ("contact_angle", angle_rad)];
    find("capillary_bridge").unwrap().build(&given).unwrap()
}

/// Two bodies with this reduced radius in m.
fn joined(law: &dyn Law, radius_m: f64) -> Columns {
    let pair = BeadPair { left: STEEL, right: STEEL, radius_m, mass_kg: 4e-3 };
    Columns::from_rows(&[law.coefficients(&pair).unwrap()])
}

fn pull_n(law: &dyn Law, k: &Columns, gap_m: f64) -> f64 {
    -law.force(k, 0, Closed { overlap: -gap_m, root: 0.0, rate: 0.0, largest: 0.0 })
}

/// Pull at touch and work up to rupture of a bridge between two balls.
fn strength() -> (f64, f64) {
    let law = liquid(VOLUME_M3, 0.0);
    let k = joined(&*law, 0.5 * BALL.radius_m);
    (pull_n(&*law, &k, 0.0), -law.energy(&k, 0, 0.0, 0.0))
}

#[test]
fn touching_bodies_are_pulled_by_the_known_force() {
    let law = liquid(VOLUME_M3, 0.5);
    let touch_n = |radius_m| pull_n(&*law, &joined(&*law, radius_m), 0.0);
    let tension_n = |radius_m: f64| PI * radius_m * TENSION_N_M * 0.5_f64.cos();
    // Equal spheres 2πRγ cos θ, a sphere on a plane 4πRγ cos θ: R* is R/2 and R.
    close(touch_n(0.5e-3), 2.0 * tension_n(1e-3), 1e-15);
    close(touch_n(1e-3), 4.0 * tension_n(1e-3), 1e-15);
    assert!(find("capillary_bridge").unwrap().build(&[("volume", 1e-10)]).is_err());
    let wide = liquid(VOLUME_M3, 1.6);
    let pair = BeadPair { left: STEEL, right: STEEL, radius_m: 1e-3, mass_kg: 1e-3 };
    assert!(wide.coefficients(&pair).unwrap_err().to_string().contains("90 at most"));
}

#[test]
fn force_and_rupture_are_those_of_young_and_laplace() {
    let text = include_str!("../../../bench/film/bridge.json");
    let all: serde_json::Value = serde_json::from_str(text).unwrap();
    let radius_m = 5e-3_f64;
    let mut seen = 0;
    for case in all["cases"].as_array().unwrap() {
        let number = |name: &str| case[name].as_f64().unwrap();
        let numbers = |name: &str| {
            let all = case[name].as_array().unwrap().clone();
            all.into_iter().map(|number| number.as_f64().unwrap())
        };
        let law = liquid(number("volume") * radius_m.powi(3), number("angle_deg").to_radians());
        let k = joined(&*law, 0.5 * radius_m);
        let rupture_m = law.rupture(&k, 0);
        // 0.8 % too short to 3.5 % too long.
        close(rupture_m, number("rupture") * radius_m, 0.04);
        for (gap, force) in numbers("gap").zip(numbers("force")) {
            let gap_m = gap * radius_m;
            if gap_m < rupture_m {
                let apart_n = pull_n(&*law, &k, gap_m) - 2.0 * PI * radius_m * TENSION_N_M * force;
                // The published form: 3 % of the pull at touch for the least volume, 9 % for the largest.
                let most = 0.1 * pull_n(&*law, &k, 0.0);
                assert!(apart_n.abs() < most, "{apart_n} of {most} at {gap} in {case}");
                seen += 1;
            }
        }
    }
    assert!(seen > 60, "{seen}");
}

#[test]
fn pull_is_the_slope_of_the_energy_which_is_0_at_rupture() {
    let law = liquid(VOLUME_M3, 0.3);
    let k = joined(&*law, 3e-3);
    let rupture_m = law.rupture(&k, 0);
    for overlap in [1e-5, 1e-6, -1e-6, -1e-4, -0.9 * rupture_m] {
        let energy = |overlap: f64| law.energy(&k, 0, overlap, overlap);
        let step = 1e-3 * f64::abs(overlap);
        let slope = (energy(overlap + step) - energy(overlap - step)) / (2.0 * step);
        // Curvature at a step of 1e-3, and rounding of the work over the smallest step.
        close(slope, -pull_n(&*law, &k, -overlap), 3e-6);
    }
    assert_eq!(law.energy(&k, 0, -rupture_m, 0.0), 0.0);
    assert_eq!(pull_n(&*law, &k, 1.001 * rupture_m), 0.0);
    assert!(law.energy(&k, 0, 0.0, 0.0) < 0.0);
}

/// Two free balls, the first of which moves at this speed in m/s; a gap in m between them.
fn two(speed_m_s: f64, gap_m: f64, tension: Tension) -> Chain {
    Chain {
        start: Start::Free,
        far: FarEnd::Free,
        initial: vec![Initial { bead: 1, displacement_m: 0.0, velocity_m_s: speed_m_s }],
        gaps: vec![Gap { contact: 1, gap_m }],
        tension,
        ..row(2, 1.0, vec![hertz(), liquid(VOLUME_M3, 0.0)])
    }
}

/// Speed at which two balls part that met at a speed, or that a bridge held with some energy.
fn parting_m_s(speed_m_s: f64, spent_j: f64) -> f64 {
    (speed_m_s * speed_m_s - 4.0 * spent_j / BALL.mass_kg).sqrt()
}

#[test]
fn balls_that_meet_lose_the_work_of_the_bridge_that_forms() {
    let (_, work_j) = strength();
    for tension in [Tension::Allowed, Tension::Clipped] {
        let outcome = common::run_for(&two(0.02, 1e-4, tension), 1e-11, 0.2);
        let parting = outcome.velocity_m_s[2] - outcome.velocity_m_s[1];
        // Many steps at 1e-11.
        close(parting, parting_m_s(0.02, work_j), 1e-8);
        let budget = outcome.budget.unwrap();
        assert_eq!(budget.dissipated[0].law, "capillary_bridge");
        close(budget.dissipated[0].energy_j, work_j, 1e-7);
        assert!(budget.relative_residual().abs() < 1e-9, "{budget:?}");
        assert!(!outcome.bridged[1]);
    }
}

#[test]
fn a_bridge_holds_balls_that_part_too_slowly() {
    let (pull, work_j) = strength();
    // At rest Hertz's force balances the pull.
    let chain = |speed_m_s: f64| two(-speed_m_s, 0.0, Tension::Allowed);
    let system = System::new(&chain(1.0)).unwrap();
    let rest = system.static_contact(1);
    let pressed_j = 0.6 * pull * rest.overlap_m;
    let least_m_s = (4.0 * (work_j + pressed_j) / BALL.mass_kg).sqrt();
    assert!((7.0e-3..7.3e-3).contains(&least_m_s), "{least_m_s}");
    let faster = common::run_for(&chain(1.2 * least_m_s), 1e-11, 0.3);
    let parting = faster.velocity_m_s[2] - faster.velocity_m_s[1];
    close(parting, parting_m_s(1.2 * least_m_s, work_j + pressed_j), 1e-8);
    assert_eq!(faster.bridged, [false; 3]);
    // The bridge was there before.
    let lost_j = faster.budget.unwrap().dissipated[0].energy_j;
    assert!(lost_j.abs() < 1e-8 * work_j, "{lost_j}");
    let slower = common::run_for(&chain(0.9 * least_m_s), 1e-10, 0.3);
    assert!(slower.bridged[1]);
    assert!(slower.budget.unwrap().relative_residual().abs() < 1e-8);
    let fixed = run(
        &System::new(&chain(1.2 * least_m_s)).unwrap(),
        &Method::rk4(1e-6),
        Limits::until(0.3),
        &mut [],
    );
    let velocity_m_s = fixed.unwrap().velocity_m_s;
    // Where the bridge ruptures no step ends: 30 µN over 1 µs.
    close(velocity_m_s[2] - velocity_m_s[1], parting, 1e-5);
}

#[test]
fn a_row_rests_on_its_bridges_and_stays() {
    let (pull, _) = strength();
    let wet = |push| Chain { push, ..row(6, 0.3, vec![hertz(), liquid(VOLUME_M3, 0.0)]) };
    let stiffness =
        BeadPair { left: STEEL, right: STEEL, radius_m: 0.5 * BALL.radius_m, mass_kg: 1.0 }
            .hertz_stiffness();
    for force_n in [0.0, 0.24] {
        let chain = wet(Push::Constant { force_n });
        let system = System::new(&chain).unwrap();
        let rest = system.static_contact(3);
        close(stiffness * rest.overlap_m.powf(1.5), force_n + pull, 1e-12);
        // Rounding of the sum of both forces.
        assert!((rest.force_n - force_n).abs() < 1e-16, "{rest:?}");
        assert_eq!(system.static_contact(0).overlap_m, 0.0);
        let still = Chain { start: Start::Free, ..chain };
        let outcome = common::run_for(&still, 1e-9, 1e-3);
        // Rounding of the static force over 1 ms.
        assert!(outcome.velocity_m_s.iter().all(|v| v.abs() < 1e-15), "{outcome:?}");
    }
    let gap = Chain { gaps: vec![Gap { contact: 3, gap_m: 1e-5 }], ..wet(Push::None) };
    let apart = System::new(&gap).unwrap().static_contact(3);
    assert_eq!((apart.overlap_m, apart.force_n), (-1e-5, 0.0));
}

/// One ball beside a half-ball, at a gap in m.
fn beside_a_wall(gap_m: f64, bridged: bool) -> (System, State) {
    let laws = vec![hertz(), liquid(VOLUME_M3, 0.0)];
    let system = System::new(&Chain { start: Start::Free, ..row(1, 1.0, laws) }).unwrap();
    let mut state = State::laid(&system, &[0.0, gap_m]);
    state.bridged[1] = bridged;
    (system, state)
}

fn come_to_rest(system: &System, state: &mut State, friction_coefficient: f64) -> (usize, f64) {
    let slow = SlowPhase { friction_coefficient, ..SlowPhase::default() };
    let rest = settle(system, state, &slow, &mut |_, _, _| {}).unwrap();
    (rest.closed_contacts, rest.gaps_m[1])
}

#[test]
fn a_bridge_draws_a_ball_back_that_friction_does_not_hold() {
    // Pull 1.0 mN at 20 µm; friction 0.84 and 4.2 mN.
    let cases = [(true, 0.01, 1), (true, 0.05, 0), (false, 0.01, 0)];
    for (bridged, friction_coefficient, closed) in cases {
        let (system, mut state) = beside_a_wall(2e-5, bridged);
        let (contacts, gap_m) = come_to_rest(&system, &mut state, friction_coefficient);
        assert_eq!(contacts, closed, "{bridged} {friction_coefficient} {gap_m}");
        if closed == 0 {
            // The gap is a difference of places.
            close(gap_m, 2e-5, 1e-11);
        }
        assert_eq!(state.bridged[1], bridged);
    }
}

#[test]
fn a_ball_slides_away_as_far_as_bridge_and_friction_let_it() {
    let (_, work_j) = strength();
    let (friction_coefficient, weight_n) = (0.05, BALL.mass_kg * STANDARD_GRAVITY_M_S2);
    let law = liquid(VOLUME_M3, 0.0);
    let k = joined(&*law, 0.5 * BALL.radius_m);
    for (speed_m_s, torn) in [(5e-3, false), (2.5e-2, true)] {
        let (system, mut state) = beside_a_wall(0.0, false);
        state.velocity_m_s[1] = -speed_m_s;
        let (_, gap_m) = come_to_rest(&system, &mut state, friction_coefficient);
        let of_bridge_j = work_j + law.energy(&k, 0, -gap_m, 0.0);
        let spent_j = friction_coefficient * weight_n * gap_m + of_bridge_j;
        // Steps of 20 µs: the last one, and a leapfrog's second order.
        close(spent_j, 0.5 * BALL.mass_kg * speed_m_s * speed_m_s, 1e-3);
        assert_eq!(state.bridged[1], !torn);
    }
}

#[test]
fn bridges_last_from_a_shot_to_the_next() {
    let laws = vec![hertz(), liquid(VOLUME_M3, 0.0)];
    let system = System::new(&Chain { push: Push::None, ..row(4, 0.05, laws) }).unwrap();
    let limits = Limits::until(2e-3);
    let method = Method::dormand_prince(1e-9);
    let outcome: Outcome = run(&system, &method, limits, &mut []).unwrap();
    let mut state = State::after(&system, &outcome);
    assert_eq!(state.bridged, outcome.bridged);
    settle(&system, &mut state, &SlowPhase::default(), &mut |_, _, _| {}).unwrap();
    let bridged = state.bridged.clone();
    assert!(bridged.iter().any(|&bridged| bridged), "{bridged:?}");
    state.strike(&system, 0.05);
    let shot = system.from_state(&state).unwrap();
    for contact in 1..=4 {
        let rest = shot.static_contact(contact);
        // A pull across a gap is balanced by friction.
        let pulled = bridged[contact] && rest.overlap_m < 0.0;
        assert_eq!(rest.force_n < 0.0, pulled, "{contact}: {rest:?} {bridged:?}");
    }
    // Beads laid against each other are bridged, and balanced.
    let mut beads = State::laid(&system, &[]);
    beads.bridged.fill(false);
    beads.displacement_m[0] -= 1e-3;
    let laid = system.from_state(&beads).unwrap();
    let outcome = run(&laid, &method, Limits::until(1e-4), &mut []).unwrap();
    assert_eq!(outcome.bridged, [false, true, true, true, true]);
    assert!(outcome.velocity_m_s.iter().all(|v| v.abs() < 1e-15), "{outcome:?}");
}

#[test]
fn bridges_that_the_wave_has_not_reached_leave_it_as_it_is() {
    let section = |contacts, laws| Section { contacts, laws, material: None };
    let wet = section(13..=20, vec![hertz(), liquid(VOLUME_M3, 0.0)]);
    let dry = row(20, 0.7, vec![hertz()]);
    let far = Chain { sections: vec![section(0..=12, vec![hertz()]), wet], ..dry.clone() };
    let [far, dry] = [far, dry].map(|chain| common::run_for(&chain, 1e-10, 1e-4));
    for bead in 0..6 {
        close(far.velocity_m_s[bead], dry.velocity_m_s[bead], 1e-7);
    }
    assert!(far.budget.is_some());
}

#[test]
fn what_has_no_bridges_refuses_them() {
    let laws = vec![hertz(), liquid(VOLUME_M3, 0.0)];
    let system = System::new(&row(4, 0.3, laws.clone())).unwrap();
    let shot = Shot { system: &system, step: 0.02, duration_s: 1e-3, precision: Precision::Double };
    let refused = fire(&[shot], &settings(4)).remove(0).unwrap_err();
    assert!(refused.to_string().contains("needs the wave loop"), "{refused}");
    let two = [laws, vec![liquid(2.0 * VOLUME_M3, 0.0)]].concat();
    let refused = System::new(&row(4, 0.3, two)).unwrap_err();
    assert!(refused.to_string().contains("more than one bridge"), "{refused}");
    let dry = row(4, 0.3, vec![hertz(), liquid(0.0, 0.0)]);
    let velocity = |chain: &Chain| common::run_for(chain, 1e-9, 1e-3).velocity_m_s[0];
    // Changes of contacts are located a little more often.
    close(velocity(&dry), velocity(&row(4, 0.3, vec![hertz()])), 1e-7);
}
