//! Shots that pilots judge for all.

use hertzchain_experiment::preset;
use hertzchain_sim::{
    InstructionSet, Judges, Plan, Settings, Shot, Tuned, shoot_all, shoot_tuned, sweep,
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
    let shots = shoot_all(plans, SET(), true, &|| {});
    shots.into_iter().map(Result::unwrap).collect()
}

fn tuned(plans: &[Plan]) -> Option<(Tuned, Vec<Shot>)> {
    let tuned = Tuned::new(&Tuned::pilots(plans), SET())?;
    let shots = shoot_tuned(plans, &tuned, SET(), &|| {});
    Some((tuned, shots.into_iter().map(Result::unwrap).collect()))
}

#[test]
fn what_pilots_chose_is_right_between_them() {
    // Behind wet contacts a few of a thousand are not: `docs/numerics.md`.
    for name in ["hertz", "hertz-viscoelastic", "dry"] {
        // Between 40 pilots lie 60 others.
        let exact = all(&plans(name, 100, 1e-6));
        for accuracy in [1e-3, 1e-4] {
            let (tuned, shots) = tuned(&plans(name, 100, accuracy)).unwrap();
            assert!(tuned.reached <= 0.5 * accuracy);
            let error = worst(&shots, &exact);
            assert!(error <= accuracy, "{name}: {error:e} at {accuracy:e}");
            let told = |shot: &Shot| shot.accuracy_reached.unwrap() <= accuracy;
            assert!(shots.iter().all(told), "{name}");
        }
    }
}

#[test]
fn pilots_choose_more_force_passes_for_more_accuracy() {
    let passes = |accuracy| {
        let (_, shots) = tuned(&plans("dry", 60, accuracy)).unwrap();
        shots.iter().map(|shot| shot.work.force_passes).sum::<u64>()
    };
    let [coarse, fine] = [1e-3, 1e-6].map(passes);
    assert!(coarse < fine, "{coarse} {fine}");
}

#[test]
fn a_tuned_shot_has_the_same_bits_in_any_company() {
    let plans = plans("dry", 50, 1e-4);
    let (tuned, shots) = tuned(&plans).unwrap();
    for at in [0, 17, 49] {
        let alone = shoot_tuned(&plans[at..=at], &tuned, SET(), &|| {});
        assert_eq!(alone[0].as_ref().unwrap(), &shots[at]);
    }
}

#[test]
fn tuned_shots_have_the_same_bits_on_any_number_of_threads() {
    let plans = plans("dry", 50, 1e-4);
    let (tuned, shots) = tuned(&plans).unwrap();
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let again = pool.build().unwrap().install(|| {
            // The setting is found on these threads too.
            let found = Tuned::new(&Tuned::pilots(&plans), SET());
            assert_eq!(found, Some(tuned), "{threads} threads");
            shoot_tuned(&plans, &tuned, SET(), &|| {})
        });
        let again: Vec<Shot> = again.into_iter().map(Result::unwrap).collect();
        assert_eq!(again, shots, "{threads} threads");
    }
}

#[test]
fn pilots_that_would_cost_more_than_judges_are_none() {
    let plans = plans("motor", 40, 1e-5);
    assert_eq!(Tuned::new(&Tuned::pilots(&plans), SET()), None);
}

#[test]
fn plans_that_are_not_alike_or_not_for_equal_steps_have_no_pilots() {
    let mut mixed = plans("dry", 4, 1e-4);
    mixed[2].accuracy = 1e-3;
    assert_eq!(Tuned::new(&mixed, SET()), None);
    let rebounds: Vec<Plan> = plans("dry", 2, 1e-4)
        .into_iter()
        .map(|plan| Plan {
            rebound: true,
            ..plan
        })
        .collect();
    assert_eq!(Tuned::new(&rebounds, SET()), None);
    assert_eq!(Tuned::new(&[], SET()), None);
}

#[test]
fn a_sweep_tells_whom_its_accuracy_is_from() {
    let experiment = preset("dry").unwrap();
    let run = |judges| {
        let settings = Settings {
            adjust: &|plan| {
                plan.rebound = false;
                plan.accuracy = 1e-3;
            },
            judges,
            ..Settings::default()
        };
        sweep(&experiment, &[0.3, 0.5, 0.7], &settings)
    };
    let [each, pilots] = [Judges::Each, Judges::Pilots].map(run);
    assert_eq!(each.tuned, None);
    let tuned = pilots.tuned.unwrap();
    assert_eq!(tuned.pilots, 3);
    for point in &pilots.points {
        let shot = point.shot.as_ref().unwrap();
        assert_eq!(shot.accuracy_reached, Some(tuned.reached));
    }
}
