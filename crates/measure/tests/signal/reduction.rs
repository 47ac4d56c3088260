//! From shots to curves.

use crate::signal::{
    Estimate, FitError, Point, coverage, groups, power_law, power_law_both_errors,
    ratios_at_common, summary,
};

const SPEEDS: [f64; 7] = [0.075, 0.1, 0.25, 0.5, 0.75, 1.0, 1.23];
const TIMES: [f64; 7] = [1086.9, 1020.3, 842.1, 741.7, 690.4, 655.0, 630.8];
const SIGMAS: [f64; 7] = [4.0, 3.5, 2.0, 1.5, 1.0, 1.0, 0.8];

fn estimate(value: f64, sigma: f64) -> Estimate {
    Estimate { value, sigma }
}

#[test]
fn errors_in_both_coordinates_agree_with_orthogonal_distance_regression() {
    let fit = power_law_both_errors(&SPEEDS, &[0.003; 7], &TIMES, &SIGMAS).unwrap();
    // scipy.odr 1.17.1: RealData(ln v, ln t, sx=0.003/v, sy=σ/t), cov_beta unscaled.
    let odr = [
        (fit.prefactor, 654.662197288576),
        (fit.exponent, -0.18658670869982238),
        (fit.prefactor_error, 0.5514819744700117),
        (fit.exponent_error, 0.0014449123429726987),
        (fit.covariance, 4.437786799387866e-07),
    ];
    for (i, (found, expected)) in odr.into_iter().enumerate() {
        // Values: ODRPACK's stopping. Errors: its linearisation is about its own
        // estimates of the abscissas.
        let allowed = if i < 2 { 1e-7 } else { 2e-3 };
        assert!((found / expected - 1.0).abs() < allowed, "{i}: {found} {expected}");
    }
}

#[test]
fn a_fit_says_whether_its_points_follow_the_law_within_their_errors() {
    let speeds = SPEEDS.map(|v| 0.003 / v);
    let fit = power_law_both_errors(&SPEEDS, &[0.003; 7], &TIMES, &SIGMAS).unwrap();
    let evaluated = fit.chi_square.unwrap();
    // Its definition: Σ (ln t − ln law)² over the variance across the line. Rounding.
    let pulls = (0..7).map(|i| {
        let across = (SIGMAS[i] / TIMES[i]).hypot(fit.exponent * speeds[i]);
        (fit.residuals[i] / across).powi(2)
    });
    assert!((evaluated.value / pulls.sum::<f64>() - 1.0).abs() < 1e-12);
    assert_eq!(evaluated.freedom, 5);
    // These points bend: with errors a tenth as large no power law is left.
    let sharp = power_law_both_errors(&SPEEDS, &[0.0; 7], &TIMES, &SIGMAS.map(|s| 0.1 * s));
    let sharp = sharp.unwrap();
    assert_eq!(sharp.is_supported(), Some(false), "{sharp:?}");
    let reduced = sharp.chi_square.unwrap().value / 5.0;
    assert!((sharp.excess() / reduced.sqrt() - 1.0).abs() < 1e-12);
    let straight = SPEEDS.map(|v| 655.0 * v.powf(-0.19));
    let fit = power_law(&SPEEDS, &straight, Some(&SIGMAS)).unwrap();
    assert_eq!((fit.is_supported(), fit.excess()), (Some(true), 1.0));
    // Errors from the scatter itself, and two points, evaluate nothing.
    let free = power_law(&SPEEDS, &TIMES, None).unwrap();
    assert_eq!(free.is_supported(), None);
    let two = power_law(&SPEEDS[..2], &TIMES[..2], Some(&SIGMAS[..2])).unwrap();
    assert_eq!(two.chi_square, None);
}

