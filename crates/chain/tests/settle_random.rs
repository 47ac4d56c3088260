//! The slow phase of random small chains: no panic, and rest is rest.

use crate::common::random_shots::random_shots;
use hertzchain_chain::settle::{SlowPhase, State, settle};
use hertzchain_chain::wave::SolveError;
use hertzchain_chain::*;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Whatever a state may be: beads displaced by up to a micrometre or a
/// millimetre, at rest or not.
fn state(bodies: usize) -> impl Strategy<Value = State> {
    let size = prop_oneof![Just(0.0), Just(1e-6), Just(1e-3)];
    let places = prop::collection::vec(-1.0..1.0_f64, bodies);
    let speeds = prop::collection::vec(-1.0..1.0_f64, bodies);
    (size, prop_oneof![Just(0.0), Just(0.1)], places, speeds).prop_map(
        |(far, fast, places, speeds)| {
            let scaled = |values: Vec<f64>, by: f64| values.into_iter().map(|x| x * by).collect();
            State {
                displacement_m: scaled(places, far),
                velocity_m_s: scaled(speeds, fast),
                bridged: Vec::new(),
            }
        },
    )
}

/// One of a list of random chains, cut to a few beads, and a state of it.
fn chain_and_state() -> impl Strategy<Value = (Chain, State)> {
    let chains = random_shots(64);
    (0..chains.len(), 1..7_usize).prop_flat_map(move |(which, beads)| {
        let mut chain = chains[which].chain.clone();
        chain.beads.truncate(beads);
        chain.gaps.retain(|gap| gap.contact <= beads);
        chain.sections[0].contacts = 0..=beads;
        state(beads + 2).prop_map(move |state| (chain.clone(), state))
    })
}

fn slow() -> impl Strategy<Value = SlowPhase> {
    let friction = prop_oneof![Just(0.0), 0.0..0.2, 0.0..20.0];
    (friction, 0.002..0.25_f64, 1e-4..0.02_f64).prop_map(
        |(friction_coefficient, step, longest_s)| SlowPhase {
            friction_coefficient,
            step,
            longest_s,
            ..SlowPhase::default()
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(4),
        failure_persistence: None,
        ..ProptestConfig::with_cases(1000)
    })]

    #[test]
    fn random_chains_come_to_rest_or_say_why_not((chain, start) in chain_and_state(), slow in slow()) {
        let system = System::new(&chain).unwrap();
        let plastic = chain.sections[0].laws.iter().any(|law| law.info().name.contains("plastic"));
        let crushed = start.displacement_m.iter().any(|x| x.abs() > 1e-6);
        let mut state = start.clone();
        state.strike(&system, 0.2);
        match settle(&system, &mut state, &slow, &mut |_, _, _| {}) {
            Ok(rest) => {
                prop_assert!(state.velocity_m_s.iter().all(|&v| v == 0.0));
                prop_assert!(rest.gaps_m.iter().all(|gap| gap.is_finite() && *gap >= 0.0));
                // Without friction, what counts as still may creep on; and what a
                // plastic law remembers ends with the slow phase.
                if slow.friction_coefficient > 0.0 && !plastic {
                    let mut again = state.clone();
                    let rest = settle(&system, &mut again, &SlowPhase { longest_s: 1.0, ..slow }, &mut |_, _, _| {});
                    prop_assert_eq!(rest.unwrap().time_s, 0.0);
                    prop_assert_eq!(&again, &state);
                }
            }
            Err(SolveError::StillMoving { time_s, .. }) => prop_assert!(time_s >= slow.longest_s),
            // Beads that begin a millimetre within each other explode.
            Err(SolveError::TooManySteps { .. } | SolveError::Diverged(_)) => prop_assert!(crushed),
            Err(error) => prop_assert!(false, "{}", error),
        }
        let finite = state.displacement_m.iter().all(|x| x.is_finite());
        prop_assert!(!finite || system.from_state(&state).is_ok());
    }
}
