//! The integration against numbers known otherwise.

use crate::draw;
use crate::reference::Reference;
use crate::row::{Ball, Far, Law, Material, Row};
use hertzchain_experiment::Experiment;
use hertzchain_sim::{Control, InstructionSet, Plan, Shot, run_plans, shoot, shoot_estimated};

/// The paper's row of 40 steel balls.
fn paper(speed_m_s: f64, laws: &[Law]) -> Row {
    let ball = Ball { radius_m: 6.35e-3, mass_kg: 8.54e-3, material: 0 };
    Row {
        title: String::new(),
        materials: vec![Material { young_pa: 213e9, poisson: 0.3, viscosity_pa_s: 3.2e4 }],
        striker: ball,
        speed_m_s,
        beads: vec![ball; 40],
        sections: vec![(0, laws.to_vec())],
        far: Far::HalfBead,
        push: None,
        incline_deg: 0.0,
        gaps: Vec::new(),
        clipped: false,
        sensor: 7,
    }
}

/// Incident and reflected time of flight in s.
fn flights(row: &Row) -> [f64; 2] {
    let mut reference = Reference::tight(row);
    reference.cover(0.0).unwrap();
    let arrival = reference.signals().arrival().unwrap();
    let wall_s = arrival.wall.time_s;
    [wall_s - arrival.incident.unwrap().time_s, arrival.reflected.unwrap().time_s - wall_s]
}

/// Against docs of the design: ToFs printed to 1e-12 s there.
#[test]
fn times_of_flight_of_the_paper_s_rows_agree_with_other_integrations() {
    let visco = [Law::ElasticHertz, Law::Viscoelastic];
    let dry = [Law::ElasticHertz, Law::Viscoelastic, Law::Cubic { coefficient: 77.0 }];
    let known = [
        (1.0, &visco[..1], [630.841591, 632.265715]),
        (0.5, &visco[..], [751.270959, 783.036376]),
        (1.23, &dry[..], [660.261248, 699.493431]),
    ];
    for (speed_m_s, laws, right_us) in known {
        let found = flights(&paper(speed_m_s, laws));
        for (found_s, right_us) in found.into_iter().zip(right_us) {
            // The digits known, and a few of the last one.
            assert!((1e6 * found_s - right_us).abs() < 2e-6, "{found:?} {right_us}");
        }
    }
}

/// Rows on which program and reference agreed when it was made, with the reference's times:
/// `target/release/hertzchain-random 70 --sample > bench/random/sample.csv`. The last seventeen have
/// maxima that are narrower than any step, far fainter than the pulse, or hardly any, forces that are cut,
/// closings that decide on the error, small returns, or a return right behind the wall's peak.
const SAMPLE: &str = include_str!("../sample.csv");

/// Relative error of a shot's times of flight beside the reference's.
fn error(shot: &Shot, right_s: [f64; 2]) -> f64 {
    let flight = shot.flight.unwrap();
    let off = |found_s: f64, right_s: f64| (found_s / right_s - 1.0).abs();
    assert_eq!(flight.reflected_s.is_none(), right_s[1].is_nan());
    let back = flight.reflected_s.map_or(0.0, |found_s| off(found_s, right_s[1]));
    off(flight.incident_s, right_s[0]).max(back)
}

/// As wrong as stated, and the reference's own error.
fn assert_as_stated(shot: &Shot, right_s: [f64; 2], what: &str) {
    let (error, stated) = (error(shot, right_s), shot.accuracy_reached.unwrap());
    assert!(error <= stated + 1e-9, "{what}: error {error:e}, stated {stated:e}");
}

#[test]
fn shots_and_sweeps_of_a_fixed_sample_are_as_wrong_as_they_state_at_most() {
    for line in SAMPLE.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let right_s = [cells[2].parse().unwrap(), cells[3].parse().unwrap()];
        let row = draw::row(cells[0].parse().unwrap(), cells[1].parse().unwrap(), None);
        let experiment = Experiment::from_text("row.toml", &row.toml()).unwrap();
        let plan = Plan::from_experiment(&experiment, None).unwrap().0;
        let shot = shoot_estimated(&plan.clone().with_budget()).unwrap();
        assert_as_stated(&shot, right_s, &format!("shot of row {line}"));
        for accuracy in [1e-3, 1e-5, 1e-6] {
            let plans = [plan.clone().for_flights().with_accuracy(accuracy)];
            let shots = run_plans(
                &plans,
                Control::PerShot { checked: false },
                InstructionSet::default(),
                &|| {},
            );
            let what = format!("sweep of row {line} at {accuracy:e}");
            assert_as_stated(shots[0].as_ref().unwrap(), right_s, &what);
        }
    }
}

/// Rows whose errors hardly fall with the tolerance, so that one change to a looser run says too little,
/// one with a peak that steps may hold beside another maximum, and one whose loose runs have no time of flight.
#[test]
fn shots_of_rows_with_slow_convergence_are_as_wrong_as_they_state_at_most() {
    for (seed, at) in [(11, 64), (11, 93), (11, 125), (151, 1382), (227, 1710)] {
        let row = draw::row(seed, at, None);
        let experiment = Experiment::from_text("row.toml", &row.toml()).unwrap();
        let plan = Plan::from_experiment(&experiment, None).unwrap().0;
        let exact = shoot(&plan.clone().for_flights().with_accuracy(1e-12)).unwrap();
        let exact = exact.flight.unwrap();
        for half_decades in 6..=12 {
            let accuracy = 10_f64.powf(-0.5 * f64::from(half_decades));
            let shot =
                shoot_estimated(&plan.clone().with_budget().with_accuracy(accuracy)).unwrap();
            let right_s = [exact.incident_s, exact.reflected_s.unwrap_or(f64::NAN)];
            assert_as_stated(&shot, right_s, &format!("row {at} at {accuracy:e}"));
        }
    }
}
