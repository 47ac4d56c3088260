//! Chains on which a solver, a window or a picker can fall into a trap.

use crate::common::*;
use hertzchain_chain::laws::{
    DampingCubic, DampingCubicUngated, DampingKuwabaraKono, DampingLinear, law,
};
use hertzchain_chain::observe::{Apart, Signal};
use hertzchain_chain::wave::{Limits, Method, Outcome, run};
use hertzchain_chain::*;

fn at(chain: &Chain, tolerance: f64, duration_s: f64, whole_chain: bool) -> Outcome {
    let system = System::new(chain).unwrap();
    let limits = Limits {
        budget: true,
        whole_chain,
        force_passes: Some(2_000_000),
        ..Limits::until(duration_s)
    };
    run(&system, &Method::dormand_prince(tolerance), limits, &mut []).unwrap()
}

fn gap(contact: usize, gap_m: f64) -> Gap {
    Gap { contact, gap_m }
}

#[test]
fn a_contact_that_closes_after_a_long_flight_is_landed_on() {
    let falling = Chain {
        incline_rad: std::f64::consts::FRAC_PI_2,
        gaps: vec![gap(0, 1e-2)],
        ..row(3, 0.1, vec![hertz()])
    };
    let laws = vec![hertz(), viscoelastic(), cubic()];
    let gaps = (0..=5).map(|c| gap(c, 1e-4 * (1 + 7 * c % 5) as f64)).collect();
    let loose = Chain { gaps, ..row(5, 0.5, laws) };
    for tolerance in [1e-9, 5e-12] {
        for chain in [&falling, &loose] {
            let outcome = at(chain, tolerance, 2e-2, false);
            let residual = outcome.budget.unwrap().relative_residual();
            assert!(residual.abs() < 300.0 * tolerance, "{residual:e}");
        }
    }
}

#[test]
fn a_driven_end_is_not_stepped_over_while_nothing_touches() {
    let motion = Motion::Sine { amplitude_m: 1e-4, frequency_hz: 1e3 };
    let chain = Chain {
        start: Start::Driven { bead: BALL, motion },
        gaps: vec![gap(0, 0.99e-4)],
        far: FarEnd::Free,
        ..row(1, 1.0, vec![hertz()])
    };
    let outcome = at(&chain, 1e-8, 2e-3, false);
    // The driver is all but at rest where it meets the bead: some cm/s.
    assert!(outcome.velocity_m_s[1] > 1e-2, "{}", outcome.velocity_m_s[1]);
}

#[test]
fn a_spring_without_force_still_pushes_a_bead_that_comes_back() {
    let push = Push::Spring { force_n: 0.0, stiffness_n_m: 1e4 };
    let chain = Chain { push, ..row(600, 0.5, vec![hertz()]) };
    let (part, whole) = (at(&chain, 1e-8, 9e-3, false), at(&chain, 1e-8, 9e-3, true));
    assert_eq!(part.velocity_m_s[1].to_bits(), whole.velocity_m_s[1].to_bits());
    assert!(part.budget.unwrap().relative_residual().abs() < 2e-5);
}

#[test]
fn nothing_acts_across_a_contact_that_does_not_exist() {
    let ungated = law(DampingCubicUngated(DampingCubic { coefficient_kg_s_m2: 77.0 }));
    let moving = |bead| Initial { bead, displacement_m: 0.0, velocity_m_s: 1.0 };
    let chain = Chain {
        start: Start::Free,
        far: FarEnd::Free,
        initial: vec![moving(1), moving(2)],
        ..row(2, 1.0, vec![hertz(), ungated])
    };
    assert_eq!(at(&chain, 1e-8, 1e-3, false).velocity_m_s[1..3], [1.0, 1.0]);
}

