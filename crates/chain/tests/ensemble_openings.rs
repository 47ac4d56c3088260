//! Openings that the ensemble loop follows between steps.

use crate::common::ensemble::*;
use crate::common::*;
use hertzchain_chain::ensemble::{End, Settings};
use hertzchain_chain::laws::Law;
use hertzchain_chain::observe::Passages;
use hertzchain_chain::wave::{Limits, Method, run};
use hertzchain_chain::*;
use std::sync::Arc;

fn dry() -> Vec<Arc<dyn Law>> {
    vec![hertz(), viscoelastic(), cubic()]
}

/// Larger relative error of both times of flight between bead 2 and the wall.
fn error(chain: &Chain, (step, openings): (f64, bool)) -> f64 {
    let (system, wall) = (System::new(chain).unwrap(), chain.beads.len());
    let mut passages = Passages::new(2, wall, true);
    let method = Method::dormand_prince(1e-11);
    let outcome = run(&system, &method, Limits::until(1.0), &mut [&mut passages]).unwrap();
    let exact = tofs(&passages.passage().unwrap());
    let settings = Settings {
        sensors: vec![Sensor::Bead(2), Sensor::Contact(wall)],
        end: End::Reflected,
        openings,
        ..settings(1)
    };
    let flown = fire_one(&system, (step, 1.1 * outcome.time_s), &settings);
    let tofs = tofs(&passage(&flown).unwrap());
    (tofs[0] / exact[0] - 1.0).abs().max((tofs[1] / exact[1] - 1.0).abs())
}

/// In short rows the striker lets go while the sensor is at its peak: samples
/// of force must not feel the steps that the opening disturbs.
#[test]
fn an_opening_near_a_peak_does_not_shift_it() {
    for beads in 10..=16 {
        let chain = row(beads, 0.3, vec![hertz()]);
        let (with, without) = (error(&chain, (0.05, true)), error(&chain, (0.05, false)));
        // Measured 3e-7 at most, and 2e-6 without; samples that feel disturbed
        // steps give 1e-5.
        assert!(with < 5e-7, "{beads} beads: {with:e}");
        assert!(with < without, "{beads} beads: {with:e} {without:e}");
    }
}

/// A clipped force ends at a smaller pull than its law's, without an edge.
#[test]
fn following_openings_does_no_harm_where_tension_is_clipped() {
    for beads in [8, 13, 20, 40] {
        for laws in [dry(), vec![hertz(), viscoelastic()], vec![hertz()]] {
            let chain = Chain { tension: Tension::Clipped, ..row(beads, 0.5, laws) };
            let (with, without) = (error(&chain, (0.05, true)), error(&chain, (0.05, false)));
            // The same where forces that pull are cut; smaller in a Hertz chain.
            assert!(with <= without, "{beads} beads: {with:e} {without:e}");
        }
    }
}

/// Velocities of a ring after some time, and those of the one-step loop.
#[test]
fn openings_of_a_rings_last_contact_move_bead_1() {
    let moving = Initial { bead: 8, displacement_m: 0.0, velocity_m_s: 0.2 };
    let ring = Chain {
        start: Start::Free,
        far: FarEnd::Periodic { force_n: 0.0 },
        initial: vec![moving],
        ..row(10, 1.0, vec![hertz(), viscoelastic()])
    };
    let system = System::new(&ring).unwrap();
    let [with, without] = [true, false].map(|openings| {
        let settings = Settings { sensors: vec![], end: End::Duration, openings, ..settings(1) };
        let flown = fire_one(&system, (0.05, 2e-4), &settings);
        let outcome = run_for(&ring, 1e-11, flown.time_s);
        let pairs = flown.velocity_m_s.iter().zip(&outcome.velocity_m_s);
        pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / 0.2
    });
    // Measured 2.8e-7 and 2.9e-6.
    assert!(with < 5e-7 && with < 0.3 * without, "{with:e} {without:e}");
}
