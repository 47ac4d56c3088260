use super::*;

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
