//! What shots of the ensemble loop cost, and that what rests costs nothing.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::common::ensemble::*;
use crate::common::*;
use hertzchain_chain::ensemble::{End, LaneResult, Precision, Settings};
use hertzchain_chain::laws::Law;
use hertzchain_chain::*;
use std::sync::Arc;

fn dry() -> Vec<Arc<dyn Law>> {
    vec![hertz(), viscoelastic(), cubic()]
}

#[test]
fn the_dry_shot_costs_this_many_force_passes() {
    let system = System::new(&row(40, 0.5, dry())).unwrap();
    for set in InstructionSet::available() {
        for (step, openings, passes) in [
            (0.205, false, 625),
            (0.16, false, 785),
            (0.07, true, 1745),
            (0.05, false, 2417),
            (0.05, true, 2417),
        ] {
            let settings = Settings { set, openings, ..settings(40) };
            let flown = fire_one(&system, (step, 1e-2), &settings);
            assert!(flown.finished);
            // One pass a step, and the first forces.
            assert_eq!(flown.work.force_passes, passes, "step {step}");
            assert_eq!(flown.work.steps + 1, passes, "step {step}");
        }
    }
}

#[test]
fn wet_shots_and_single_precision_cost_as_many_passes_as_their_time_has_steps() {
    // Wet pulses take longer to come back; the precision changes no step.
    for (wet, passes) in [(false, 785), (true, 817)] {
        let mut chain = row(40, 0.5, dry());
        if wet {
            chain.sections[0].contacts = 0..=6;
            chain.sections.push(Section {
                contacts: 7..=40,
                laws: vec![hertz(), viscoelastic()],
                material: Some(Material {
                    shear_viscosity_pa_s: 1e5,
                    bulk_viscosity_pa_s: 1e5,
                    ..chain.beads[0].material
                }),
            });
        }
        let system = [System::new(&chain).unwrap()];
        for precision in PRECISIONS {
            let flown = fire_all_in(precision, &system, (0.16, 1e-2), &settings(40));
            let flown = flown.into_iter().next().unwrap().unwrap();
            assert_eq!(flown.work.force_passes, passes, "{precision:?}, wet: {wet}");
        }
    }
}

#[test]
fn a_hundred_thousand_beads_cost_what_moves_and_keep_the_bits() {
    let system = [System::new(&row(100_000, 0.5, dry())).unwrap()];
    for precision in PRECISIONS {
        let [part, whole] = [false, true].map(|whole_chain| {
            let settings = Settings { whole_chain, end: End::Duration, ..settings(100_000) };
            let time_s = 60.0 * system[0].scales().time_s;
            let flown = fire_all_in(precision, &system, (0.1, time_s), &settings);
            flown.into_iter().next().unwrap().unwrap()
        });
        if let Some(difference) = difference(&part, &whole) {
            panic!("{precision:?}: {difference}");
        }
        assert!(part.bodies_looked_at * 500 < whole.bodies_looked_at);
    }
}

/// One shot alone and a full block, in both precisions.
fn every_number_of_lanes() -> impl Iterator<Item = (Precision, usize)> {
    let lanes = |precision: Precision| [1, precision.lanes()].map(|lanes| (precision, lanes));
    PRECISIONS.into_iter().flat_map(lanes)
}

/// Chains at different speeds, until a time at which the wave has gone half way.
fn pair(
    precision: Precision,
    lanes: usize,
    chain: impl Fn(f64) -> Chain,
    openings: bool,
) -> [Vec<LaneResult>; 2] {
    let speed = |lane: usize| 0.3 + 0.1 * lane as f64;
    let systems: Vec<System> =
        (0..lanes).map(|lane| System::new(&chain(speed(lane))).unwrap()).collect();
    [false, true].map(|whole_chain| {
        let settings = Settings { whole_chain, openings, end: End::Duration, ..settings(200) };
        let flown = fire_all_in(precision, &systems, (0.1, 2e-3), &settings);
        flown.into_iter().map(Result::unwrap).collect()
    })
}

#[test]
fn without_preload_the_moving_part_alone_gives_the_bits_of_the_whole_chain() {
    for (precision, lanes) in every_number_of_lanes() {
        for openings in [false, true] {
            let [part, whole] = pair(precision, lanes, |v| row(200, v, dry()), openings);
            for (part, whole) in part.iter().zip(&whole) {
                if let Some(difference) = difference(part, whole) {
                    panic!("{precision:?}, {lanes} lanes: {difference}");
                }
                assert!(part.bodies_looked_at * 10 < whole.bodies_looked_at * 7);
            }
        }
    }
}

#[test]
fn bodies_behind_a_returning_pulse_cost_nothing_once_only_that_pulse_is_wanted() {
    for (precision, lanes) in every_number_of_lanes() {
        let systems: Vec<System> = (0..lanes)
            .map(|lane| System::new(&row(100, 0.3 + 0.01 * lane as f64, dry())).unwrap())
            .collect();
        let [behind, all] = [false, true].map(|whole_chain| {
            let settings = Settings { whole_chain, ..settings(100) };
            let flown = fire_all_in(precision, &systems, (0.1, 1e-2), &settings);
            flown.into_iter().map(Result::unwrap).collect::<Vec<_>>()
        });
        for (behind, all) in behind.iter().zip(&all) {
            if let Some(difference) = difference(behind, all) {
                panic!("{precision:?}, {lanes} lanes: {difference}");
            }
            // What is ahead on the way in and behind on the way back, half in all but for whole chunks and what the pulse spans.
            assert!(behind.bodies_looked_at * 4 < all.bodies_looked_at * 3);
        }
    }
}

/// Laws that run one by one, over contacts no two of which are alike.
#[test]
fn each_contact_keeps_its_own_coefficients_when_others_sleep() {
    let chain = |speed| {
        let mut chain = row(200, speed, vec![cubic(), hertz()]);
        for (i, bead) in chain.beads.iter_mut().enumerate() {
            bead.radius_m *= 1.0 + 1e-3 * i as f64;
        }
        chain
    };
    for (precision, lanes) in every_number_of_lanes() {
        let [part, whole] = pair(precision, lanes, chain, false);
        for (part, whole) in part.iter().zip(&whole) {
            if let Some(difference) = difference(part, whole) {
                panic!("{precision:?}, {lanes} lanes: {difference}");
            }
        }
    }
}

/// What rests feels no force to the last bit, so that here, too, the bits are
/// those of the whole chain.
#[test]
fn under_preload_the_moving_part_alone_gives_the_bits_of_the_whole_chain() {
    let push = Push::Constant { force_n: 5.0 };
    let chain = |speed| Chain { push, ..row(200, speed, dry()) };
    for (precision, lanes) in every_number_of_lanes() {
        for openings in [false, true] {
            let [part, whole] = pair(precision, lanes, chain, openings);
            for (part, whole) in part.iter().zip(&whole) {
                if let Some(difference) = difference(part, whole) {
                    panic!("{precision:?}, {lanes} lanes: {difference}");
                }
                assert!(part.bodies_looked_at * 2 < whole.bodies_looked_at);
            }
        }
    }
}