/// The wall is a dashpot: its force is largest at the very touch.
#[test]
fn a_maximum_at_a_force_jump_out_of_silence_is_seen() {
    let dashpot = law(DampingLinear { coefficient_n_s_m: 3000.0 });
    let section = |contacts, laws| Section { contacts, laws, material: None };
    let chain = Chain {
        sections: vec![section(0..=4, vec![hertz()]), section(5..=5, vec![hertz(), dashpot])],
        gaps: vec![gap(5, 1e-5)],
        ..row(5, 0.5, vec![])
    };
    let system = System::new(&chain).unwrap();
    // A step of a given length runs across the jump: what it interpolates there is of low order.
    let given = [(Method::rk4(1e-6), 0.03), (Method::rk4(3e-7), 2e-4)];
    for (method, off) in [(Method::dormand_prince(1e-9), 1e-6)].into_iter().chain(given) {
        let (mut wall, mut bead) =
            (Signal::new(Sensor::Contact(5)), Signal::new(Sensor::Velocity(5)));
        run(&system, &method, Limits::until(3e-4), &mut [&mut wall, &mut bead]).unwrap();
        let speed = bead.maxima().iter().map(|m| m.value).fold(0.0, f64::max);
        let peak = wall.maxima().iter().map(|m| m.value).fold(0.0, f64::max);
        close(peak, 3000.0 * speed, off);
    }
}

/// Between steps of Verlet forces that follow a velocity are not those that the rates at their ends say.
#[test]
fn a_smooth_maximum_is_one_whatever_the_step() {
    let laws = vec![hertz(), law(DampingLinear { coefficient_n_s_m: 400.0 })];
    let system = System::new(&row(8, 0.5, laws)).unwrap();
    let peak = |method: Method| {
        let mut wall = Signal::new(Sensor::Contact(8));
        run(&system, &method, Limits::until(3e-4), &mut [&mut wall]).unwrap();
        let highest = wall.maxima().iter().max_by(|a, b| a.value.total_cmp(&b.value)).copied();
        let highest = highest.unwrap_or_else(|| panic!("{method:?}"));
        (highest.time_s, highest.value)
    };
    let (time_s, value) = peak(Method::dormand_prince(1e-9));
    for step_s in [2e-7, 5e-8, 2e-8, 1e-8, 5e-9, 2e-9] {
        let found = peak(Method::verlet(step_s));
        assert!((found.0 - time_s).abs() < step_s, "{step_s} {found:?} {time_s}");
        close(found.1, value, 4e3 * step_s);
    }
}

#[test]
fn a_shot_between_free_ends_ends_when_all_fly_apart() {
    let chain = Chain { far: FarEnd::Free, ..row(2, 0.5, vec![hertz()]) };
    let system = System::new(&chain).unwrap();
    let method = Method::dormand_prince(1e-8);
    let outcome = run(&system, &method, Limits::until(0.1), &mut [&mut Apart]).unwrap();
    assert!(outcome.finished && outcome.time_s < 1e-3);
}

#[test]
fn every_bead_of_a_ring_has_a_sensor() {
    let initial = vec![Initial { bead: 5, displacement_m: 0.0, velocity_m_s: 1.0 }];
    let far = FarEnd::Periodic { force_n: 0.0 };
    let chain = Chain { start: Start::Free, initial, ..unit_row(10, 1.0, far) };
    let system = System::new(&chain).unwrap();
    let mut first = Signal::new(Sensor::Bead(1));
    let mut nowhere = Signal::new(Sensor::Bead(0));
    let method = Method::dormand_prince(1e-8);
    run(&system, &method, Limits::until(20.0), &mut [&mut first, &mut nowhere]).unwrap();
    assert!(!first.maxima().is_empty());
    assert!(nowhere.maxima().is_empty());
}

#[test]
fn a_striker_hangs_on_a_thread_like_the_balls_it_hits() {
    let suspension_m = Some(0.1);
    let chain = Chain { far: FarEnd::Free, suspension_m, ..row(3, 0.5, vec![hertz()]) };
    let residual = at(&chain, 1e-9, 0.05, false).budget.unwrap().relative_residual();
    assert!(residual.abs() < 3e-7, "{residual:e}");
}

