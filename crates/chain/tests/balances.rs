//! Conservation laws, symmetries and exact solutions.

use crate::common::*;
use hertzchain_chain::laws::{DampingCubic, DampingViscoelastic, ElasticHertz, ElasticPower, law};
use hertzchain_chain::observe::{Passages, Signal};
use hertzchain_chain::theory::linear::{Ends, UniformChain, normal_modes};
use hertzchain_chain::wave::{Limits, Method, run};
use hertzchain_chain::*;

fn moving(bead: usize, velocity_m_s: f64) -> Initial {
    Initial { bead, displacement_m: 0.0, velocity_m_s }
}

#[test]
fn momentum_is_kept_where_nothing_holds_the_chain() {
    let laws = vec![hertz(), viscoelastic(), cubic()];
    let chain = Chain { far: FarEnd::Free, ..row(20, 0.7, laws) };
    let outcome = run_for(&chain, 1e-8, 1e-3);
    let momentum: f64 = outcome.velocity_m_s[..21].iter().sum();
    // Only the rounding of some 1e4 sums is left.
    close(momentum, 0.7, 1e-12);
}

#[test]
fn two_equal_pulses_that_meet_leave_the_middle_at_rest() {
    let chain = Chain {
        start: Start::Free,
        initial: vec![moving(1, 1.0), moving(41, -1.0)],
        ..unit_row(41, 1.0, FarEnd::Free)
    };
    let system = System::new(&chain).unwrap();
    let mut middle = Signal::new(Sensor::Contact(20));
    let method = Method::dormand_prince(1e-11);
    let outcome = run(&system, &method, Limits::until(60.0), &mut [&mut middle]).unwrap();
    let velocity = &outcome.velocity_m_s;
    for bead in 1..=20 {
        // The two sides are summed in opposite order: rounding, amplified by
        // the openings that it delays.
        assert!((velocity[bead] + velocity[42 - bead]).abs() < 1e-9, "bead {bead}");
    }
    assert!(velocity[21].abs() < 1e-9);
    close(velocity[41], reference("head-on", "last_bead_velocity"), 1e-8);
    let peak = middle.maxima().iter().map(|m| m.value).fold(0.0, f64::max);
    close(peak, reference("head-on", "middle_contact_peak_force"), 1e-8);
}

/// The same shot with mass, length and time multiplied.
#[test]
fn a_shot_scaled_in_mass_length_and_time_gives_the_scaled_result() {
    let (mass, length, time) = (3.0, 0.25, 7.0);
    let (k, a, b) = (8.8e9, 3.4e-7, 77.0);
    let shot = |mass: f64, length: f64, time: f64| {
        let laws = vec![
            law(ElasticHertz { stiffness: Some(k * mass / (length.sqrt() * time * time)) }),
            law(DampingViscoelastic {
                relaxation_time_s: Some(a * time),
                stiffness: Some(k * mass / (length.sqrt() * time * time)),
            }),
            law(DampingCubic { coefficient_kg_s_m2: b * mass * time / (length * length) }),
        ];
        let bead = Bead { mass_kg: BALL.mass_kg * mass, ..BALL };
        let chain = Chain {
            beads: vec![bead; 20],
            start: Start::Striker { bead, speed_m_s: 0.5 * length / time },
            push: Push::Constant { force_n: 0.3 * mass * length / (time * time) },
            incline_rad: 0.01,
            gravity_m_s2: 9.81 * length / (time * time),
            ..row(20, 1.0, laws)
        };
        shoot(&chain, 1e-9).0
    };
    let (plain, scaled) = (shot(1.0, 1.0, 1.0), shot(mass, length, time));
    let force = mass * length / (time * time);
    // Rounding shifts steps a little: errors of two runs at 1e-9.
    close(scaled.tof_incident_s(), plain.tof_incident_s() * time, 1e-8);
    close(scaled.tof_reflected_s().unwrap(), plain.tof_reflected_s().unwrap() * time, 1e-8);
    close(scaled.wall.value, plain.wall.value * force, 1e-8);
}

