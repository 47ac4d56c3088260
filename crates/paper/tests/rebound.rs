//! One end of a shot: the striker's rebound is the same wherever it is asked for.

use crate::reproduce::{CASES, Cases, Effort, Gathering, gather};
use hertzchain_experiment::{Experiment, Reading, preset};
use hertzchain_sim::{Batch, BatchOptions, Column, Plan, Shard, Shot, shoot};

fn plan(experiment: &Experiment, speed_m_s: f64, accuracy: f64) -> Plan {
    let (plan, _) = Plan::from_experiment(experiment, Some(speed_m_s)).unwrap();
    plan.with_accuracy(accuracy)
}

fn end_m_s(shot: &Shot) -> f64 {
    shot.rebound.unwrap().end_m_s.unwrap()
}

/// A velocity gathers the errors of all steps and the loosened chain amplifies
/// them: it is right to thirty times the accuracy asked of times of flight.
const OF_REBOUND: f64 = 30.0;

#[test]
fn shot_sweep_and_reproduce_agree_on_the_rebound() {
    let (speeds, accuracy) = ([0.1, 0.5], 1e-6);
    let how = Gathering {
        cases: &Cases::new(&Reading::default()).unwrap(),
        speeds_m_s: &speeds,
        accuracy,
        effort: Effort::Checked,
    };
    let reproduced = gather(&how, None, &|| {}).unwrap();
    for case in CASES {
        let experiment = preset(case).unwrap();
        let options = BatchOptions {
            accuracy,
            rebound: true,
            checked: true,
            ..BatchOptions::of(&experiment)
        };
        let batch = Batch::new(&experiment, speeds.to_vec(), options).unwrap();
        let rows = batch.run(Shard::WHOLE, &|| {}).rows;
        for (speed, by_sweep) in speeds.iter().zip(rows.column(Column::Rebound)) {
            let shot = shoot(&plan(&experiment, *speed, 1e-9)).unwrap();
            let curve = reproduced.curve(case).unwrap();
            let by_reproduce = curve.at(*speed).unwrap().striker_rebound_m_s;
            // `reproduce` may take a shot of a tenth of the accuracy, by another method.
            assert!((by_sweep / by_reproduce - 1.0).abs() < 3e-6, "{case} at {speed}");
            let off = (by_sweep / end_m_s(&shot) - 1.0).abs();
            assert!(off < OF_REBOUND * accuracy, "{case} at {speed}: {off:e}");
        }
    }
}

#[test]
fn nothing_hits_the_striker_after_the_end_of_the_shot() {
    for case in CASES {
        for speed in [0.075, 0.25, 1.23] {
            let plan = plan(&preset(case).unwrap(), speed, 1e-6);
            let shot = shoot(&plan).unwrap();
            let longer = shoot(&Plan { duration_s: Some(10.0 * shot.duration_s), ..plan }).unwrap();
            let long_after = longer.velocity_m_s[0];
            assert_eq!(end_m_s(&shot), long_after, "{case} at {speed} m/s");
            assert_eq!(end_m_s(&longer), long_after, "{case} at {speed} m/s");
        }
    }
}

#[test]
fn a_rebound_that_is_not_followed_is_not_given() {
    let plan = plan(&preset("gear").unwrap(), 0.1, 1e-6);
    let whole = shoot(&plan).unwrap();
    let flights = shoot(&plan.clone().for_flights()).unwrap();
    assert_eq!(flights.rebound.unwrap().end_m_s, None);
    assert_eq!(flights.flight, whole.flight);
    assert!(flights.work.force_passes < whole.work.force_passes);
    let cut = shoot(&Plan { duration_s: Some(flights.duration_s), ..plan });
    assert_eq!(cut.unwrap().rebound.unwrap().end_m_s, None);
}

fn equal_beads(count: usize, far_end: &str) -> Experiment {
    let text = format!(
        r#"
        title = "row"
        units = "dimensionless"
        [striker]
        speed = 1
        [[beads]]
        count = {count}
        [sensors]
        bead = 2
        {far_end}
        "#
    );
    Experiment::from_text("row.toml", &text).unwrap()
}

#[test]
fn dimensionless_rows_of_any_length_end_a_few_flights_after_the_pulse() {
    for count in [3, 30, 300] {
        let row = equal_beads(count, "[far_end]\nkind = \"half-bead\"");
        let shot = shoot(&plan(&row, 1.0, 1e-6)).unwrap();
        let wall_s = shot.passage.as_ref().unwrap().wall.time_s;
        assert!(end_m_s(&shot) < -0.9, "{count}: {:?}", shot.rebound);
        assert!(shot.finished && shot.duration_s <= 6.01 * wall_s, "{count}");
    }
}

#[test]
fn without_a_wall_the_rebound_is_that_of_the_first_separation() {
    let row = equal_beads(20, "[far_end]\nkind = \"free\"");
    let shot = shoot(&plan(&row, 1.0, 1e-9)).unwrap();
    // A Hertz striker leaves an equal row at −0.0711 v0, to four digits.
    assert!((end_m_s(&shot) + 0.0711).abs() < 5e-5, "{:?}", shot.rebound);
    assert_eq!(shot.rebound.unwrap().first.unwrap().1, end_m_s(&shot));
}

#[test]
fn a_chain_that_rings_under_load_ends_after_six_flights() {
    let loaded = preset("precompressed").unwrap();
    let (plan, _) = Plan::from_experiment(&loaded, None).unwrap();
    let shot = shoot(&plan).unwrap();
    let wall_s = shot.passage.as_ref().unwrap().wall.time_s;
    // The shot ends with the step in which six flights are over.
    assert!((shot.duration_s / wall_s - 6.0).abs() < 0.02);
    assert!(end_m_s(&shot) < 0.0);
}
