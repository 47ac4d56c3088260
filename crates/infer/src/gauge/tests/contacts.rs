use super::*;

#[test]
fn a_value_that_two_of_its_errors_wipe_out_is_not_told() {
    assert!(!is_told(11.8, 7.3));
    assert!(is_told(11.8, 5.8));
    assert!(!is_told(1.0, f64::INFINITY) && !is_told(1.0, f64::NAN));
}

/// Row's own and dry numbers' errors are independent: variances add.
#[test]
fn errors_of_a_pair_hold_those_of_the_dry_numbers() {
    let pair = Pair {
        ln: [0.0, 2.0_f64.ln()],
        own: [[9e-4, 0.0], [0.0, 25e-4]],
        shared: vec![[0.04, 0.12]],
    };
    let [(k, k_sd), (a, a_sd)] = pair.estimates();
    // Rounding.
    assert!((k - 1.0).abs() < 1e-15 && (k_sd - 0.05).abs() < 1e-15);
    assert!((a - 2.0).abs() < 1e-15 && (a_sd - 2.0 * 0.13).abs() < 1e-15);
    assert!((pair.covariance()[0][1] - 0.04 * 0.12).abs() < 1e-18);
}