fn linear_ring(beads: usize, stiffness: f64, force_n: f64) -> Chain {
    let laws = vec![law(ElasticPower { stiffness, exponent: 1.0 })];
    Chain {
        start: Start::Free,
        far: FarEnd::Periodic { force_n },
        sections: vec![Section { contacts: 0..=beads, laws, material: None }],
        ..unit_row(beads, 1.0, FarEnd::Free)
    }
}

#[test]
fn a_linear_ring_swings_in_its_exact_normal_modes() {
    let (beads, mode, amplitude, duration) = (12, 3, 1e-3, 20.0);
    let angle = |bead: usize| std::f64::consts::TAU * (mode * bead) as f64 / beads as f64;
    let initial = (1..=beads).map(|bead| Initial {
        bead,
        displacement_m: amplitude * angle(bead).cos(),
        velocity_m_s: 0.0,
    });
    let chain = Chain { initial: initial.collect(), ..linear_ring(beads, 4.0, 1.0) };
    let outcome = run_for(&chain, 1e-11, duration);
    let uniform = UniformChain { contact_stiffness_n_m: 4.0, mass_kg: 1.0 };
    let omega = uniform.angular_frequency_rad_s(std::f64::consts::TAU * mode as f64 / beads as f64);
    for bead in 1..=beads {
        let exact = amplitude * angle(bead).cos() * (omega * duration).cos();
        let error = (outcome.displacement_m[bead] - exact).abs() / amplitude;
        assert!(error < 1e-9, "bead {bead}: {error:e}");
    }
}

#[test]
fn a_linear_dimer_row_swings_in_the_modes_of_the_eigenproblem() {
    let masses: Vec<f64> = (0..10).map(|i| if i % 2 == 0 { 1.0 } else { 2.5 }).collect();
    let modes = normal_modes(&masses, &[1.0; 10], Ends::FreeFixed).unwrap();
    let laws = vec![law(ElasticPower { stiffness: 1.0, exponent: 1.0 })];
    for mode in [&modes[2], &modes[9]] {
        let shape = &mode.shape;
        let initial = (1..=10).map(|bead| Initial {
            bead,
            displacement_m: 1e-3 * shape[bead - 1],
            velocity_m_s: 0.0,
        });
        let bead = |mass_kg: f64| Bead { radius_m: 1.0, mass_kg, material: Material::RIGID };
        let chain = Chain {
            beads: masses.iter().map(|mass| bead(*mass)).collect(),
            start: Start::Free,
            initial: initial.collect(),
            push: Push::Constant { force_n: 1.0 },
            sections: vec![Section { contacts: 0..=10, laws: laws.clone(), material: None }],
            ..unit_row(10, 1.0, FarEnd::HalfBead { radius_m: 1.0, material: Material::RIGID })
        };
        let outcome = run_for(&chain, 1e-11, 15.0);
        let phase = (mode.angular_frequency_rad_s * 15.0).cos();
        for bead in 1..=10 {
            let error = outcome.displacement_m[bead] - 1e-3 * shape[bead - 1] * phase;
            // A few hundred steps at 1e-11 of 1e-3.
            assert!(error.abs() < 1e-11, "bead {bead}: {error:e}");
        }
    }
}

#[test]
fn a_driven_chain_matches_an_independent_integration() {
    for (case, exponent) in [("driven/linear", 1.0), ("driven/hertz", 1.5)] {
        let (amplitude, omega) = (0.1, 1.0);
        let laws = vec![law(ElasticPower { stiffness: 1.0, exponent })];
        let bead = Bead { radius_m: 1.0, mass_kg: 1.0, material: Material::RIGID };
        let motion =
            Motion::Sine { amplitude_m: amplitude, frequency_hz: omega / std::f64::consts::TAU };
        let chain = Chain {
            start: Start::Driven { bead, motion },
            push: Push::Constant { force_n: 1.0 },
            sections: vec![Section { contacts: 0..=10, laws, material: None }],
            ..unit_row(10, 1.0, FarEnd::HalfBead { radius_m: 1.0, material: Material::RIGID })
        };
        let outcome = run_for(&chain, 1e-11, 20.0);
        close(outcome.displacement_m[1], reference(case, "bead_1_position_at_20"), 1e-7);
        close(outcome.displacement_m[5], reference(case, "bead_5_position_at_20"), 1e-8);
        close(outcome.velocity_m_s[10], reference(case, "bead_10_velocity_at_20"), 1e-8);
        let budget = outcome.budget.unwrap();
        assert!(budget.driven_j != 0.0 && budget.relative_residual().abs() < 1e-8);
    }
}

