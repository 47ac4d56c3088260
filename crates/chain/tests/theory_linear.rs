//! Linear theory: normal modes against closed forms, dispersion against modes.

use hertzchain_chain::theory::linear::{
    Dimer, Ends, UniformChain, contact_stiffness_n_m, normal_modes,
};
use std::f64::consts::PI;

const ALL_ENDS: [Ends; 5] =
    [Ends::FreeFree, Ends::FreeFixed, Ends::FixedFree, Ends::FixedFixed, Ends::Periodic];

fn contacts(beads: usize, ends: Ends) -> usize {
    match ends {
        Ends::FreeFree => beads - 1,
        Ends::FixedFixed => beads + 1,
        _ => beads,
    }
}

#[test]
fn uniform_chain_has_the_closed_form_frequencies_with_every_kind_of_ends() {
    let (mass_kg, contact_stiffness_n_m) = (8.54e-3, 4.1e6);
    let chain = UniformChain { mass_kg, contact_stiffness_n_m };
    let cutoff = 2.0 * chain.sound_speed_beads_s();
    for ends in ALL_ENDS {
        for beads in [2, 3, 40, 41] {
            let stiffnesses = vec![contact_stiffness_n_m; contacts(beads, ends)];
            let modes = normal_modes(&vec![mass_kg; beads], &stiffnesses, ends).unwrap();
            for (index, mode) in modes.iter().enumerate() {
                let exact = chain.mode_angular_frequency_rad_s(beads, ends, index);
                let error = (mode.angular_frequency_rad_s - exact).abs() / cutoff;
                // Rounding of some ten sweeps of rotations.
                assert!(error < 2e-14, "{ends:?} {beads} {index}: {error:e}");
            }
        }
    }
}

#[test]
fn slowest_mode_of_a_long_chain_keeps_its_relative_digits() {
    let modes = normal_modes(&[1.0; 150], &[1.0; 150], Ends::FreeFixed).unwrap();
    let exact = 2.0 * (PI / (2.0 * 301.0)).sin();
    // Singular values without squaring: rounding, not rounding over frequency squared.
    assert!((modes[0].angular_frequency_rad_s / exact - 1.0).abs() < 1e-13);
}

#[test]
fn modes_of_an_irregular_chain_solve_the_equation_of_motion() {
    let masses: Vec<f64> = (0..25).map(|i| 1.0 + 0.7 * f64::from(i).sin()).collect();
    let stiffnesses: Vec<f64> = (0..25).map(|i| 2.0 + f64::from(3 * i).cos()).collect();
    for mode in normal_modes(&masses, &stiffnesses, Ends::FreeFixed).unwrap() {
        let u = &mode.shape;
        let pull = |contact: usize| {
            let next = u.get(contact + 1).copied().unwrap_or(0.0);
            stiffnesses[contact] * (u[contact] - next)
        };
        for bead in 0..25 {
            let before = if bead > 0 { pull(bead - 1) } else { 0.0 };
            let inertia = mode.angular_frequency_rad_s.powi(2) * masses[bead] * u[bead];
            // Rounding of the rotations times forces of order ten.
            assert!((pull(bead) - before - inertia).abs() < 1e-12);
        }
    }
}

#[test]
fn shapes_are_orthonormal_in_the_masses() {
    let masses: Vec<f64> = (0..20).map(|i| 1.0 + f64::from(i % 3)).collect();
    for ends in ALL_ENDS {
        let modes = normal_modes(&masses, &vec![1.5; contacts(20, ends)], ends).unwrap();
        for (i, a) in modes.iter().enumerate() {
            for (j, b) in modes.iter().enumerate() {
                let terms = a.shape.iter().zip(&b.shape).zip(&masses);
                let product: f64 = terms.map(|((x, y), m)| m * x * y).sum();
                let expected = f64::from(u8::from(i == j));
                // Rounding of the rotations.
                assert!((product - expected).abs() < 1e-13);
            }
        }
    }
}

#[test]
fn free_chain_can_shift_at_no_frequency() {
    let modes = normal_modes(&[1.0, 5.0, 2.0], &[3.0, 4.0], Ends::FreeFree).unwrap();
    let shift = &modes[0];
    // A rounded zero, and a shape normalised by the total mass 8.
    assert!(shift.angular_frequency_rad_s < 1e-15);
    for displacement in &shift.shape {
        assert!((displacement - 1.0 / 8f64.sqrt()).abs() < 1e-15);
    }
}

