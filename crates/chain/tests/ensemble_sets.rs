//! Every instruction set gives the ensemble loop's numbers to rounding.

use crate::common::ensemble::*;
use crate::common::*;
use hertzchain_chain::ensemble::{LaneResult, Precision, Settings};
use hertzchain_chain::laws::{DampingTsuji, Law, law};
use hertzchain_chain::observe::Passage;
use hertzchain_chain::*;
use std::sync::Arc;

fn dry() -> Vec<Arc<dyn Law>> {
    vec![hertz(), viscoelastic(), cubic()]
}

fn tsuji() -> Vec<Arc<dyn Law>> {
    let tsuji = law(DampingTsuji { damping_ratio: 0.05, stiffness: None });
    vec![hertz(), tsuji]
}

/// The same shots with the portable baseline and another set.
fn both(
    set: InstructionSet,
    precision: Precision,
    chain: &Chain,
    (step, openings): (f64, bool),
) -> [LaneResult; 2] {
    let baseline = InstructionSet::available().pop().unwrap();
    let system = System::new(chain).unwrap();
    [baseline, set].map(|set| {
        let settings = Settings { set, openings, ..settings(40) };
        fire_one_in(precision, &system, (step, 1e-2), &settings)
    })
}

fn chains() -> [Chain; 4] {
    let push = Push::Constant { force_n: 1.0 };
    [
        row(40, 0.5, dry()),
        row(40, 0.5, vec![hertz()]),
        row(40, 0.5, tsuji()),
        Chain { push, ..row(40, 0.5, dry()) },
    ]
}

/// Largest relative differences of times of flight and of peaks, and of
/// velocities at the end over the shot's.
fn differences([one, two]: &[LaneResult; 2]) -> [f64; 3] {
    let velocity = one.velocity_m_s.iter().zip(&two.velocity_m_s);
    let velocity = velocity.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / 0.5;
    let [one, two] = [one, two].map(|flown| passage(flown).unwrap());
    let peaks = |passage: &Passage| {
        let reflected = passage.reflected.unwrap().value;
        vec![passage.incident.value, passage.wall.value, reflected]
    };
    let largest = |one: Vec<f64>, two: Vec<f64>| {
        let pairs = one.iter().zip(&two);
        pairs.fold(0.0_f64, |most, (a, b)| most.max((b / a - 1.0).abs()))
    };
    [largest(tofs(&one).to_vec(), tofs(&two).to_vec()), largest(peaks(&one), peaks(&two)), velocity]
}

#[test]
fn every_instruction_set_agrees_with_the_baseline() {
    // Rounding, which each opening that comes a rounding earlier or later
    // makes larger: measured 4e-14, 2e-13 and 2e-13 in
    // double precision, 1.3e-6, 7e-6 and 9e-5 in single.
    let bounds =
        [(Precision::Double, [1e-12, 1e-11, 1e-11]), (Precision::Single, [5e-6, 5e-5, 5e-4])];
    let steps = [(0.14, false), (0.03, true)].into_iter();
    for (step, chain) in steps.flat_map(|step| chains().map(|chain| (step, chain))) {
        for set in InstructionSet::available() {
            for (precision, bounds) in bounds {
                let both = both(set, precision, &chain, step);
                let name = set.name();
                assert_eq!(both[0].work.steps, both[1].work.steps, "{name}");
                let differences = differences(&both);
                let within = differences.iter().zip(&bounds).all(|(d, bound)| d < bound);
                assert!(within, "{name}, {precision:?}: {differences:?}");
            }
        }
    }
}
