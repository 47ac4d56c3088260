use super::*;

#[test]
fn a_value_that_two_of_its_errors_wipe_out_is_not_told() {
    assert!(!is_determined(11.8, 7.3));
    assert!(is_determined(11.8, 5.8));
    assert!(!is_determined(1.0, f64::INFINITY) && !is_determined(1.0, f64::NAN));
}

#[test]
fn errors_of_the_dry_numbers_are_allowed_for_where_no_pair_makes_up_for_them() {
    // No slopes: r = (0, 3), moved by (0, 1): variance 1 + 1.
    let flat = vec![vec![0.0, 0.0], vec![0.0, 0.0]];
    let allowed = allowing(&[0.0, 3.0], &flat, &[vec![0.0, 1.0]]);
    // Rounding.
    assert!((allowed - 9.0 / 2.0).abs() < 1e-12, "{allowed}");
    // A pair that changes by a little as the dry numbers do makes up for them.
    let steep = vec![vec![1e4, 0.0]];
    let rest = allowing(&[0.0, 3.0], &steep, &[vec![1.0, 0.0]]);
    assert!((rest - 9.0).abs() < 1e-6, "{rest}");
    assert!((allowing(&[1.0, 2.0], &flat, &[]) - 5.0).abs() < 1e-12);
}
