//! Every instruction set gives the ensemble loop's numbers to rounding.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

mod common;
use common::ensemble::*;
use common::*;
use hertzchain_chain::ensemble::{Flown, Settings};
use hertzchain_chain::laws::{DampingTsuji, Law, law};
use hertzchain_chain::*;
use std::sync::Arc;

fn dry() -> Vec<Arc<dyn Law>> {
    vec![hertz(), viscoelastic(), cubic()]
}

fn tsuji() -> Vec<Arc<dyn Law>> {
    let tsuji = law(DampingTsuji {
        damping_ratio: 0.05,
        stiffness: None,
    });
    vec![hertz(), tsuji]
}

/// The same shots with the portable baseline and another set.
fn both(set: InstructionSet, chain: &Chain, (step, openings): (f64, bool)) -> [Flown; 2] {
    let baseline = InstructionSet::available().pop().unwrap();
    let system = System::new(chain).unwrap();
    [baseline, set].map(|set| {
        let settings = Settings {
            set,
            openings,
            ..settings(40)
        };
        fire_one(&system, (step, 1e-2), &settings)
    })
}

fn chains() -> [Chain; 4] {
    let push = Push::Constant { force_n: 1.0 };
    [
        row(40, 0.5, dry()),
        row(40, 0.5, vec![hertz()]),
        row(40, 0.5, tsuji()),
        Chain {
            push,
            ..row(40, 0.5, dry())
        },
    ]
}

#[test]
fn every_instruction_set_agrees_with_the_baseline() {
    let steps = [(0.14, false), (0.03, true)].into_iter();
    for (step, chain) in steps.flat_map(|step| chains().map(|chain| (step, chain))) {
        for set in InstructionSet::available() {
            let [baseline, other] = both(set, &chain, step);
            let name = set.name();
            assert_eq!(baseline.work.steps, other.work.steps, "{name}");
            let [one, two] = [&baseline, &other].map(|flown| passage(flown).unwrap());
            let tof = (0..2)
                .map(|i| (tofs(&two)[i] / tofs(&one)[i] - 1.0).abs())
                .fold(0.0, f64::max);
            let peak = [
                (one.incident.value, two.incident.value),
                (one.wall.value, two.wall.value),
                (one.reflected.unwrap().value, two.reflected.unwrap().value),
            ];
            let peak = peak
                .map(|(a, b)| (b / a - 1.0).abs())
                .into_iter()
                .fold(0.0, f64::max);
            let velocity = baseline.velocity_m_s.iter().zip(&other.velocity_m_s);
            let velocity = velocity.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / 0.5;
            // Rounding, which each opening that comes a rounding earlier or
            // later makes larger: measured 3e-14, 3e-13 and 3e-13.
            assert!(tof < 1e-12, "{name}: {tof:e}");
            assert!(peak < 1e-11, "{name}: {peak:e}");
            assert!(velocity < 1e-11, "{name}: {velocity:e}");
        }
    }
}
