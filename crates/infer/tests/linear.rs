//! A straight line, where everything has a closed form.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::toys::{Curve, regression, spaced, straight};
use hertzchain_infer::{
    Covariance, Fitting, Goodness, Parameter, Prior, Profiling, RISE_OF_95_PERCENT, fit, profile,
};

type Line = Curve<fn(&[f64], f64) -> f64>;

fn line(seed: u64) -> Line {
    let free = vec![Parameter::new("a", "m", 1.0), Parameter::new("b", "m/s", 1.0)];
    Curve::drawn(free, &spaced(0.0, 4.0, 12), 0.3, &[5.0, -2.0], seed, straight)
}

#[test]
fn best_line_and_covariance_are_those_of_linear_regression() {
    let data = line(1);
    let found = fit(&data, &Fitting::default()).unwrap();
    let (best, expected) = regression(&data.x, &data.y, 0.3);
    let covariance = Covariance::new(&data.parameters, &found);
    for (i, expected) in expected.iter().enumerate() {
        // The tolerance on χ²/2, 1e-9, leaves 4e-5 standard errors.
        assert!((found.point[i] - best[i]).abs() < 5e-5 * covariance.sd[i]);
        for (j, expected) in expected.iter().enumerate() {
            // Rounding of differences over 0.3 standard errors: 1e-15/1e-3.
            let ratio = covariance.matrix[i][j] / expected;
            assert!((ratio - 1.0).abs() < 1e-10, "{i} {j} {ratio}");
        }
    }
    assert!(found.ending.converged());
    // A line's differences are exact but for rounding.
    assert!(found.jacobian.worst_disagreement() < 1e-10);
}

#[test]
fn profiles_of_a_line_are_parabolas_with_the_covariance_widths() {
    let data = line(2);
    let found = fit(&data, &Fitting::default()).unwrap();
    let covariance = Covariance::new(&data.parameters, &found);
    let profiles = profile(&data, &found, &covariance, &[0, 1], &Profiling::default()).unwrap();
    for profile in &profiles {
        let (sd, best) = (covariance.sd[profile.parameter], found.point[profile.parameter]);
        for (interval, factor) in profile.intervals.iter().zip([1.0, RISE_OF_95_PERCENT.sqrt()]) {
            let [lower, upper] = [interval.lower, interval.upper].map(|e| e.closed().unwrap());
            // 1e-3 standard errors: the ends are found to no more.
            assert!(((upper - best) / sd - factor).abs() < 1e-3);
            assert!(((best - lower) / sd - factor).abs() < 1e-3);
        }
        for (value, rise) in profile.values.iter().zip(&profile.rise) {
            let expected = ((value - best) / sd).powi(2);
            // The optimum's own 4e-5 standard errors, doubled by the slope of the parabola.
            assert!((rise - expected).abs() < 1e-3, "{value} {rise} {expected}");
        }
        assert!(profile.values.is_sorted());
    }
}

#[test]
fn a_prior_counts_as_a_further_measurement() {
    let mut data = line(3);
    let (mean, sd) = (-1.5, 0.05);
    data.parameters[1].prior = Prior::Normal { mean, sd };
    data.parameters[1].start = -1.5;
    let found = fit(&data, &Fitting::default()).unwrap();
    let covariance = Covariance::new(&data.parameters, &found);
    let (best, alone) = regression(&data.x, &data.y, 0.3);
    // Marginally, weights of both add.
    let weights = [alone[1][1].recip(), (sd * sd).recip()];
    let expected = (weights[0] * best[1] + weights[1] * mean) / (weights[0] + weights[1]);
    let width = (weights[0] + weights[1]).recip().sqrt();
    // As above: 4e-5 standard errors; rounding.
    assert!((found.point[1] - expected).abs() < 5e-5 * width);
    assert!((covariance.sd[1] / width - 1.0).abs() < 1e-9);
    let goodness = Goodness::new(&data, &found);
    assert_eq!(goodness.chi_square.unwrap().freedom, 11);
}

#[test]
fn bounds_that_bind_are_named_and_the_rest_is_the_restricted_optimum() {
    let mut data = line(4);
    data.parameters[1] = data.parameters[1].clone().within(-1.0, 3.0);
    let found = fit(&data, &Fitting::default()).unwrap();
    assert_eq!(found.point[1], -1.0);
    let [binding] = found.binding[..] else { panic!("one bound binds: {:?}", found.binding) };
    assert_eq!((binding.parameter, binding.bound), (1, -1.0));
    let covariance = Covariance::new(&data.parameters, &found);
    assert_eq!(covariance.held, [1]);
    // With the slope held, the intercept is a mean of 12. Rounding.
    assert!((covariance.sd[0] - 0.3 / 12_f64.sqrt()).abs() < 1e-10);
    let mean = data.y.iter().zip(&data.x).map(|(y, x)| y + x).sum::<f64>() / 12.0;
    assert!((found.point[0] - mean).abs() < 5e-5 * covariance.sd[0]);
}
