use super::*;

#[test]
fn a_polynomial_through_its_own_samples_is_exact() {
    let of = |t: f64| 3.0 - 0.02 * (t - 30.3).powi(2) + 1e-4 * (t - 30.3).powi(3);
    let values: Vec<f64> = (0..40).map(|i| of(10.0 + f64::from(i))).collect();
    let fit = LocalPolynomial::through(&values, 10.0, 31.0, 12.0, 4).unwrap();
    // Rounding.
    assert!((fit.sample(fit.maximum().unwrap()) - 30.3).abs() < 1e-10);
    assert!(fit.residual < 1e-12);
}

#[test]
fn a_mean_has_the_variance_of_a_mean() {
    let values = [1.0; 11];
    let fit = LocalPolynomial::through(&values, 0.0, 5.0, 5.0, 1).unwrap();
    // At the centre a straight line is the mean of 11: rounding.
    assert!((fit.variances(0.0).value - 1.0 / 11.0).abs() < 1e-12);
    // Σ u² over −1, −0.8 … 1 is 4.4.
    assert!((fit.variances(0.0).slope - 1.0 / 4.4).abs() < 1e-12);
}

#[test]
fn too_few_samples_make_no_fit() {
    assert!(LocalPolynomial::through(&[1.0, 2.0], 0.0, 0.0, 5.0, 4).is_none());
    assert!(LocalPolynomial::through(&[1.0; 9], 0.0, 100.0, 5.0, 4).is_none());
    assert!(LocalPolynomial::through(&[1.0; 9], 0.0, f64::NAN, 5.0, 4).is_none());
}
