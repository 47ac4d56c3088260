//! A small instance of the comparison: no Python, no clock.

use crate::case::Case;
use crate::converged::{Converged, errors};
use crate::ours::{ours, tune};
use crate::tool::Timed;
use crate::{differential, diffsol_peer, ode_solvers_peer};

const SPEEDS_M_S: [f64; 3] = [0.4, 0.5, 0.6];

/// A tolerance with which every peer is right to 1e-5 (`results/table.csv`).
const TOLERANCE: f64 = 1e-8;

fn assert_right(name: &str, tofs_s: &[(f64, f64)], converged: &[(f64, f64)]) {
    assert_eq!(tofs_s.len(), SPEEDS_M_S.len());
    let (incident, reflected) = errors(tofs_s, converged);
    // The accuracy of the measure.
    assert!(
        incident.max(reflected) < 1e-5,
        "{name}: {incident:e}, {reflected:e}"
    );
}

#[test]
fn every_rust_peer_and_ours_see_the_same_flights_on_the_measure() {
    let case = Case::Dry;
    let known = Converged::new(case);
    let converged = known.tofs_s(&SPEEDS_M_S);
    let assert_peer = |name: &str, peer: Timed| assert_right(name, &peer.tofs_s, &converged);
    for method in differential::METHODS {
        let peer = differential::run(method, case, TOLERANCE, &SPEEDS_M_S);
        assert_peer(method, peer);
    }
    for method in ode_solvers_peer::METHODS {
        let peer = ode_solvers_peer::run(method, case, TOLERANCE, &SPEEDS_M_S);
        assert_peer(method, peer);
    }
    assert_peer("diffsol", diffsol_peer::run(case, TOLERANCE, &SPEEDS_M_S));
    let setting = tune(case, 1e-5, &SPEEDS_M_S, &known);
    assert_right("hertzchain", &ours(case, &SPEEDS_M_S, setting), &converged);
}