#[test]
fn a_ring_matches_an_independent_integration() {
    let chain = Chain {
        start: Start::Free,
        far: FarEnd::Periodic { force_n: 0.0 },
        initial: vec![moving(1, 1.0)],
        ..unit_row(10, 1.0, FarEnd::Free)
    };
    let outcome = run_for(&chain, 1e-11, 20.0);
    for bead in [5, 6, 7, 9] {
        let expected = reference("ring", &format!("bead_{bead}_velocity_at_20"));
        // The reference's own error is 1e-7 at worst.
        close(outcome.velocity_m_s[bead], expected, 1e-6);
    }
}

#[test]
fn a_spring_that_hardly_gives_acts_as_a_constant_push_and_a_stiff_one_does_not() {
    let tof = |push| shoot(&Chain { push, ..row(40, 0.5, vec![hertz()]) }, 1e-9).0.tof_incident_s();
    let constant = tof(Push::Constant { force_n: 0.24 });
    let soft = tof(Push::Spring { force_n: 0.24, stiffness_n_m: 1e-3 });
    let stiff = tof(Push::Spring { force_n: 0.24, stiffness_n_m: 1e6 });
    close(soft, constant, 1e-8);
    assert!((stiff / constant - 1.0).abs() > 1e-6);
}

#[test]
fn energy_balances_with_every_end_push_and_incline() {
    let stop = FarEnd::Stop { radius_m: BALL.radius_m, material: STEEL, mass_kg: 0.05 };
    let laws = || vec![hertz(), viscoelastic(), cubic()];
    let spring = Push::Spring { force_n: 0.5, stiffness_n_m: 5e4 };
    let base = row(15, 0.8, laws());
    let chains = [
        Chain { far: stop, push: spring, incline_rad: 0.3, ..base.clone() },
        Chain { far: FarEnd::Plane { material: STEEL }, incline_rad: 1.57, ..base.clone() },
        Chain { tension: Tension::Clipped, push: spring, far: stop, ..base.clone() },
        Chain { far: FarEnd::Free, gaps: vec![Gap { contact: 4, gap_m: 3e-5 }], ..base.clone() },
    ];
    for chain in chains {
        let outcome = run_for(&chain, 5e-12, 2e-3);
        let budget = outcome.budget.unwrap();
        assert!(budget.relative_residual().abs() < 1e-9, "{budget:?}");
    }
}

#[test]
fn a_hanging_bead_swings_with_the_period_of_a_pendulum() {
    let chain = Chain {
        start: Start::Free,
        far: FarEnd::Free,
        suspension_m: Some(0.1),
        initial: vec![Initial { bead: 1, displacement_m: -0.02, velocity_m_s: 0.0 }],
        ..row(1, 1.0, vec![hertz()])
    };
    let omega = (9.80665_f64 / 0.1).sqrt();
    let outcome = run_for(&chain, 1e-11, 0.3);
    close(outcome.displacement_m[1], -0.02 * (omega * 0.3).cos(), 1e-8);
    assert!(outcome.budget.unwrap().relative_residual().abs() < 1e-8);
}

#[test]
fn a_gap_delays_the_wall_by_the_time_its_bead_needs_to_cross() {
    let wall = |gap_m| {
        let gaps = vec![Gap { contact: 40, gap_m }];
        let chain = Chain { gaps, ..row(40, 0.5, vec![hertz()]) };
        let system = System::new(&chain).unwrap();
        let mut passages = Passages::new(7, 40, true);
        let method = Method::dormand_prince(1e-9);
        run(&system, &method, Limits::until(1.0), &mut [&mut passages]).unwrap();
        passages.passage().unwrap().wall.time_s
    };
    let (near, far) = (wall(1e-4), wall(2e-4));
    // Bead 40 then flies free at its speed after the last contact.
    let speed = 1e-4 / (far - near);
    assert!(speed > 0.3 && speed < 0.7, "{speed}");
    assert!(wall(0.0) < near);
}
