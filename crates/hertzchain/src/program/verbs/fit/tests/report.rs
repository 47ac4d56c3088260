use super::*;

#[test]
fn far_too_many_runs_have_small_p_values_as_have_far_too_few() {
    let reported = |residuals: &[f64]| hertzchain_infer::runs(residuals).map(runs_text);
    let alternating: Vec<f64> = (0..20).map(|at| f64::from(1 - 2 * (at % 2))).collect();
    let many = reported(&alternating).unwrap_or_default();
    assert!(many.ends_with("(20 runs, 11 expected)"), "{many}");
    assert!(many.starts_with("runs test: p = ") && many.contains("e-"), "{many}");
    let (above, below) = ([1.0; 10], [-1.0; 10]);
    let few = reported(&[above, below].concat()).unwrap_or_default();
    assert!(few.contains("e-") && few.ends_with("(2 runs, 11 expected)"), "{few}");
}
