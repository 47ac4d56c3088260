//! Oil between bodies that start apart: against closed forms and `bench/film`, another program.

use crate::common::{self, BALL, STEEL, close, hertz, row};
use hertzchain_chain::laws::{Law, find};
use hertzchain_chain::observe::{Trace, Tracer};
use hertzchain_chain::wave::{Limits, Method, Outcome, run};
use hertzchain_chain::*;
use std::f64::consts::PI;
use std::sync::Arc;

const RADIUS_M: f64 = 0.5 * BALL.radius_m;

fn oil(viscosity_pa_s: f64, volume_m3: Option<f64>) -> Arc<dyn Law> {
    let given = volume_m3.map(|volume| ("volume", volume));
    let given: Vec<_> = [("viscosity", viscosity_pa_s)].into_iter().chain(given).collect();
    find("film_drained").unwrap().build(&given).unwrap()
}

fn stiffness() -> f64 {
    BeadPair { left: STEEL, right: STEEL, radius_m: RADIUS_M, mass_kg: 1.0 }.hertz_stiffness()
}

/// A ball that flies at a ball at rest, both free, at a speed in m/s from a gap in m.
fn two(speed_m_s: f64, gap_m: f64, oil: Arc<dyn Law>) -> Chain {
    Chain {
        start: Start::Free,
        far: FarEnd::Free,
        initial: vec![Initial { bead: 1, displacement_m: 0.0, velocity_m_s: speed_m_s }],
        gaps: vec![Gap { contact: 1, gap_m }],
        ..row(2, 1.0, vec![hertz(), oil])
    }
}

fn shot(chain: &Chain, tolerance: f64, duration_s: f64) -> (Trace, Outcome) {
    let system = System::new(chain).unwrap();
    let mut tracer = Tracer::new(vec![Sensor::Contact(1)], 1e-3 * duration_s);
    let limits = Limits { budget: true, ..Limits::until(duration_s) };
    let method = Method::dormand_prince(tolerance);
    let outcome = run(&system, &method, limits, &mut [&mut tracer]).unwrap();
    (tracer.into_trace(), outcome)
}

fn restitution(outcome: &Outcome, speed_m_s: f64) -> f64 {
    (outcome.velocity_m_s[2] - outcome.velocity_m_s[1]) / speed_m_s
}

#[test]
fn rigid_balls_lose_speed_by_the_logarithm_of_the_gap() {
    // At 10 mm/s from 0.2 mm to a gap that is still a thousand times the flattening.
    let (speed_m_s, gap_m, viscosity_pa_s) = (0.01, 2e-4, 1e-3);
    let duration_s = 1.8e-2;
    let (_, outcome) = shot(&two(speed_m_s, gap_m, oil(viscosity_pa_s, None)), 1e-11, duration_s);
    let left_m = gap_m - (outcome.displacement_m[1] - outcome.displacement_m[2]);
    let lost = 6.0 * PI * viscosity_pa_s * RADIUS_M * RADIUS_M * (gap_m / left_m).ln();
    let expected = speed_m_s - lost / (0.5 * BALL.mass_kg);
    // Many steps at 1e-11.
    close(outcome.velocity_m_s[1] - outcome.velocity_m_s[2], expected, 1e-9);
    assert!(left_m > 1e-5 && left_m < 3e-5, "{left_m}");
}

#[test]
fn little_oil_resists_less_at_wide_gaps() {
    let after = |volume_m3| {
        let chain = two(0.01, 2e-4, oil(1e-2, volume_m3));
        let (_, outcome) = shot(&chain, 1e-11, 5e-3);
        let left_m = 2e-4 - (outcome.displacement_m[1] - outcome.displacement_m[2]);
        (0.01 - (outcome.velocity_m_s[1] - outcome.velocity_m_s[2]), left_m)
    };
    let volume_m3 = 1e-10;
    let (lost, left_m) = after(Some(volume_m3));
    let resistance = |gap_m: f64| {
        let q = volume_m3 / (PI * RADIUS_M * gap_m * gap_m);
        (1.0 - (1.0 + q).powf(-0.5)).powi(2) / gap_m
    };
    let part_m = (2e-4 - left_m) / 1000.0;
    let middles = (0..1000).map(|i| left_m + (f64::from(i) + 0.5) * part_m);
    let sum: f64 = middles.map(resistance).sum::<f64>() * part_m;
    let per_gap = 6.0 * PI * 1e-2 * RADIUS_M * RADIUS_M / (0.5 * BALL.mass_kg);
    // The midpoint rule; steps at 1e-11.
    close(lost, per_gap * sum, 1e-6);
    let (flooded, _) = after(None);
    close(after(Some(1.0)).0, flooded, 1e-3);
    assert!(lost < 0.1 * flooded, "{lost} {flooded}");
    assert_eq!(after(Some(0.0)).0, 0.0);
}

