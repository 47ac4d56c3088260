//! Long chains that end at a wall: what they cost, counted, and what ends them.

use hertzchain_experiment::Experiment;
use hertzchain_sim::{Expected, Plan, Shot, shoot};

fn row(count: usize) -> Plan {
    let text = format!(
        r#"
        title = "row"
        units = "dimensionless"
        [striker]
        speed = 1
        [[beads]]
        count = {count}
        [sensors]
        bead = 7
        [far_end]
        kind = "half-bead"
        "#
    );
    let experiment = Experiment::from_text("row.toml", &text).unwrap();
    Plan::from_experiment(&experiment, None).unwrap().0
}

fn end_m_s(shot: &Shot) -> f64 {
    shot.rebound.unwrap().end_m_s.unwrap()
}

/// Bodies summed over force passes. Without two clocks and without the end by
/// energy 600 beads take 4·10⁸, 1,200 ten times that.
#[test]
fn a_pulse_to_the_wall_and_back_costs_few_bodies_a_pass() {
    let cost = |count: usize| shoot(&row(count)).unwrap().work.bodies_passed as f64;
    let (short, long) = (cost(600), cost(1_200));
    assert!(short < 2.5e7, "{short:e}");
    assert!(long < 9e7, "{long:e}");
    // Twice the way, twice the wake, somewhat shorter steps: not 2³.
    assert!(long < 4.5 * short, "{long:e} over {short:e}");
}

#[test]
fn flights_and_rebound_of_a_long_chain_are_those_of_a_shot_followed_for_long() {
    let plan = row(600);
    let shot = shoot(&plan).unwrap();
    let wall_s = shot.passage.as_ref().unwrap().wall.time_s;
    let longer =
        shoot(&Plan { duration_s: Some(4.2 * wall_s), ..plan.clone().with_accuracy(1e-8) });
    let longer = longer.unwrap();
    // To the accuracy asked.
    assert!(shot.flight.unwrap().change(&longer.flight.unwrap()) < 1e-6);
    // A velocity is right to thirty times that.
    let (early, late) = (end_m_s(&shot), longer.velocity_m_s[0]);
    assert!((early / late - 1.0).abs() < 3e-5, "{early} {late}");
    // The pulse is back after two flights; the search alone would go on to four.
    assert!(shot.finished && shot.duration_s < 2.5 * wall_s);
    let reported = |note: &&String| note.contains("long chain's shot ended");
    assert_eq!(shot.notes.iter().filter(reported).count(), 1, "{:?}", shot.notes);
}

/// A row that keeps its energy takes fewer steps than the dry ones that the estimate is from.
#[test]
fn the_steps_of_a_shot_are_estimated_to_a_factor_of_two() {
    for count in [40, 400] {
        let plan = row(count);
        let expected = Expected::of(&plan).unwrap().steps;
        let taken = shoot(&plan).unwrap().work.steps as f64;
        assert!((0.5..2.0).contains(&(expected / taken)), "{expected} for {taken}");
    }
}
