//! The paper's chain against numbers of two independent integrations.

use crate::common::*;
use hertzchain_chain::observe::Separation;
use hertzchain_chain::wave::{Limits, Method, run};
use hertzchain_chain::*;

fn dry() -> Vec<std::sync::Arc<dyn laws::Law>> {
    vec![hertz(), viscoelastic(), cubic()]
}

#[test]
fn stiffness_and_relaxation_time_of_the_paper_follow_from_its_materials() {
    let pair = BeadPair { left: STEEL, right: STEEL, radius_m: 0.5 * 6.35e-3, mass_kg: 4.27e-3 };
    // Printed to eleven digits.
    close(pair.hertz_stiffness(), 8.792_630_379_6e9, 1e-11);
    close(pair.mean_relaxation_time_s(Material::relaxation_time_s), 3.385_289_514_9e-7, 1e-10);
}

#[test]
fn times_of_flight_match_two_independent_integrations() {
    let cases = [
        (1.0, vec![hertz()], 630.841591e-6, 632.265715e-6),
        (0.5, vec![hertz(), viscoelastic()], 751.270959e-6, 783.036376e-6),
        (0.075, dry(), 1_086.942_704e-6, 1_120.470_790e-6),
        (1.23, dry(), 660.261248e-6, 699.493431e-6),
    ];
    for (speed, laws, incident, reflected) in cases {
        let (passage, _) = shoot(&row(40, speed, laws), 1e-10);
        // Nine digits are given; the integrations agree to 1e-9.
        close(passage.tof_incident_s(), incident, 2e-9);
        close(passage.tof_reflected_s().unwrap(), reflected, 2e-9);
    }
}

#[test]
fn peaks_and_rebound_match_an_independent_integration() {
    let chain = row(40, 1.0, vec![hertz()]);
    let system = System::new(&chain).unwrap();
    let mut passages = observe::Passages::new(7, 40, false);
    let mut separation = Separation::default();
    let limits = Limits::until(reference("rig/hertz_1", "run_ends_s"));
    let method = Method::dormand_prince(1e-10);
    let outcome = run(&system, &method, limits, &mut [&mut passages, &mut separation]).unwrap();
    let passage = passages.passage().unwrap();
    // The reference's own error is 1e-8 at worst.
    close(passage.incident.value, reference("rig/hertz_1", "sensor_peak_n"), 1e-8);
    close(passage.wall.value, reference("rig/hertz_1", "wall_peak_n"), 1e-8);
    close(passage.reflected.unwrap().value, reference("rig/hertz_1", "returning_peak_n"), 3e-8);
    let (time, velocity) = separation.first().unwrap();
    close(time, reference("rig/hertz_1", "striker_first_separation_s"), 1e-8);
    close(velocity, reference("rig/hertz_1", "striker_at_first_separation_m_s"), 1e-7);
    close(outcome.velocity_m_s[0], reference("rig/hertz_1", "striker_at_end_of_run_m_s"), 1e-8);
    // Within an equal step, not at its end, which is up to 0.1 µs of 50 µs later.
    let mut separation = Separation::default();
    run(&system, &Method::rk4(1e-7), limits, &mut [&mut separation]).unwrap();
    let (time, _) = separation.first().unwrap();
    close(time, reference("rig/hertz_1", "striker_first_separation_s"), 1e-6);
}

#[test]
fn hertz_tof_scales_as_speed_to_minus_one_fifth() {
    let tof = |speed| shoot(&row(40, speed, vec![hertz()]), 1e-11).0.tof_incident_s();
    let exponent = (tof(1.2) / tof(0.1)).ln() / 12.0_f64.ln();
    // Errors of both shots are about 1e-10.
    assert!((exponent + 0.2).abs() < 1e-9, "{exponent}");
}

#[test]
fn equal_striker_sends_the_known_pulse() {
    let chain = unit_row(120, 1.0, FarEnd::Free);
    let system = System::new(&chain).unwrap();
    let mut velocity = observe::Signal::new(Sensor::Velocity(80));
    let mut later = observe::Signal::new(Sensor::Velocity(100));
    let mut force = observe::Signal::new(Sensor::Contact(80));
    let method = Method::dormand_prince(1e-11);
    run(&system, &method, Limits::until(125.0), &mut [&mut velocity, &mut later, &mut force])
        .unwrap();
    let first = |signal: &observe::Signal| signal.maxima()[0];
    let speed = 20.0 / (first(&later).time_s - first(&velocity).time_s);
    // Eight digits are given.
    close(first(&velocity).value, 0.681_631_55, 1e-8);
    close(speed, 0.840_508_77, 1e-8);
    close(first(&force).value, 0.639_554_23, 1e-8);
}

#[test]
fn energy_residual_is_below_what_was_asked() {
    for (speed, laws) in [(1.0, vec![hertz()]), (0.5, dry()), (0.075, dry())] {
        let (_, outcome) = shoot(&row(40, speed, laws), 1e-9 / 200.0);
        let residual = outcome.budget.unwrap().relative_residual();
        assert!(residual.abs() < 1e-9, "{residual:e}");
    }
}

#[test]
fn a_reading_changes_times_of_flight_as_the_independent_integration_says() {
    let push = Push::Constant { force_n: 0.24 };
    let stop = FarEnd::Stop { radius_m: BALL.radius_m, material: STEEL, mass_kg: 4.5 };
    let incline = 0.5_f64.to_radians();
    let base = row(40, 0.5, dry());
    let cases = [
        (
            "rig/dry_push_incline_stop_0.5",
            Chain { push, far: stop, incline_rad: incline, ..base.clone() },
        ),
        ("rig/dry_clipped_0.5", Chain { tension: Tension::Clipped, ..base }),
    ];
    for (case, chain) in cases {
        let (passage, outcome) = shoot(&chain, 1e-10);
        close(passage.tof_incident_s(), reference(case, "tof_incident_s"), 3e-9);
        close(passage.tof_reflected_s().unwrap(), reference(case, "tof_reflected_s"), 1e-8);
        // 200 times the tolerance, as for any shot.
        assert!(outcome.budget.unwrap().relative_residual().abs() < 2e-8);
    }
}

/// Under load the far contacts carry rounding of their static force long
/// before the wave; that is no wall pulse.
#[test]
fn rounding_of_static_forces_is_not_taken_for_a_pulse() {
    let chain = Chain { incline_rad: 1.57, ..row(60, 0.3, vec![hertz()]) };
    for tolerance in [1e-7, 1e-9, 1e-11] {
        let (passage, _) = shoot(&chain, tolerance);
        assert_eq!(passage.wall_maxima.len(), 1, "{tolerance:e}");
        assert!(passage.tof_incident_s() > 5e-4);
    }
}
