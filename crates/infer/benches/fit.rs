//! What a fit costs, and what builds on it: `bench/inference.md`.
//!
//! `cargo bench -p hertzchain-infer`; one thread (a million likelihoods: two), 25
//! speeds, both times of flight, η and B free and started a factor of three off.
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on should fail")]

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Truth, model, problem, speeds_m_s};
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use hertzchain_experiment::preset;
use hertzchain_infer::{
    Chain, Covariance, CurveProblem, Fit, Fitting, Problem, Profiling, Sampling, Surrogate, fit,
    profile,
};

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build_global();
    pool.unwrap();
    divan::main();
}

fn dry() -> CurveProblem {
    let experiment = preset("dry").unwrap();
    let truth = Truth::of(&experiment, &speeds_m_s(25));
    let dry = problem(&model(&experiment, &["eta", "B"]), truth.measured(1));
    let mut parameters = dry.parameters().to_vec();
    (parameters[0].start, parameters[1].start) = (1e4, 25.0);
    CurveProblem::new(dry.model().clone(), dry.data().clone(), parameters).unwrap()
}

fn fit_result(dry: &CurveProblem) -> (Fit, Covariance) {
    let best = fit(dry, &Fitting::default()).unwrap();
    let covariance = Covariance::new(dry.parameters(), &best);
    (best, covariance)
}

#[divan::bench]
fn fit_with_covariance(bencher: Bencher<'_, '_>) {
    let dry = dry();
    bencher.bench_local(|| fit_result(black_box(&dry)));
}

#[divan::bench(sample_count = 20)]
fn profiles_of_both(bencher: Bencher<'_, '_>) {
    let dry = dry();
    let (best, covariance) = fit_result(&dry);
    let how = Profiling::default();
    bencher.bench_local(|| profile(&dry, &best, &covariance, &[0, 1], &how).unwrap());
}

#[divan::bench(sample_count = 10)]
fn surrogate(bencher: Bencher<'_, '_>) {
    let dry = dry();
    let (best, covariance) = fit_result(&dry);
    bencher.bench_local(|| Surrogate::new(&dry, &best, &covariance).unwrap());
}

/// Walkers of one half step.
const POINTS: usize = 32;

fn likelihoods(bencher: Bencher<'_, '_>, problem: &dyn Problem, best: &Fit, sd: &[f64]) {
    let point = |n: usize| -> Vec<f64> {
        let aside = n as f64 / POINTS as f64 - 0.5;
        let pairs = best.point.iter().zip(sd);
        pairs.map(|(value, sd)| value + aside * sd).collect()
    };
    let points: Vec<Vec<f64>> = (0..POINTS).map(point).collect();
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| problem.residuals(black_box(&points)));
}

#[divan::bench]
fn likelihoods_of_the_model(bencher: Bencher<'_, '_>) {
    let dry = dry();
    let (best, covariance) = fit_result(&dry);
    likelihoods(bencher, &dry, &best, &covariance.sd);
}

#[divan::bench]
fn likelihoods_of_the_surrogate(bencher: Bencher<'_, '_>) {
    let dry = dry();
    let (best, covariance) = fit_result(&dry);
    let found = Surrogate::new(&dry, &best, &covariance).unwrap();
    likelihoods(bencher, &found, &best, &covariance.sd);
}

/// Numbers of the pump oil: five of its laws, and with three of the dry contacts eight.
const MANY: [&str; 6] =
    ["pump-oil.Y", "pump-oil.nu:power", "pump-oil.eta:power", "aisi316.Y", "aisi316.eta", "dry.B"];

fn pump(count: usize) -> CurveProblem {
    // Laws have two numbers each.
    let free = &MANY[..count - 2];
    let experiment = preset("pump").unwrap();
    let truth = Truth::of(&experiment, &speeds_m_s(25));
    problem(&model(&experiment, free), truth.measured(1))
}

/// Polynomials of many numbers, by two threads.
#[divan::bench(args = [5, 8], sample_count = 1)]
fn surrogate_of_many(bencher: Bencher<'_, '_>, count: usize) {
    let pump = pump(count);
    let (best, covariance) = fit_result(&pump);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
    let pool = pool.unwrap();
    bencher.bench_local(|| pool.install(|| Surrogate::new(&pump, &best, &covariance).unwrap()));
}

/// Their likelihoods, by one thread.
#[divan::bench(args = [5, 8], sample_count = 10)]
fn likelihoods_of_many(bencher: Bencher<'_, '_>, count: usize) {
    let pump = pump(count);
    let (best, covariance) = fit_result(&pump);
    let found = Surrogate::new(&pump, &best, &covariance).unwrap();
    eprintln!(
        "{count} numbers: right to {:.3} standard errors, computed at {:?} m/s",
        found.error,
        found.computed_speeds_m_s()
    );
    likelihoods(bencher, &found, &best, &covariance.sd);
}

/// Steps of 64 walkers that make a million.
const STEPS: u64 = 15_625;

/// A posterior's million, from the best fit to the last walker.
#[divan::bench(sample_count = 1)]
fn a_million_likelihoods_by_two_threads(bencher: Bencher<'_, '_>) {
    let dry = dry();
    let (best, covariance) = fit_result(&dry);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
    let pool = pool.unwrap();
    bencher.bench_local(|| {
        pool.install(|| {
            let found = Surrogate::new(&dry, &best, &covariance).unwrap();
            let how = Sampling::default();
            let mut chain = Chain::start(&found, &best, &covariance, &how).unwrap();
            chain.advance(&found, STEPS).unwrap();
            assert_eq!(chain.walkers() as u64 * chain.steps(), 1_000_000);
        });
    });
}
