//! Residuals that are computed elsewhere.

use crate::common::{Truth, model, speeds_m_s};
use crate::toys::{Curve, decay, spaced};
use hertzchain_infer::{
    Batch, Chain, Covariance, CurveProblem, Fitting, Outcomes, Parameter, Problem, Sampling,
    Spread, fit,
};
use hertzchain_sim::Fingerprint;
use std::sync::atomic::{AtomicUsize, Ordering};

type Decay = Curve<fn(&[f64], f64) -> f64>;

fn toy() -> Decay {
    let free = vec![Parameter::new("height", "", 1.0), Parameter::new("rate", "", 1.0)];
    Curve::drawn(free, &spaced(0.0, 3.0, 9), 0.1, &[4.0, 0.8], 5, decay)
}

/// Batches in any order, as workers finish them.
fn backwards(problem: &dyn Problem, batches: &[Batch]) -> Vec<Outcomes> {
    let mut found: Vec<Outcomes> = batches.iter().rev().map(|b| b.outcomes(problem)).collect();
    found.reverse();
    found
}

#[test]
fn a_fit_and_a_chain_have_the_same_bits_whoever_computes_them() {
    let problem = toy();
    let name = Fingerprint::of_bytes(b"toy");
    let here = fit(&problem, &Fitting::default()).unwrap();
    let covariance = Covariance::new(problem.parameters(), &here);
    let how = Sampling::default();
    let mut chain = Chain::start(&problem, &here, &covariance, &how).unwrap();
    chain.advance(&problem, 40).unwrap();
    for size in [1, 7, 1000] {
        let compute = |batches: &[Batch]| Ok(backwards(&problem, batches));
        let spread = Spread::new(&problem, name, size, 1, &compute);
        let there = fit(&spread, &Fitting::default()).unwrap();
        assert_eq!(there.point, here.point);
        let mut other = Chain::start(&spread, &there, &covariance, &how).unwrap();
        other.advance(&spread, 40).unwrap();
        assert!(other == chain, "batches of {size}");
        assert_eq!(spread.failure(), None);
    }
}

#[test]
fn every_worker_has_a_batch_where_there_are_points_for_it() {
    let problem = toy();
    let points = vec![vec![4.0, 0.8]; 9];
    for (size, workers, batches) in [(32, 1, 1), (32, 2, 2), (32, 4, 3), (32, 20, 9), (2, 3, 5)] {
        let cut = AtomicUsize::new(0);
        let compute = |given: &[Batch]| {
            cut.store(given.len(), Ordering::Relaxed);
            Ok(backwards(&problem, given))
        };
        let spread = Spread::new(&problem, Fingerprint::of_bytes(b"toy"), size, workers, &compute);
        let found = spread.residuals(&points);
        assert_eq!(cut.into_inner(), batches, "{size} points, {workers} workers");
        let expected = problem.residuals(&points);
        for (one, other) in found.iter().zip(&expected) {
            let (one, other) = (one.as_ref().unwrap(), other.as_ref().unwrap());
            assert_eq!(one.standardised, other.standardised);
        }
    }
}

#[test]
fn batches_that_are_lost_for_good_are_told() {
    let problem = toy();
    let here = fit(&problem, &Fitting::default()).unwrap();
    let covariance = Covariance::new(problem.parameters(), &here);
    let calls = AtomicUsize::new(0);
    let compute = |batches: &[Batch]| match calls.fetch_add(1, Ordering::Relaxed) {
        0..=5 => Ok(backwards(&problem, batches)),
        _ => Err("no worker is left".to_owned()),
    };
    let spread = Spread::new(&problem, Fingerprint::of_bytes(b"toy"), 8, 1, &compute);
    let mut chain = Chain::start(&spread, &here, &covariance, &Sampling::default()).unwrap();
    chain.advance(&spread, 20).unwrap();
    assert_eq!(spread.failure(), Some("no worker is left"));
    // No user is asked in vain again.
    assert_eq!(calls.into_inner(), 7);
    let short = |batches: &[Batch]| Ok(batches.iter().map(|_| Vec::new()).collect());
    let spread = Spread::new(&problem, Fingerprint::of_bytes(b"toy"), 8, 1, &short);
    assert!(spread.residuals(&[vec![4.0, 0.8]])[0].is_err());
    assert!(spread.failure().unwrap().contains("other numbers"));
}

#[test]
fn a_batch_of_shots_has_the_bits_of_the_points_alone_and_a_name_of_its_inputs() {
    let dry = hertzchain_experiment::preset("dry").unwrap();
    let dry = dry.set(&[("beads[0].count", 12.0)]).unwrap();
    let truth = Truth::of(&dry, &speeds_m_s(5));
    let problem = |seed: u64, accuracy: f64| {
        let model = model(&dry, &["eta", "B"]).with_accuracy(accuracy);
        let parameters = model.numbers.parameters(&truth.speeds_m_s);
        CurveProblem::new(model, truth.measured(seed), parameters).unwrap()
    };
    let one = problem(1, 1e-5);
    let starts: Vec<f64> = one.parameters().iter().map(|p| p.start).collect();
    let points: Vec<Vec<f64>> =
        (0..5).map(|i| starts.iter().map(|x| x * (1.0 + 0.02 * f64::from(i))).collect()).collect();
    let together = one.residuals(&points);
    let names = |of: &CurveProblem, points: &[Vec<f64>]| {
        let batches = Batch::cut(&of.fingerprint(), points, 2);
        batches.iter().map(|batch| batch.name).collect::<Vec<_>>()
    };
    let batches = Batch::cut(&one.fingerprint(), &points, 2);
    assert_eq!(backwards(&one, &batches).concat(), together);
    let own = names(&one, &points);
    assert_eq!(own, names(&problem(1, 1e-5), &points));
    assert_ne!(own, names(&problem(2, 1e-5), &points));
    assert_ne!(own, names(&problem(1, 1e-6), &points));
    let mut moved = points.clone();
    moved[4][1] = moved[4][1].next_up();
    let other = names(&one, &moved);
    assert_eq!((other[0], other[1]), (own[0], own[1]));
    assert_ne!(other[2], own[2]);
}