/// Speed that the oil would stop at one Hertz length, over the ball's: `bench/film`'s Stokes number.
fn viscosity_pa_s(stokes: f64, speed_m_s: f64) -> f64 {
    0.5 * BALL.mass_kg * speed_m_s / (6.0 * PI * RADIUS_M * RADIUS_M * stokes)
}

#[test]
fn bounces_match_an_elastohydrodynamic_contact() {
    // bench/film: check.bounce(St, cavitates=True), from a gap of one Hertz length δ0.
    let known = [(10.0, 0.6067), (30.0, 0.8004), (100.0, 0.9122), (300.0, 0.9602)];
    let (speed_m_s, modulus_pa) = (0.2_f64, 0.75 * stiffness() / RADIUS_M.sqrt());
    let mass_kg = 0.5 * BALL.mass_kg;
    let gap_m = (mass_kg * speed_m_s * speed_m_s / (modulus_pa * RADIUS_M.sqrt())).powf(0.4);
    for (stokes, expected) in known {
        let chain = two(speed_m_s, gap_m, oil(viscosity_pa_s(stokes, speed_m_s), None));
        let (_, outcome) = shot(&chain, 1e-10, 6.0 * gap_m / speed_m_s);
        let found = restitution(&outcome, speed_m_s);
        // What the one fitted number leaves; the contact's own steps and rings: 0.3 %.
        close(1.0 - found * found, 1.0 - expected * expected, 0.06);
        let budget = outcome.budget.unwrap();
        assert!(budget.relative_residual().abs() < 1e-7, "{budget:?}");
        let line = budget.dissipated.iter().find(|line| line.law == "film_drained").unwrap();
        // Balls start flattened by a hundredth of the gap.
        let stored_j = budget.start_j - 0.5 * BALL.mass_kg * speed_m_s * speed_m_s;
        let lost_j = stored_j + 0.5 * mass_kg * speed_m_s * speed_m_s * (1.0 - found * found);
        close(line.energy_j, lost_j, 1e-6);
    }
}

#[test]
fn a_draining_film_never_creates_energy() {
    for (speed_m_s, gap_m, viscosity) in
        [(0.05, 1e-5, 0.3), (0.5, 1e-4, 0.1), (1.5, 1e-6, 0.03), (0.02, 1e-4, 0.4)]
    {
        let chain = two(speed_m_s, gap_m, oil(viscosity, None));
        let (trace, outcome) = shot(&chain, 1e-10, 2.0 * gap_m / speed_m_s + 4e-4);
        let mut before_j = 0.0;
        for budget in trace.budgets.iter().chain(&outcome.budget) {
            let lost = |law| budget.dissipated.iter().find(|line| line.law == law);
            let lost_j = lost("film_drained").unwrap().energy_j;
            // Where oil begins to flatten bodies, by 1 % of the gap, so far not counted.
            assert!(lost_j >= before_j - 1e-4 * budget.input_j, "{before_j:e} {budget:?}");
            before_j = lost_j;
        }
        assert!(before_j > 0.0);
        assert!(outcome.budget.unwrap().relative_residual().abs() < 1e-6);
    }
}

#[test]
fn a_film_without_oil_or_between_touching_balls_is_not_there() {
    let restitution_of = |oil| {
        let (_, outcome) = shot(&two(0.2, 1e-5, oil), 1e-10, 4e-4);
        restitution(&outcome, 0.2)
    };
    // Nothing else is lost.
    close(restitution_of(oil(0.0, None)), 1.0, 1e-8);
    // A pushed row starts dry, and closed contacts stay so.
    let pushed = |oil: Option<Arc<dyn Law>>| {
        let laws = [hertz()].into_iter().chain(oil).collect();
        let push = Push::Constant { force_n: 20.0 };
        let chain = Chain { push, ..row(10, 0.05, laws) };
        common::shoot(&chain, 1e-9).0.tof_incident_s()
    };
    close(pushed(Some(oil(0.1, None))), pushed(None), 1e-9);
}
