//! How often intervals hold the truth: the tables of `docs/inferring.md`.
//!
//! ```sh
//! cargo run --release -p hertzchain-infer --example coverage -- 500 50  # data sets, of them by posterior
//! ```
//!
//! Curves are computed a hundred times as accurately as a fit's and measured at
//! the paper's noise: 20 shots a speed, speeds ±0.003 m/s. Fits use a surrogate
//! of the model, whose error is printed in standard errors.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Truth, model, problem, speeds_m_s};
use hertzchain_experiment::preset;
use hertzchain_infer::{
    Chain, Covariance, Fit, Fitting, Problem, Profiling, Requirements, Sampling, Surrogate, fit,
    profile,
};
use std::error::Error;

/// A chain, what is free, and the true values.
type Case = (&'static str, &'static str, Vec<&'static str>, Vec<f64>);

fn main() -> Result<(), Box<dyn Error>> {
    let mut counts = std::env::args().skip(1).map(|text| text.parse::<usize>());
    let sets = counts.next().transpose()?.unwrap_or(500);
    let sampled = counts.next().transpose()?.unwrap_or(50);
    let wet_section = vec!["wet.K", "wet.A"];
    let cases: [Case; 3] = [
        ("dry pair", "dry", vec!["eta", "B"], vec![3.2e4, 77.0]),
        (
            "dry contacts",
            "hertz-viscoelastic",
            vec!["K", "A"],
            vec![8.792_630_379_6e9, 3.385_289_514_9e-7],
        ),
        ("wet section", "pump", wet_section, vec![9e9, 8e-7]),
    ];
    for case in cases {
        study(case, sets, sampled)?;
    }
    Ok(())
}

/// Shares of data sets whose intervals of 68 and 95 % hold the truth.
#[derive(Default)]
struct Held {
    of: usize,
    counts: [[usize; 2]; 2],
}

impl Held {
    fn count(&mut self, exact: &[f64], intervals: impl Fn(usize, usize) -> [f64; 2]) {
        self.of += 1;
        for (at, exact) in exact.iter().enumerate() {
            for level in 0..2 {
                let [lower, upper] = intervals(at, level);
                let held = lower <= *exact && *exact <= upper;
                self.counts[at][level] += usize::from(held);
            }
        }
    }

    fn told(&self) -> String {
        let share = |count: usize| count as f64 / self.of.max(1) as f64;
        let cells = self.counts.iter().flatten().map(|count| {
            let share = share(*count);
            let error = (share * (1.0 - share) / self.of.max(1) as f64).sqrt();
            format!("{:.1} ± {:.1}", 100.0 * share, 100.0 * error)
        });
        cells.collect::<Vec<_>>().join(" | ")
    }
}

fn study(
    (name, file, free, exact): Case,
    sets: usize,
    sampled: usize,
) -> Result<(), Box<dyn Error>> {
    let mut experiment = preset(file)?;
    let model = model(&experiment, &free);
    if file == "pump" {
        let paths = [
            ("contacts[1].laws.elastic_hertz.stiffness", exact[0]),
            (
                "contacts[1].laws.damping_viscoelastic.relaxation_time",
                exact[1],
            ),
        ];
        experiment = experiment.set(&paths)?;
    }
    let truth = Truth::of(&experiment, &speeds_m_s(25));
    let first = problem(&model, truth.measured(0));
    let best = fit(&first, &Fitting::default())?;
    let around = Covariance::new(first.parameters(), &best);
    let surrogate = Surrogate::new(&first, &best, &around)?;
    let [mut covariances, mut profiles, mut posteriors] =
        [Held::default(), Held::default(), Held::default()];
    for seed in 0..sets {
        let repeated = surrogate.with_data(truth.measured(1 + seed as u64))?;
        let best = fit(&repeated, &Fitting::default())?;
        let covariance = Covariance::new(repeated.parameters(), &best);
        covariances.count(&exact, |at, level| {
            let reach = [1.0, 1.959_964][level] * covariance.sd[at];
            [best.point[at] - reach, best.point[at] + reach]
        });
        by_profile(&repeated, &best, &covariance, &exact, &mut profiles)?;
        if seed < sampled {
            by_posterior(
                &repeated,
                (&best, &covariance),
                seed,
                &exact,
                &mut posteriors,
            )?;
        }
    }
    println!(
        "{name}: {} and {}; surrogate right to {:.3} standard errors",
        free[0], free[1], surrogate.error
    );
    println!(
        "| method | data sets | {0} 68 % | {0} 95 % | {1} 68 % | {1} 95 % |",
        free[0], free[1]
    );
    for (method, held) in [
        ("covariance", &covariances),
        ("profile", &profiles),
        ("posterior", &posteriors),
    ] {
        if held.of > 0 {
            println!("| {method} | {} | {} |", held.of, held.told());
        }
    }
    Ok(())
}

fn by_profile(
    problem: &Surrogate,
    best: &Fit,
    covariance: &Covariance,
    exact: &[f64],
    held: &mut Held,
) -> Result<(), Box<dyn Error>> {
    let found = profile(problem, best, covariance, &[0, 1], &Profiling::default())?;
    held.count(exact, |at, level| {
        let interval = found[at].intervals[level];
        let lower = interval.lower.closed().unwrap_or(f64::NEG_INFINITY);
        [lower, interval.upper.closed().unwrap_or(f64::INFINITY)]
    });
    Ok(())
}

fn by_posterior(
    problem: &Surrogate,
    (best, covariance): (&Fit, &Covariance),
    seed: usize,
    exact: &[f64],
    held: &mut Held,
) -> Result<(), Box<dyn Error>> {
    let how = Sampling {
        seed: seed as u64,
        ..Sampling::default()
    };
    let mut chain = Chain::start(problem, best, covariance, &how)?;
    let posterior = loop {
        match chain.posterior(&Requirements::default()) {
            Ok(posterior) => break posterior,
            Err(unconverged) => chain.advance(problem, unconverged.more_steps().max(300))?,
        }
    };
    held.count(exact, |at, level| {
        posterior.interval(at, [0.682_689, 0.95][level])
    });
    Ok(())
}