#[test]
fn a_ring_on_threads_stays_closed() {
    let initial = vec![Initial { bead: 1, displacement_m: 0.0, velocity_m_s: 0.1 }];
    let far = FarEnd::Periodic { force_n: 1.0 };
    let ring = Chain { start: Start::Free, far, initial, ..row(6, 1.0, vec![hertz()]) };
    let chain = Chain { suspension_m: Some(0.1), ..ring };
    // Threads cannot hang under a load along the row.
    assert!(matches!(System::new(&chain), Err(ChainError::Equilibrium(_))));
    let loose = Chain { far: FarEnd::Periodic { force_n: 0.0 }, ..chain };
    let outcome = at(&loose, 1e-9, 1e-2, false);
    assert_eq!(outcome.displacement_m[1].to_bits(), outcome.displacement_m[7].to_bits());
    let residual = outcome.budget.unwrap().relative_residual();
    // Ten thousand steps of many collisions, each wrong by up to the tolerance.
    assert!(residual.abs() < 1e-5, "{residual:e}");
}

#[test]
fn the_window_changes_no_bit_of_a_fixed_step_method_either() {
    let laws = vec![hertz(), viscoelastic(), cubic()];
    let system = System::new(&row(60, 0.5, laws)).unwrap();
    let shot = |whole_chain| {
        let limits = Limits { whole_chain, ..Limits::until(5e-4) };
        run(&system, &Method::verlet(1e-7), limits, &mut []).unwrap().velocity_m_s
    };
    assert_eq!(shot(true), shot(false));
}

#[test]
fn settings_and_motions_that_mean_nothing_are_refused() {
    let system = System::new(&row(3, 0.5, vec![hertz()])).unwrap();
    for step_s in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(run(&system, &Method::verlet(step_s), Limits::until(1e-5), &mut []).is_err());
    }
    for tolerance in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        let method = Method::dormand_prince(tolerance);
        assert!(run(&system, &method, Limits::until(1e-5), &mut []).is_err());
    }
    let endless = Limits { force_passes: Some(1000), ..Limits::until(f64::INFINITY) };
    assert!(run(&system, &Method::dormand_prince(1e-6), endless, &mut []).is_err());
    let tables = [
        (vec![0.0, 1.0], vec![0.0]),
        (vec![1.0, 0.0], vec![0.0, 1.0]),
        (vec![0.0, f64::NAN], vec![0.0, 1.0]),
    ];
    for (times_s, positions_m) in tables {
        let start = Start::Driven { bead: BALL, motion: Motion::Table { times_s, positions_m } };
        assert!(System::new(&Chain { start, ..row(3, 0.5, vec![hertz()]) }).is_err());
    }
}

#[test]
fn rounding_moves_no_peak_in_steps_much_shorter_than_a_contact() {
    let material = Material { young_modulus_pa: 23.5e9, poisson_ratio: 0.38, ..STEEL };
    let bead = Bead { radius_m: 0.013, mass_kg: 0.0106, material };
    let striker = Bead { radius_m: 0.0466, mass_kg: 0.4823, material };
    let kuwabara_kono = law(DampingKuwabaraKono { coefficient: 1456.4 });
    let linear = law(DampingLinear { coefficient_n_s_m: 3.4975 });
    let chain = Chain {
        beads: vec![bead],
        start: Start::Striker { bead: striker, speed_m_s: 0.09382 },
        far: FarEnd::HalfBead { radius_m: bead.radius_m, material },
        gaps: vec![gap(1, 4.977e-9)],
        ..row(1, 0.0, vec![hertz(), kuwabara_kono, linear])
    };
    let [exact, near, nearer] = [1e-13, 1.5e-12, 5e-13].map(|tolerance| shoot(&chain, tolerance).0);
    for seen in [near, nearer] {
        // Of 6.7 µs: errors of the integration; a quotient's rounding was 3e-7 of it.
        close(seen.tof_incident_s(), exact.tof_incident_s(), 1e-9);
    }
}