#[test]
fn what_cannot_be_fitted_with_both_errors_is_refused() {
    let fit = |v: &[f64], sv: &[f64], t: &[f64], st: &[f64]| power_law_both_errors(v, sv, t, st);
    let one = [1.0, 2.0];
    assert_eq!(fit(&[1.0, 1.0], &one, &one, &one), Err(FitError::TooFew));
    assert_eq!(fit(&[], &[], &[], &[]), Err(FitError::TooFew));
    assert_eq!(fit(&[1.0], &[0.1], &[1.0], &[0.1]), Err(FitError::TooFew));
    let index = FitError::NotPositive(1);
    assert_eq!(fit(&one, &[0.1, -0.1], &one, &one), Err(index.clone()));
    assert_eq!(fit(&one, &one, &[1.0, f64::NAN], &one), Err(index));
    assert!(matches!(fit(&one, &[0.1], &one, &one), Err(FitError::Lengths { .. })));
}

#[test]
fn a_summary_is_mean_deviation_and_errors_by_hand() {
    let found = summary(&[estimate(1.0, 1.0), estimate(3.0, 1.0), estimate(8.0, 2.0)]).unwrap();
    // Mean 4, squares 9 + 1 + 16; weights 1, 1, 1/4: 6/2.25. Rounding.
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
    close(found.mean, 4.0);
    close(found.deviation, 13.0_f64.sqrt());
    close(found.error, (13.0_f64 / 3.0).sqrt());
    close(found.weighted.value, 6.0 / 2.25);
    close(found.weighted.sigma, 2.25_f64.powf(-0.5));
    let m: f64 = 6.0 / 2.25;
    close(found.chi_square, (1.0 - m).powi(2) + (3.0 - m).powi(2) + (8.0 - m).powi(2) / 4.0);
}

#[test]
fn a_summary_of_one_or_of_nonsense_is_honest() {
    let one = summary(&[estimate(5.0, 0.1), estimate(f64::NAN, 1.0)]).unwrap();
    assert_eq!((one.count, one.mean, one.error), (1, 5.0, 0.1));
    assert!(one.deviation.is_nan());
    assert!(summary(&[]).is_none());
    let exact = summary(&[estimate(1.0, 0.0), estimate(2.0, 0.0)]).unwrap();
    assert_eq!(exact.weighted, estimate(exact.mean, exact.error));
}

#[test]
fn shots_of_one_speed_come_together_whatever_their_order() {
    let speeds = [0.503, 0.1, 0.499, f64::NAN, 0.101, 1.0];
    assert_eq!(groups(&speeds, 0.01), [vec![1, 4], vec![2, 0], vec![5]]);
    assert!(groups(&[], 0.1).is_empty());
}

#[test]
fn a_ratio_carries_the_errors_of_both_and_of_their_speeds() {
    let point =
        |v: f64, t: f64| Point { speed: estimate(v, 0.01 * v), value: estimate(t, 0.003 * t) };
    let at = |v: f64, factor: f64| point(v, factor * v.powf(-0.2));
    let wet = [at(0.505, 1.04), at(0.9, 1.0)];
    let dry = [at(0.3, 1.0), at(0.5, 1.0)];
    let found = ratios_at_common(&wet, &dry, 0.01, -0.2);
    assert_eq!(found.len(), 1);
    // Speeds' difference is taken out exactly: rounding.
    assert!((found[0].ratio.value - 1.04).abs() < 1e-12);
    let relative = (2.0 * 0.003_f64.powi(2) + 2.0 * (0.2 * 0.01_f64).powi(2)).sqrt();
    assert!((found[0].ratio.sigma / 1.04 - relative).abs() < 1e-12);
    assert!(ratios_at_common(&wet, &[], 1.0, 0.0).is_empty());
}

#[test]
fn coverage_counts_what_lies_inside() {
    let found = coverage(&[0.5, -0.9, 1.1, 3.0, f64::NAN], 1.0).unwrap();
    assert_eq!((found.inside, found.count), (2, 5));
    // erf(1/√2), rounding.
    assert!((found.expected - 0.682_689_492_137_085_9).abs() < 1e-12);
    assert!(coverage(&[], 1.0).is_none());
}
