use super::*;

#[test]
fn probabilities_are_those_of_closed_forms() {
    // Two degrees of freedom: exp(−χ²/2). Both expansions; rounding.
    for x in [0.1, 1.0, 5.0, 40.0] {
        assert!((upper_gamma(1.0, x) / (-x).exp() - 1.0).abs() < 1e-13, "{x}");
    }
    // One degree: erfc(√(χ²/2)).
    for x in [0.2_f64, 1.0, 3.0, 12.0] {
        let expected = libm::erfc(x.sqrt());
        assert!((upper_gamma(0.5, x) / expected - 1.0).abs() < 1e-12, "{x}");
    }
}

#[test]
fn chi_square_counts_squares_of_deviations() {
    let point = |value| Estimate { value, sigma: 2.0 };
    let points = [point(1.0), point(4.0), point(9.0)];
    let found = chi_square(&points, &[3.0, 4.0, 5.0], 1).unwrap();
    assert_eq!((found.value, found.freedom), (5.0, 2));
    // exp(−5/2), rounding.
    assert!((found.probability - 0.082_084_998_623_898_8).abs() < 1e-14);
    assert!(chi_square(&points, &[3.0, 4.0], 0).is_none());
    assert!(chi_square(&points, &[3.0, 4.0, f64::NAN], 0).is_none());
    assert!(chi_square(&points, &[3.0, 4.0, 5.0], 3).is_none());
}
