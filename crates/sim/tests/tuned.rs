//! Shots with calibrated error control.

use hertzchain_experiment::preset;
use hertzchain_sim::{
    Batch, BatchOptions, Calibration, Control, ErrorControl, InstructionSet, Plan, Shard, Shot,
    run_plans,
};

const SET: fn() -> InstructionSet = InstructionSet::default;

fn plans(name: &str, count: u32, accuracy: f64) -> Vec<Plan> {
    let experiment = preset(name).unwrap();
    let speed = |i: u32| 0.075 * (1.23_f64 / 0.075).powf(f64::from(i) / f64::from(count - 1));
    let plan = |i| {
        Plan::from_experiment(&experiment, Some(speed(i)))
            .unwrap()
            .0
    };
    let alone = |i| plan(i).for_flights().with_accuracy(accuracy);
    (0..count).map(alone).collect()
}

fn worst(shots: &[Shot], exact: &[Shot]) -> f64 {
    let errors = shots.iter().zip(exact);
    let errors = errors.map(|(one, two)| one.flight.unwrap().change(&two.flight.unwrap()));
    errors.fold(0.0, f64::max)
}

fn all(plans: &[Plan]) -> Vec<Shot> {
    let shots = run_plans(plans, Control::PerShot { checked: true }, SET(), &|| {});
    shots.into_iter().map(Result::unwrap).collect()
}

fn calibrate(plans: &[Plan]) -> Option<Calibration> {
    let places = Calibration::places(plans.len());
    let sample: Vec<Plan> = places.map(|place| plans[place].clone()).collect();
    Calibration::new(&sample, SET())
}

fn calibrated(plans: &[Plan]) -> Option<(Calibration, Vec<Shot>)> {
    let tuned = calibrate(plans)?;
    let shots = run_plans(plans, Control::Calibrated(&tuned), SET(), &|| {});
    Some((tuned, shots.into_iter().map(Result::unwrap).collect()))
}

#[test]
fn a_calibrated_setting_is_right_between_the_calibration_shots() {
    // Behind wet contacts a few of a thousand are not: `docs/explanation/numerics.md`.
    for name in ["hertz", "hertz-viscoelastic", "dry"] {
        // Between 40 calibration shots lie 60 others.
        let exact = all(&plans(name, 100, 1e-6));
        for accuracy in [1e-3, 1e-4] {
            let (tuned, shots) = calibrated(&plans(name, 100, accuracy)).unwrap();
            assert!(tuned.reached <= 0.5 * accuracy);
            let error = worst(&shots, &exact);
            assert!(error <= accuracy, "{name}: {error:e} at {accuracy:e}");
            let right = |shot: &Shot| shot.accuracy_reached.unwrap() <= accuracy;
            assert!(shots.iter().all(right), "{name}");
        }
    }
}

#[test]
fn calibration_chooses_more_force_passes_for_more_accuracy() {
    let passes = |accuracy| {
        let (_, shots) = calibrated(&plans("dry", 60, accuracy)).unwrap();
        shots.iter().map(|shot| shot.work.force_passes).sum::<u64>()
    };
    let [coarse, fine] = [1e-3, 1e-6].map(passes);
    assert!(coarse < fine, "{coarse} {fine}");
}

#[test]
fn a_calibrated_shot_has_the_same_bits_in_any_company() {
    let plans = plans("dry", 50, 1e-4);
    let (tuned, shots) = calibrated(&plans).unwrap();
    for at in [0, 17, 49] {
        let alone = run_plans(&plans[at..=at], Control::Calibrated(&tuned), SET(), &|| {});
        assert_eq!(alone[0].as_ref().unwrap(), &shots[at]);
    }
}

#[test]
fn calibrated_shots_have_the_same_bits_on_any_number_of_threads() {
    let plans = plans("dry", 50, 1e-4);
    let (tuned, shots) = calibrated(&plans).unwrap();
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let again = pool.build().unwrap().install(|| {
            // The setting is found on these threads too.
            let found = calibrate(&plans);
            assert_eq!(found, Some(tuned), "{threads} threads");
            run_plans(&plans, Control::Calibrated(&tuned), SET(), &|| {})
        });
        let again: Vec<Shot> = again.into_iter().map(Result::unwrap).collect();
        assert_eq!(again, shots, "{threads} threads");
    }
}

#[test]
fn calibration_that_would_cost_more_than_control_per_shot_is_none() {
    let plans = plans("motor", 40, 1e-5);
    assert_eq!(calibrate(&plans), None);
}

#[test]
fn plans_that_differ_or_do_not_suit_equal_steps_have_no_calibration() {
    let mut mixed = plans("dry", 4, 1e-4);
    mixed[2].accuracy = 1e-3;
    assert_eq!(Calibration::new(&mixed, SET()), None);
    let rebounds: Vec<Plan> = plans("dry", 2, 1e-4)
        .into_iter()
        .map(|plan| Plan {
            rebound: true,
            ..plan
        })
        .collect();
    assert_eq!(Calibration::new(&rebounds, SET()), None);
    assert_eq!(Calibration::new(&[], SET()), None);
}

#[test]
fn a_batch_reports_the_accuracy_of_its_calibration() {
    let experiment = preset("dry").unwrap();
    let run = |error_control| {
        let options = BatchOptions {
            accuracy: 1e-3,
            error_control,
            ..BatchOptions::of(&experiment)
        };
        let batch = Batch::new(&experiment, vec![0.3, 0.5, 0.7], options).unwrap();
        let mut shots = Vec::new();
        let take = |it: hertzchain_sim::BatchShot| shots.push(it.shot.unwrap());
        let (_, calibration) = batch.run_each(Shard::WHOLE, &|| {}, take);
        (calibration, shots)
    };
    assert_eq!(run(ErrorControl::PerShot).0, None);
    let (calibration, shots) = run(ErrorControl::Calibrated);
    let calibration = calibration.unwrap();
    assert_eq!(calibration.shots, 3);
    for shot in &shots {
        assert_eq!(shot.accuracy_reached, Some(calibration.reached));
    }
}
