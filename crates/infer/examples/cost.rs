//! What a fit costs: the table of `bench/inference.md`.
//!
//! ```sh
//! cargo run --release -p hertzchain-infer --example cost
//! ```
//!
//! Times of one thread: best and median of several runs.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Truth, model, problem, speeds_m_s};
use hertzchain_experiment::preset;
use hertzchain_infer::{
    Chain, Covariance, Fitting, Problem, Profiling, Sampling, Speeds, Surrogate, fit, profile,
};
use std::error::Error;
use std::time::Instant;

/// Runs of each.
const RUNS: usize = 9;

fn main() -> Result<(), Box<dyn Error>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    pool.install(|| all().map_err(|error| error.to_string()))?;
    Ok(())
}

fn all() -> Result<(), Box<dyn Error>> {
    let dry = preset("dry")?;
    let speeds = speeds_m_s(25);
    let model = model(&dry, &["eta", "B"]);
    let mut problem = problem(&model, Truth::of(&dry, &speeds).measured(1));
    let far = [1e4, 20.0];
    let mut parameters = problem.parameters().to_vec();
    for (parameter, start) in parameters.iter_mut().zip(far) {
        parameter.start = start;
    }
    problem = hertzchain_infer::CurveProblem::new(model, problem.data().clone(), parameters)?;
    let best = fit(&problem, &Fitting::default())?;
    let covariance = Covariance::new(problem.parameters(), &best);
    let surrogate = Surrogate::new(&problem, &best, &covariance)?;
    println!("25 speeds, eta and B free, started a factor of three off; one thread");
    println!("| what | best | median |");
    told("25 shots at a fit's accuracy", || {
        let speeds = Speeds::of_rows(&speeds);
        problem
            .model()
            .curves(std::slice::from_ref(&best.point), &speeds)
            .len()
    });
    told("fit with covariance", || {
        let best = fit(&problem, &Fitting::default());
        best.map_or(0, |best| {
            Covariance::new(problem.parameters(), &best).sd.len() + best.evaluations
        })
    });
    println!("| (curves computed by it | {} | ) |", best.evaluations);
    told("profiles of both", || {
        let found = profile(&problem, &best, &covariance, &[0, 1], &Profiling::default());
        found.map_or(0, |found| found.len())
    });
    told("surrogate", || {
        Surrogate::new(&problem, &best, &covariance).map_or(0, |found| found.error as usize)
    });
    told("6,400 likelihoods of the surrogate", || {
        steps(&surrogate, &best, &covariance)
    });
    told("6,400 likelihoods of the model", || {
        steps(&problem, &best, &covariance)
    });
    Ok(())
}

/// A hundred steps of 64 walkers.
fn steps(problem: &dyn Problem, best: &hertzchain_infer::Fit, covariance: &Covariance) -> usize {
    let chain = Chain::start(problem, best, covariance, &Sampling::default());
    let Ok(mut chain) = chain else { return 0 };
    let led = chain.advance(problem, 100);
    led.map_or(0, |()| chain.walkers())
}

/// Best and median time of some runs.
fn told(what: &str, mut run: impl FnMut() -> usize) {
    let mut one = || {
        let begin = Instant::now();
        assert!(run() < usize::MAX);
        begin.elapsed().as_secs_f64()
    };
    let mut times: Vec<f64> = (0..RUNS).map(|_| one()).collect();
    times.sort_by(f64::total_cmp);
    let ms = |at: usize| 1e3 * times[at];
    println!("| {what} | {:.1} ms | {:.1} ms |", ms(0), ms(RUNS / 2));
}