#[test]
fn ring_of_dimers_has_its_modes_on_the_two_branches() {
    let dimer = Dimer { masses_kg: [1.0, 0.3], contact_stiffnesses_n_m: [2.0, 1.2] };
    let cells = 12;
    let mut expected: Vec<f64> = (0..cells)
        .flat_map(|j| {
            let (acoustic, optical) =
                dimer.branches_rad_s(2.0 * PI * f64::from(j) / f64::from(cells));
            [acoustic, optical]
        })
        .collect();
    expected.sort_by(f64::total_cmp);
    let masses = dimer.masses_kg.repeat(12);
    let stiffnesses = dimer.contact_stiffnesses_n_m.repeat(12);
    let modes = normal_modes(&masses, &stiffnesses, Ends::Periodic).unwrap();
    for (mode, exact) in modes.iter().zip(expected) {
        // Rounding; the mode at rest is a rounded zero of sin(π) too.
        assert!((mode.angular_frequency_rad_s - exact).abs() < 1e-14);
    }
}

#[test]
fn band_gap_of_a_mass_dimer_lies_between_the_two_single_bead_frequencies() {
    let dimer = Dimer { masses_kg: [4.0, 1.0], contact_stiffnesses_n_m: [3.0, 3.0] };
    let edges = dimer.band_edges();
    let single = |mass: f64| (2.0 * 3.0 / mass).sqrt() / (2.0 * PI);
    // Closed forms on both sides: rounding.
    assert!((edges.acoustic_top_hz - single(4.0)).abs() < 1e-15);
    assert!((edges.optical_bottom_hz - single(1.0)).abs() < 1e-15);
    let top = 7.5f64.sqrt() / (2.0 * PI);
    assert!((edges.optical_top_hz - top).abs() < 1e-15);
}

#[test]
fn gap_closes_for_equal_beads_and_the_branches_are_the_folded_uniform_chain() {
    let dimer = Dimer { masses_kg: [2.0, 2.0], contact_stiffnesses_n_m: [5.0, 5.0] };
    let chain = UniformChain { mass_kg: 2.0, contact_stiffness_n_m: 5.0 };
    let edges = dimer.band_edges();
    // The two roots meet: rounding enters through a square root, 1e-8.
    assert!((edges.optical_bottom_hz - edges.acoustic_top_hz).abs() < 1e-8);
    assert!((edges.optical_top_hz - chain.cutoff_frequency_hz()).abs() < 1e-15);
    let (acoustic, optical) = dimer.branches_rad_s(1.0);
    assert!((acoustic - chain.angular_frequency_rad_s(0.5)).abs() < 1e-14);
    assert!((optical - chain.angular_frequency_rad_s(PI - 0.5)).abs() < 1e-14);
}

#[test]
fn sound_speeds_are_the_slopes_of_the_dispersion_at_long_waves() {
    let chain = UniformChain { mass_kg: 2.0, contact_stiffness_n_m: 7.0 };
    let dimer = Dimer { masses_kg: [2.0, 1.0], contact_stiffnesses_n_m: [7.0, 3.0] };
    let q = 1e-4;
    // Dispersion bends by q²/24 of the speed.
    let slope = chain.angular_frequency_rad_s(q) / q;
    assert!((slope / chain.sound_speed_beads_s() - 1.0).abs() < 1e-9);
    let slope = dimer.branches_rad_s(q).0 / q;
    assert!((slope / dimer.sound_speed_cells_s() - 1.0).abs() < 1e-8);
    assert_eq!(chain.group_speed_beads_s(0.0), chain.sound_speed_beads_s());
}

#[test]
fn contact_stiffness_is_the_slope_of_the_force() {
    let (stiffness, force, exponent) = (8.79e9_f64, 0.24_f64, 1.5);
    let overlap = (force / stiffness).powf(1.0 / exponent);
    let slope = exponent * stiffness * overlap.powf(exponent - 1.0);
    // Powers of a number of order 1e-7.
    let computed = contact_stiffness_n_m(exponent, stiffness, force);
    assert!((computed / slope - 1.0).abs() < 1e-13);
}

#[test]
fn waves_above_the_cutoff_decay_by_the_recurrence_of_the_lattice() {
    let chain = UniformChain { mass_kg: 1.0, contact_stiffness_n_m: 1.0 };
    let frequency = 1.3 * chain.cutoff_frequency_hz();
    let factor = -(-chain.decay_per_bead(frequency)).exp();
    let squared = (2.0 * PI * frequency).powi(2);
    // -ω² u = u(+1) - 2u + u(-1) with u(j) = factor^j: rounding of numbers below ten.
    assert!((squared + factor - 2.0 + 1.0 / factor).abs() < 1e-13);
    assert_eq!(chain.decay_per_bead(0.9 * chain.cutoff_frequency_hz()), 0.0);
}

#[test]
fn wrong_lists_are_refused() {
    let few = normal_modes(&[1.0, 1.0], &[1.0, 1.0], Ends::FreeFree);
    let text = few.unwrap_err().to_string();
    assert!(text.starts_with("2 contact stiffnesses given"), "{text}");
    assert!(normal_modes(&[], &[], Ends::FreeFree).is_err());
    assert!(normal_modes(&[1.0, f64::NAN], &[1.0], Ends::FreeFree).is_err());
    assert!(normal_modes(&[1.0, 1.0], &[0.0], Ends::FreeFree).is_err());
}
