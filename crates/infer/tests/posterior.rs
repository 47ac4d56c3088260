//! The sampler against distributions that are known.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::toys::{Curve, decay, regression, spaced, straight};
use hertzchain_infer::{
    Chain, Covariance, Fit, Fitting, InferError, ModelError, Parameter, Posterior, Prior, Problem,
    Requirements, Residuals, Sampling, fit,
};
use hertzchain_measure::signal::coverage;

fn started(problem: &dyn Problem, how: &Sampling) -> (Fit, Covariance, Chain) {
    let found = fit(problem, &Fitting::default()).unwrap();
    let covariance = Covariance::new(problem.parameters(), &found);
    let chain = Chain::start(problem, &found, &covariance, how).unwrap();
    (found, covariance, chain)
}

type Line = Curve<fn(&[f64], f64) -> f64>;

fn line() -> Line {
    let free = vec![Parameter::new("a", "m", 1.0), Parameter::new("b", "m/s", 1.0)];
    Curve::drawn(free, &spaced(0.0, 4.0, 12), 0.3, &[5.0, -2.0], 1, straight)
}

/// Standard error of a mean from a finite chain: σ/√(effective samples).
fn mean_error(of: &Posterior, parameter: usize) -> f64 {
    of.sd(parameter) / of.diagnoses[parameter].effective.sqrt()
}

#[test]
fn posterior_of_a_line_has_the_mean_and_covariance_of_linear_regression() {
    for differential_share in [0.0, 0.5, 1.0] {
        let data = line();
        let how = Sampling { differential_share, walkers: 16, seed: 3, ..Sampling::default() };
        let (_, _, mut chain) = started(&data, &how);
        chain.advance(&data, 8000).unwrap();
        let found = chain.posterior(&Requirements::default()).unwrap();
        let (best, covariance) = regression(&data.x, &data.y, 0.3);
        for i in 0..2 {
            // Four standard errors of a mean of so many effective samples.
            let error = mean_error(&found, i);
            assert!((found.mean[i] - best[i]).abs() < 4.0 * error, "{differential_share}");
            let effective = found.diagnoses[i].effective;
            for j in 0..2 {
                // Standard error of a covariance: √(2/n) of √(CᵢᵢCⱼⱼ) at most.
                let size = (covariance[i][i] * covariance[j][j]).sqrt();
                let off = (found.covariance[i][j] - covariance[i][j]) / size;
                assert!(off.abs() < 4.0 * (2.0 / effective).sqrt(), "{differential_share} {off}");
            }
            let sd = covariance[i][i].sqrt();
            for (share, z) in [(0.025, -1.959_964), (0.16, -0.994_458), (0.5, 0.0)] {
                let off = (found.quantile(i, share) - best[i]) / sd - z;
                // Standard error √(p(1 − p)/n)/density: up to 2.7/√n at 2.5 %.
                assert!(off.abs() < 4.0 * 2.7 / effective.sqrt(), "{share} {off}");
            }
        }
        assert!((0.2..0.9).contains(&chain.acceptance()), "{}", chain.acceptance());
    }
}

#[test]
fn posterior_of_a_bent_valley_is_the_transformed_normal() {
    // b = a², a normal around 1 with σ 0.3, as in the profiles' test.
    let data = Curve {
        parameters: vec![Parameter::new("a", "", 1.0), Parameter::new("b", "", 1.0)],
        x: vec![0.0, 1.0],
        y: vec![1.0, 0.0],
        sigma: vec![0.3, 0.05],
        model: |p: &[f64], x: f64| if x == 0.0 { p[0] } else { p[1] - p[0] * p[0] },
    };
    let (_, _, mut chain) =
        started(&data, &Sampling { walkers: 24, seed: 5, ..Sampling::default() });
    chain.advance(&data, 10_000).unwrap();
    let found = chain.posterior(&Requirements::default()).unwrap();
    // Mean 1 + 0.09 and variance 2·0.09² + 4·0.09 + 0.05², exactly.
    assert!((found.mean[1] - 1.09).abs() < 4.0 * mean_error(&found, 1));
    let variance = 2.0 * 0.09 * 0.09 + 4.0 * 0.09 + 0.0025;
    // Heavier tail than a normal's: kurtosis below 4, √(3/n).
    let effective = found.diagnoses[1].effective;
    assert!((found.covariance[1][1] / variance - 1.0).abs() < 4.0 * (3.0 / effective).sqrt());
    // Median of b: that of a², a folded normal with next to nothing below 0; the
    // valley's 0.05 shifts it by less than 0.05²/0.6. Standard error 1.25 sd/√n.
    let off = found.quantile(1, 0.5) - 1.0;
    assert!(off.abs() < 4.0 * 1.25 * 0.6 / effective.sqrt() + 0.004, "{off}");
}

