//! Power-law fits against closed forms and against numpy's linear algebra.

use crate::signal::{FitError, PowerLaw, power_law, uncertainty};

const SPEEDS: [f64; 7] = [0.075, 0.1, 0.25, 0.5, 0.75, 1.0, 1.23];
const TIMES: [f64; 7] = [1086.9, 1020.3, 842.1, 741.7, 690.4, 655.0, 630.8];
const SIGMAS: [f64; 7] = [4.0, 3.5, 2.0, 1.5, 1.0, 1.0, 0.8];

/// Prefactor, exponent, their errors, covariance and R².
fn numbers(fit: &PowerLaw) -> [f64; 6] {
    [
        fit.prefactor,
        fit.exponent,
        fit.prefactor_error,
        fit.exponent_error,
        fit.covariance,
        fit.r_squared,
    ]
}

fn assert_close(found: [f64; 6], expected: [f64; 6]) {
    for (found, expected) in found.iter().zip(expected) {
        // Rounding of two different ways to solve the normal equations.
        assert!((found / expected - 1.0).abs() < 1e-10, "{found} for {expected}");
    }
}

#[test]
fn an_unweighted_fit_agrees_with_numpy() {
    let fit = power_law(&SPEEDS, &TIMES, None).unwrap();
    let numpy = [
        652.6064768890272,
        -0.19365702154819475,
        2.8720510173715184,
        0.0030536453312756504,
        9.395300470891653e-06,
        0.9987583444986164,
    ];
    assert_close(numbers(&fit), numpy);
    // As above; the residual itself is a difference of numbers around 7.
    assert!((fit.residuals[2] + 0.013541173783233162).abs() < 1e-13);
    assert!((fit.largest_deviation() - 0.013449904518298396).abs() < 1e-13);
}

#[test]
fn a_weighted_fit_agrees_with_numpy() {
    let fit = power_law(&SPEEDS, &TIMES, Some(&SIGMAS)).unwrap();
    let numpy = [
        654.2710665957313,
        -0.1900198689126218,
        0.5076443042137553,
        0.000929066898515084,
        3.3190926458050084e-07,
        0.9986043142632097,
    ];
    assert_close(numbers(&fit), numpy);
}

#[test]
fn an_exact_power_law_is_found_exactly() {
    let values = SPEEDS.map(|v| 630.0 * v.powf(-0.2));
    let fit = power_law(&SPEEDS, &values, None).unwrap();
    // Rounding of logarithms and powers.
    assert!((fit.exponent + 0.2).abs() < 1e-14);
    assert!((fit.prefactor / 630.0 - 1.0).abs() < 1e-14);
    assert!((fit.at(0.3) / (630.0 * 0.3_f64.powf(-0.2)) - 1.0).abs() < 1e-14);
    assert!(fit.exponent_error < 1e-14 && fit.r_squared > 1.0 - 1e-14);
}

#[test]
fn two_points_lie_on_their_law() {
    let fit = power_law(&[1.0, 4.0], &[3.0, 6.0], None).unwrap();
    // Rounding.
    assert!((fit.exponent - 0.5).abs() < 1e-15 && (fit.prefactor - 3.0).abs() < 1e-14);
    assert!(fit.exponent_error.is_nan());
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let lengths = power_law(&[1.0, 2.0], &[1.0], None).unwrap_err();
    assert!(lengths.to_string().starts_with("2 abscissas and 1 values"));
    assert_eq!(power_law(&[1.0, 1.0], &[1.0, 2.0], None), Err(FitError::TooFew));
    assert_eq!(power_law(&[1.0], &[1.0], None), Err(FitError::TooFew));
    assert_eq!(power_law(&[], &[], None), Err(FitError::TooFew));
    let not_positive = Err(FitError::NotPositive(1));
    assert_eq!(power_law(&[1.0, 2.0], &[1.0, -1.0], None), not_positive);
    assert_eq!(power_law(&[1.0, f64::NAN], &[1.0, 1.0], None), not_positive);
    assert_eq!(power_law(&[1.0, 2.0], &[1.0, 1.0], Some(&[1.0, 0.0])), not_positive);
}

#[test]
fn wrong_values_move_a_fit_by_no_more_than_their_errors_allow() {
    let relative = [1e-6, 3e-7, 2e-6, 5e-7, 1e-6, 4e-7, 1e-6];
    let allowed = uncertainty(&SPEEDS, &relative).unwrap();
    let exact = power_law(&SPEEDS, &TIMES, None).unwrap();
    let (mut farthest, mut steepest) = (0.0_f64, 0.0_f64);
    for signs in 0..1 << SPEEDS.len() {
        let mut values = TIMES;
        for (i, value) in values.iter_mut().enumerate() {
            let sign = if signs >> i & 1 == 1 { 1.0 } else { -1.0 };
            *value *= (sign * relative[i]).exp();
        }
        let fit = power_law(&SPEEDS, &values, None).unwrap();
        farthest = farthest.max((fit.prefactor / exact.prefactor).ln());
        steepest = steepest.max(fit.exponent - exact.exponent);
    }
    // The worst signs reach the bound; rounding is 1e-9 of an error of 1e-6.
    assert!((farthest / allowed.prefactor_relative - 1.0).abs() < 1e-7);
    assert!((steepest / allowed.exponent - 1.0).abs() < 1e-7);
}

#[test]
fn an_error_common_to_all_values_goes_to_the_prefactor() {
    let allowed = uncertainty(&SPEEDS, &[1e-6; 7]).unwrap();
    assert!(allowed.prefactor_relative >= 1e-6, "{allowed:?}");
    assert_eq!(uncertainty(&[1.0, 2.0], &[0.0; 2]).unwrap().exponent, 0.0);
    assert_eq!(uncertainty(&[1.0, 2.0], &[1e-6, f64::INFINITY]), Err(FitError::NotPositive(1)));
    assert_eq!(uncertainty(&[1.0], &[1e-6]), Err(FitError::TooFew));
}
