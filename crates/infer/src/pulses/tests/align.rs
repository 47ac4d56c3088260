use super::*;

#[test]
fn cubics_are_read_exactly_between_samples() {
    let f = |x: f64| 1.0 + x - 0.3 * x * x + 0.02 * x.powi(3);
    let signal: Vec<f64> = (0..20).map(|n| f(f64::from(n))).collect();
    for x in [3.0, 7.25, 11.9] {
        // Rounding of ten operations on numbers up to 100.
        assert!((between(&signal, x) - f(x)).abs() < 1e-12, "{x}");
    }
}

#[test]
fn what_columns_span_is_taken_out() {
    let mut columns = vec![vec![1.0, 1.0, 1.0], vec![0.0, 1.0, 2.0]];
    let mut line = vec![3.0, 5.0, 7.0];
    let (along, length) = take_out(&mut columns, &mut line);
    // Rounding; the slope of 3, 5, 7 is 2.
    assert!(line.iter().all(|x| x.abs() < 1e-14), "{line:?}");
    assert!((along / length - 2.0).abs() < 1e-14);
}
