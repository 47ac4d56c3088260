//! Standard errors under a robust loss.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::toys::{Curve, normals, spaced, straight};
use hertzchain_infer::{Covariance, Fit, Fitting, Loss, Parameter, Prior, fit};

type Line = Curve<fn(&[f64], f64) -> f64>;

const HUBER: Loss = Loss::Huber { scale: 1.345 };
const SIGMA: f64 = 0.3;

/// A line through points with errors in standard errors.
fn line(errors: &[f64]) -> Line {
    let x = match errors.len() {
        2 => vec![0.0, 4.0],
        count => spaced(0.0, 4.0, count),
    };
    let y = x.iter().zip(errors);
    let y = y.map(|(x, e)| straight(&[5.0, -2.0], *x) + SIGMA * e);
    Curve {
        parameters: vec![Parameter::new("a", "m", 1.0), Parameter::new("b", "m/s", 1.0)],
        y: y.collect(),
        sigma: vec![SIGMA; x.len()],
        x,
        model: straight,
    }
}

fn fit_result(data: &Line, loss: Loss) -> (Fit, Covariance) {
    let how = Fitting { loss, ..Fitting::default() };
    let found = fit(data, &how).unwrap();
    let covariance = Covariance::new(&data.parameters, &found);
    (found, covariance)
}

/// Normal errors, of which one in ten by chance is eight times as large.
fn with_outliers(seed: u64, count: usize) -> Vec<f64> {
    let drawn = normals(seed, 2 * count);
    let (errors, chance) = drawn.split_at(count);
    // Beyond 1.2816 lies a tenth of a normal distribution.
    let far = |chance: f64| if chance > 1.2816 { 8.0 } else { 1.0 };
    (errors.iter().zip(chance)).map(|(e, chance)| far(*chance) * e).collect()
}

#[test]
fn without_outliers_or_freedom_errors_are_those_of_least_squares() {
    let lucky: Vec<f64> = normals(3, 12).iter().map(|e| 0.2 * e).collect();
    for errors in [lucky, vec![0.4, -1.1]] {
        let data = line(&errors);
        let (_, plain) = fit_result(&data, Loss::Squares);
        for scale in [1.345, 3.0] {
            for loss in [Loss::Huber { scale }, Loss::SoftL1 { scale }, Loss::Cauchy { scale }] {
                let (_, robust) = fit_result(&data, loss);
                assert_eq!(robust.loss_factor, 1.0, "{loss:?}");
                for (robust, plain) in robust.sd.iter().zip(&plain.sd) {
                    // Both Jacobians are exact but for rounding over their steps.
                    assert!((robust / plain - 1.0).abs() < 1e-8, "{loss:?}");
                }
            }
        }
    }
}

#[test]
fn a_prior_keeps_its_own_error_among_outliers() {
    let prior_sd = 1e-3;
    for seed in 0..20 {
        let mut data = line(&with_outliers(seed, 25));
        let (_, free) = fit_result(&data, HUBER);
        assert!(free.loss_factor >= 1.0);
        let known = Parameter::new("b", "m/s", -2.0);
        let prior = Prior::Normal { mean: -2.0, sd: prior_sd };
        data.parameters[1] = Parameter { prior, ..known };
        let (_, held) = fit_result(&data, HUBER);
        let (_, plain) = fit_result(&data, Loss::Squares);
        // The data's own error, some 0.05, determines next to nothing beside it: 2 (1e-3/0.05)².
        assert!((held.sd[1] / prior_sd - 1.0).abs() < 2e-3, "{}", held.sd[1]);
        // Weighing data otherwise than by their errors cannot make an estimate better.
        for at in 0..2 {
            assert!(held.sd[at] > plain.sd[at] * (1.0 - 1e-8), "{seed} {at}");
        }
        assert!(held.sd[0] < free.sd[0], "{seed}");
    }
}

#[test]
fn intervals_cover_the_truth_as_often_as_they_say_among_outliers() {
    let sets = 400;
    let mut within = [[0.0; 2]; 2];
    for seed in 0..sets {
        let (found, covariance) = fit_result(&line(&with_outliers(seed, 25)), HUBER);
        for (at, truth) in [5.0, -2.0].into_iter().enumerate() {
            let away = ((found.point[at] - truth) / covariance.sd[at]).abs();
            for (level, times) in [1.0, 1.96].into_iter().enumerate() {
                within[level][at] += f64::from(u8::from(away < times)) / sets as f64;
            }
        }
    }
    for (shares, nominal) in within.iter().zip([0.683_f64, 0.95]) {
        let chance = (nominal * (1.0 - nominal) / sets as f64).sqrt();
        for share in shares {
            // Three binomial errors, and two percent since the factor is known from 25
            // residuals alone.
            assert!((share - nominal).abs() < 3.0 * chance + 0.02, "{within:?}");
        }
    }
}
