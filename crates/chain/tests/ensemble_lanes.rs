//! A shot of the ensemble loop knows nothing of its lane and its neighbours.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::common::ensemble::*;
use crate::common::*;
use hertzchain_chain::ensemble::{End, LaneResult, Precision, Settings, Shot, fire, fire_each};
use hertzchain_chain::laws::{
    DampingCubic, DampingLinear, DampingPower, ElasticHertz, ElasticPlasticThornton, Law, law,
};
use hertzchain_chain::wave::SolveError;
use hertzchain_chain::*;
use std::cell::Cell;
use std::sync::Arc;

const DURATION_S: f64 = 2e-3;

fn dry() -> Vec<Arc<dyn Law>> {
    vec![hertz(), viscoelastic(), cubic()]
}

#[track_caller]
fn same(one: &LaneResult, two: &LaneResult, which: impl Fn() -> String) {
    if let Some(difference) = difference(one, two) {
        panic!("{}: {difference}", which());
    }
}

/// Alike rows at different speeds.
fn rows(count: usize, chain: impl Fn(f64) -> Chain) -> Vec<System> {
    let speed = |i: usize| 0.1 + 0.07 * i as f64;
    (0..count).map(|i| System::new(&chain(speed(i))).unwrap()).collect()
}

/// A kind of chain and its chain for a speed.
type Kind = (&'static str, fn(f64) -> Chain);

/// Chains that take every way through the loop.
fn kinds() -> Vec<Kind> {
    vec![
        ("fused laws", |v| row(12, v, dry())),
        ("fused laws, each lane with its own numbers", |v| {
            let coefficient_kg_s_m2 = 77.0 * (1.0 + v);
            let hertz = law(ElasticHertz { stiffness: Some(9e9 * (1.0 + v)) });
            let cubic = law(DampingCubic { coefficient_kg_s_m2 });
            row(12, v, vec![hertz, viscoelastic(), cubic])
        }),
        ("unfused laws", |v| row(11, v, law_by_law())),
        ("laws with memory", |v| row(10, v, with_memory())),
        ("sections that end within eight bodies", |v| Chain {
            sections: sections(13),
            ..row(13, v, vec![])
        }),
        ("clipped tension and a gap", |v| Chain {
            tension: Tension::Clipped,
            gaps: vec![Gap { contact: 5, gap_m: 1e-7 }],
            ..row(12, v, dry())
        }),
        ("preload", |v| Chain { push: Push::Constant { force_n: 2.0 }, ..row(40, v, dry()) }),
        ("preload on unlike beads", |v| Chain {
            push: Push::Constant { force_n: 3.0 },
            beads: (0..60).map(|i| shrunk(0.99_f64.powi(i))).collect(),
            ..row(60, 4.0 * v * v, dry())
        }),
        ("a spring", |v| Chain {
            push: Push::Spring { force_n: 2.0, stiffness_n_m: 1e5 },
            ..row(20, v, dry())
        }),
        ("an incline", |v| Chain { incline_rad: 0.3, ..row(12, v, dry()) }),
        ("a stop", |v| Chain {
            far: FarEnd::Stop { radius_m: BALL.radius_m, material: STEEL, mass_kg: 0.5 },
            ..row(12, v, dry())
        }),
    ]
}

/// A ball of another radius.
fn shrunk(factor: f64) -> Bead {
    Bead { radius_m: factor * BALL.radius_m, mass_kg: factor.powi(3) * BALL.mass_kg, ..BALL }
}

fn law_by_law() -> Vec<Arc<dyn Law>> {
    let power = law(DampingPower { coefficient: 1.0, rate_exponent: 1.3, overlap_exponent: 0.2 });
    vec![hertz(), power]
}

fn with_memory() -> Vec<Arc<dyn Law>> {
    vec![law(ElasticPlasticThornton { yield_pressure_pa: 1e9 })]
}

/// Three sections, none of which ends where eight bodies do.
fn sections(beads: usize) -> Vec<Section> {
    let section = |contacts, laws| Section { contacts, laws, material: None };
    vec![
        section(0..=2, dry()),
        section(3..=9, vec![hertz(), viscoelastic()]),
        section(10..=beads, law_by_law()),
    ]
}

fn settings_for(systems: &[System], openings: bool) -> Settings {
    Settings { openings, ..settings(systems[0].beads()) }
}

#[test]
fn every_number_of_shots_gives_the_bits_of_each_shot_alone() {
    let systems = rows(33, |v| row(12, v, dry()));
    let settings = settings_for(&systems, true);
    for precision in PRECISIONS {
        let alone: Vec<_> = systems
            .iter()
            .map(|system| fire_one_in(precision, system, (0.1, DURATION_S), &settings))
            .collect();
        for count in 1..=2 * precision.lanes() + 1 {
            let systems = &systems[..count];
            let flown = fire_all_in(precision, systems, (0.1, DURATION_S), &settings);
            for (i, (flown, alone)) in flown.into_iter().zip(&alone).enumerate() {
                same(&flown.unwrap(), alone, || format!("{precision:?}: shot {i} of {count}"));
            }
        }
    }
}

#[test]
fn every_kind_of_chain_gives_the_same_bits_alone_and_side_by_side_in_any_order() {
    for precision in PRECISIONS {
        for (kind, chain) in kinds() {
            let systems = rows(precision.lanes(), chain);
            for set in InstructionSet::available() {
                for openings in [false, true] {
                    let settings = Settings { set, ..settings_for(&systems, openings) };
                    same_in_any_order(precision, &systems, &settings, kind);
                }
            }
        }
    }
}

fn same_in_any_order(precision: Precision, systems: &[System], settings: &Settings, kind: &str) {
    let alone: Vec<_> = systems
        .iter()
        .map(|system| fire_one_in(precision, system, (0.1, DURATION_S), settings))
        .collect();
    for turned in [0, 3, 5] {
        let mut order: Vec<usize> = (0..systems.len()).collect();
        order.rotate_left(turned);
        order.swap(1, 6);
        let turned: Vec<System> = order.iter().map(|&i| systems[i].clone()).collect();
        let flown = fire_all_in(precision, &turned, (0.1, DURATION_S), settings);
        for (flown, &i) in flown.into_iter().zip(&order) {
            same(&flown.unwrap(), &alone[i], || {
                let (set, openings) = (settings.set.name(), settings.openings);
                format!("{kind}, {precision:?}: shot {i}, {set}, openings {openings}")
            });
        }
    }
}

#[test]
fn shots_of_other_shapes_in_between_change_no_bits() {
    let (one, two) = (rows(5, |v| row(12, v, dry())), rows(5, |v| row(9, v, vec![hertz()])));
    let settings = settings(9);
    let mixed: Vec<System> =
        one.iter().zip(&two).flat_map(|(a, b)| [a.clone(), b.clone()]).collect();
    for (system, flown) in mixed.iter().zip(fire_all(&mixed, (0.1, DURATION_S), &settings)) {
        let alone = fire_one(system, (0.1, DURATION_S), &settings);
        same(&flown.unwrap(), &alone, || format!("{} beads", system.beads()));
    }
}

#[test]
fn lanes_with_their_own_steps_and_durations_give_the_bits_of_each_shot_alone() {
    let systems = rows(24, |v| row(12, v, dry()));
    // Eight in double precision and sixteen in single, mixed.
    let shots: Vec<Shot<'_>> = systems
        .iter()
        .enumerate()
        .map(|(i, system)| Shot {
            system,
            step: 0.06 + 0.005 * i as f64,
            duration_s: if i % 4 == 0 { 1e-4 } else { DURATION_S },
            precision: PRECISIONS[usize::from(i % 3 != 1)],
        })
        .collect();
    for end in [End::Duration, End::Passed, End::Reflected] {
        let settings = Settings { end, ..settings_for(&systems, true) };
        for (shot, flown) in shots.iter().zip(fire(&shots, &settings)) {
            let alone = fire(std::slice::from_ref(shot), &settings).remove(0);
            same(&flown.unwrap(), &alone.unwrap(), || format!("{end:?}"));
        }
    }
}

#[test]
fn shots_that_no_user_wants_any_more_are_broken_off_within_few_steps() {
    let systems = rows(3, |v| row(12, v, dry()));
    let settings = settings(12);
    for precision in PRECISIONS {
        let shot = |system| Shot { system, step: 0.1, duration_s: DURATION_S, precision };
        let shots: Vec<Shot<'_>> = systems.iter().map(shot).collect();
        for most in [0, 1, 5] {
            let asked = Cell::new(0);
            let wanted = || asked.replace(asked.get() + 1) < most;
            for flown in fire_each(&shots, &settings, &wanted, |_, lane| lane) {
                assert_eq!(flown.unwrap_err(), SolveError::BrokenOff);
            }
            assert_eq!(asked.get(), most + 1);
        }
    }
}

fn dashpot(coefficient_n_s_m: f64) -> Chain {
    let dashpot = law(DampingLinear { coefficient_n_s_m });
    row(12, 0.5, vec![hertz(), dashpot])
}

/// A dashpot so stiff that equal steps of a contact time diverge.
const TOO_STIFF: f64 = 1e5;

#[test]
fn a_shot_that_diverges_is_reported_alone_and_its_neighbours_keep_their_bits() {
    let settings = Settings { openings: true, ..settings(12) };
    let system = |stiff: bool| {
        let coefficient = if stiff { TOO_STIFF } else { 2.0 };
        System::new(&dashpot(coefficient)).unwrap()
    };
    for precision in PRECISIONS {
        let fired =
            |systems: &[System]| fire_all_in(precision, systems, (0.1, DURATION_S), &settings);
        let sound = fired(&[system(false)]).remove(0).unwrap();
        for bad in 0..precision.lanes() {
            let lanes = 0..precision.lanes();
            let systems: Vec<System> = lanes.map(|lane| system(lane == bad)).collect();
            for (lane, flown) in fired(&systems).into_iter().enumerate() {
                match flown {
                    Ok(flown) => same(&flown, &sound, || format!("lane {lane} beside {bad}")),
                    Err(SolveError::Diverged(_)) => assert_eq!(lane, bad),
                    Err(error) => unreachable!("{error}"),
                }
            }
        }
        let alone = fired(&[system(true)]);
        assert!(matches!(alone[0], Err(SolveError::Diverged(_))));
    }
}

#[test]
fn a_shot_that_cannot_be_fired_is_refused_alone() {
    let systems = rows(9, |v| row(12, v, dry()));
    let settings = settings_for(&systems, false);
    let shots: Vec<Shot<'_>> = systems
        .iter()
        .enumerate()
        .map(|(i, system)| Shot {
            system,
            step: if i == 2 { f64::NAN } else { 0.1 },
            duration_s: if i == 5 { -1.0 } else { DURATION_S },
            precision: Precision::Double,
        })
        .collect();
    for (i, (shot, flown)) in shots.iter().zip(fire(&shots, &settings)).enumerate() {
        match (i, flown) {
            (2 | 5, Err(SolveError::Setting { .. })) => {}
            (_, flown) => {
                let alone = fire_one(shot.system, (0.1, DURATION_S), &settings);
                same(&flown.unwrap(), &alone, || format!("shot {i}"));
            }
        }
    }
}

#[test]
fn a_sensor_that_only_some_chains_have_is_refused_only_there() {
    let systems =
        [System::new(&row(12, 0.5, dry())).unwrap(), System::new(&row(6, 0.5, dry())).unwrap()];
    let flown = fire_all(&systems, (0.1, 1e-4), &settings(12));
    assert!(flown[0].is_ok());
    let missing = Sensor::Bead(7);
    assert_eq!(
        flown[1].as_ref().err(),
        Some(&SolveError::Refused(format!("the chain has no {missing:?}")))
    );
}