#[test]
fn bounds_and_log_normal_priors_shape_the_posterior() {
    // No data to speak of: the prior itself, a density over θ.
    let mut free =
        vec![Parameter::new("a", "", 2.0), Parameter::new("b", "", 0.1).within(0.0, 1.0)];
    free[0].prior = Prior::LogNormal { median: 2.0, ln_sd: 0.5 };
    let data = Curve {
        parameters: free,
        x: vec![0.0],
        y: vec![0.0],
        sigma: vec![1e3],
        model: |p: &[f64], _: f64| p[0] + p[1],
    };
    let (_, _, mut chain) = started(&data, &Sampling { seed: 8, ..Sampling::default() });
    chain.advance(&data, 8000).unwrap();
    let found = chain.posterior(&Requirements::default()).unwrap();
    let root = |k: usize| found.diagnoses[k].effective.sqrt();
    // Median 2 and 84.13 % at 2 e^½ of a log-normal; 4 standard errors.
    assert!((found.quantile(0, 0.5).ln() - 2.0_f64.ln()).abs() < 4.0 * 0.63 / root(0));
    let upper = found.quantile(0, 0.841_344_7).ln() - 2.0_f64.ln();
    assert!((upper - 0.5).abs() < 4.0 * 0.76 / root(0), "{upper}");
    // b is uniform.
    assert!((found.mean[1] - 0.5).abs() < 4.0 * mean_error(&found, 1));
    assert!((found.covariance[1][1] - 1.0 / 12.0).abs() < 4.0 * 0.0745 / root(1));
    let [low, high] = found.interval(1, 1.0);
    assert!(low >= 0.0 && high <= 1.0);
}

#[test]
fn posterior_intervals_hold_the_truth_as_often_as_they_say() {
    let truth = [1.0, 0.7];
    let mut held = [Vec::new(), Vec::new()];
    for seed in 0..60 {
        let free = vec![Parameter::new("a", "", 1.3), Parameter::new("k", "", 0.5)];
        let data = Curve::drawn(free, &spaced(0.0, 4.0, 12), 0.05, &truth, 1000 + seed, decay);
        let how = Sampling { walkers: 16, ensembles: 1, seed, ..Sampling::default() };
        let (_, _, mut chain) = started(&data, &how);
        chain.advance(&data, 3000).unwrap();
        let found = chain.posterior(&Requirements::default()).unwrap();
        for (held, share) in held.iter_mut().zip([0.682_689_5, 0.95]) {
            let [lower, upper] = found.interval(1, share);
            let inside = lower <= truth[1] && truth[1] <= upper;
            held.push(if inside { 0.0 } else { f64::NAN });
        }
    }
    for (held, factor) in held.iter().zip([1.0, 1.959_964]) {
        let found = coverage(held, factor).unwrap();
        // Binomial chance of 60 sets, at fixed seeds.
        let off = (found.share - found.expected) / found.chance;
        assert!(off.abs() < 3.0, "{:.3} of {:.3}", found.share, found.expected);
    }
}

#[test]
fn short_chains_give_no_quantiles_but_say_how_many_steps_would_do() {
    let data = line();
    let how = Sampling { walkers: 16, seed: 3, ..Sampling::default() };
    let (_, _, mut chain) = started(&data, &how);
    for steps in [0, 3, 150] {
        chain.advance(&data, steps).unwrap();
        let missing = chain.posterior(&Requirements::default()).unwrap_err();
        assert!(missing.more_steps() > 0);
        assert!(missing.to_string().contains("has not converged"), "{missing}");
    }
    // What it asks for is enough, within three rounds.
    let mut rounds = 0;
    while let Err(missing) = chain.posterior(&Requirements::default()) {
        chain.advance(&data, missing.more_steps()).unwrap();
        rounds += 1;
    }
    assert!(rounds <= 3, "{rounds}");
    assert!(chain.steps() < 20_000, "{}", chain.steps());
}

#[test]
fn a_chain_saved_and_continued_has_the_bits_of_an_uninterrupted_one() {
    let data = line();
    let how = Sampling { walkers: 8, seed: 11, keep_every: 3, ..Sampling::default() };
    let (_, _, mut whole) = started(&data, &how);
    let mut part = whole.clone();
    whole.advance(&data, 100).unwrap();
    part.advance(&data, 41).unwrap();
    let text = serde_json::to_string(&part).unwrap();
    let mut read: Chain = serde_json::from_str(&text).unwrap();
    read.advance(&data, 59).unwrap();
    assert_eq!(read, whole);
    // Damaged files and other parameters are refused.
    let huge = u64::MAX.to_string();
    let changed = |from: &str, to: &str| text.replacen(from, to, 1);
    // The last number of the file.
    let (before, _) = text.split_once("\"failed\":").unwrap();
    for cut in [
        changed("\"steps\":41", "\"steps\":57"),
        changed("\"steps\":41", &format!("\"steps\":{huge}")),
        changed("\"ensembles\":2", &format!("\"ensembles\":{huge}")),
        format!("{before}\"failed\":{huge}}}"),
    ] {
        assert_ne!(cut, text);
        let mut damaged: Chain = serde_json::from_str(&cut).unwrap();
        let error = damaged.advance(&data, 1).unwrap_err().to_string();
        assert!(error.starts_with("the saved chain is damaged"), "{error}");
    }
    let mut other = line();
    other.parameters[1].name = "c".into();
    let error = read.advance(&other, 1).unwrap_err().to_string();
    assert!(error.contains("the same free parameters"), "{error}");
}

