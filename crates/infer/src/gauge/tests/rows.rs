use super::*;

#[test]
fn a_value_that_two_of_its_errors_wipe_out_is_not_told() {
    assert!(!is_determined(11.8, 7.3));
    assert!(is_determined(11.8, 5.8));
    assert!(!is_determined(1.0, f64::INFINITY) && !is_determined(1.0, f64::NAN));
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

#[test]
fn errors_of_the_dry_numbers_are_allowed_for_where_no_pair_makes_up_for_them() {
    // No slopes: r = (0, 3), moved by (0, 1): variance 1 + 1.
    let flat = vec![vec![0.0, 0.0], vec![0.0, 0.0]];
    let allowed = allowing(&[0.0, 3.0], &flat, &[vec![0.0, 1.0]]);
    // Rounding.
    assert!((allowed - 9.0 / 2.0).abs() < 1e-12, "{allowed}");
    // A pair that changes by a little as the dry numbers do makes up for them.
    let steep = vec![vec![1e6, 0.0], vec![0.0, 1e6]];
    let rest = allowing(&[0.0, 3.0], &steep, &[vec![0.0, 1.0]]);
    assert!((rest - 9.0).abs() < 1e-6, "{rest}");
    assert!((allowing(&[1.0, 2.0], &flat, &[]) - 5.0).abs() < 1e-12);
}
