use super::*;

#[test]
fn far_too_many_runs_are_told_as_well_as_far_too_few() {
    let told = |residuals: &[f64]| hertzchain_infer::runs(residuals).map(runs_text);
    let alternating: Vec<f64> = (0..20).map(|at| f64::from(1 - 2 * (at % 2))).collect();
    let many = told(&alternating).unwrap_or_default();
    assert!(
        many.contains("20 runs of equal sign, 11 expected: as many or more in"),
        "{many}"
    );
    assert!(many.contains("oddly often"), "{many}");
    let (above, below) = ([1.0; 10], [-1.0; 10]);
    let few = told(&[above, below].concat()).unwrap_or_default();
    assert!(few.contains("as few or fewer in"), "{few}");
    assert!(few.contains("go together"), "{few}");
    let usual = told(&[1.0, 1.0, -1.0, 1.0, -1.0, -1.0]).unwrap_or_default();
    assert!(usual.ends_with("of repetitions\n"), "{usual}");
}