/// Why a chain was broken off: its state where it was killed, or an error.
#[derive(Debug)]
struct Broken(String);

impl From<InferError> for Broken {
    fn from(error: InferError) -> Self {
        Self(error.to_string())
    }
}

#[test]
fn a_run_that_is_killed_anywhere_and_continued_ends_like_one_that_was_not() {
    let data = line();
    let (_, _, begun) = started(&data, &Sampling::default());
    let asked = Requirements::default();
    let mut whole = begun.clone();
    let unbroken = whole.lead(&data, &asked, 20_000, &mut |_| Ok::<(), Broken>(()));
    let unbroken = unbroken.unwrap().unwrap();
    for dies_at in [130, 500, 510] {
        assert!(dies_at < whole.steps());
        let mut part = begun.clone();
        let killed =
            part.lead(&data, &asked, 20_000, &mut |chain| match chain.steps() == dies_at {
                true => Err(Broken(serde_json::to_string(chain).unwrap())),
                false => Ok(()),
            });
        let Err(Broken(saved)) = killed else { unreachable!("{killed:?}") };
        let mut read: Chain = serde_json::from_str(&saved).unwrap();
        read.belongs_to(&data).unwrap();
        let continued = read.lead(&data, &asked, 20_000, &mut |_| Ok::<(), Broken>(()));
        assert_eq!(continued.unwrap().unwrap(), unbroken);
        assert_eq!(read, whole);
    }
    // No user goes on with other data by accident.
    let mut other = line();
    other.y[0] += 1.0;
    let error = whole.belongs_to(&other).unwrap_err().to_string();
    assert!(error.starts_with("the chain was sampled from other data"), "{error}");
}

/// A line whose residuals are computed by as many threads as there are.
struct Threaded(Line);

impl Problem for Threaded {
    fn parameters(&self) -> &[Parameter] {
        self.0.parameters()
    }
    fn residual_count(&self) -> usize {
        self.0.residual_count()
    }
    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>> {
        use rayon::prelude::*;
        let one = |point: &Vec<f64>| self.0.residuals(std::slice::from_ref(point)).remove(0);
        points.par_iter().map(one).collect()
    }
}

#[test]
fn fits_profiles_and_chains_have_equal_bits_whatever_the_threads() {
    let results = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let problem = Threaded(line());
            let (found, covariance, mut chain) = started(&problem, &Sampling::default());
            chain.advance(&problem, 50).unwrap();
            let how = hertzchain_infer::Profiling::default();
            let profiles =
                hertzchain_infer::profile(&problem, &found, &covariance, &[0, 1], &how).unwrap();
            (found, profiles, chain)
        })
    };
    assert_eq!(results(1), results(4));
}

#[test]
fn walkers_start_inside_bounds_even_where_a_bound_binds() {
    let mut data = line();
    let (best, covariance) = regression(&data.x, &data.y, 0.3);
    let sd = covariance[1][1].sqrt();
    let (z, bound) = (0.5_f64, best[1] + 0.5 * sd);
    data.parameters[1] = data.parameters[1].clone().within(bound, 3.0);
    let (found, _, mut chain) = started(&data, &Sampling { seed: 2, ..Sampling::default() });
    assert_eq!(found.binding.len(), 1);
    chain.advance(&data, 6000).unwrap();
    let posterior = chain.posterior(&Requirements::default()).unwrap();
    assert!(posterior.interval(1, 1.0)[0] >= bound);
    // A normal cut off at a bound z = (bound − mean)/σ away has its mean at
    // mean + σ φ(z)/(1 − Φ(z)).
    let density = (-0.5 * z * z).exp() / (2.0 * std::f64::consts::PI).sqrt();
    // The share of a normal beyond z, from the share within ± z.
    let beyond = 0.5 * (1.0 - coverage(&[0.0], z).unwrap().expected);
    let mean = best[1] + sd * density / beyond;
    assert!((posterior.mean[1] - mean).abs() < 4.0 * mean_error(&posterior, 1));
}

#[test]
fn sampling_options_out_of_range_are_refused() {
    let data = line();
    let found = fit(&data, &Fitting::default()).unwrap();
    let covariance = Covariance::new(&data.parameters, &found);
    let wrong = [
        Sampling { walkers: 7, ..Sampling::default() },
        Sampling { walkers: 2, ..Sampling::default() },
        Sampling { ensembles: 0, ..Sampling::default() },
        Sampling { keep_every: 0, ..Sampling::default() },
        Sampling { differential_share: 1.5, ..Sampling::default() },
    ];
    for how in wrong {
        let error = Chain::start(&data, &found, &covariance, &how).unwrap_err();
        assert!(error.to_string().contains("expected"), "{error}");
    }
}
