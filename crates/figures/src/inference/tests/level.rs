use super::*;

#[test]
fn half_of_a_bell_lies_where_it_is_above_half_of_its_maximum() {
    let middle = |i: usize| -3.0 + 6.0 * (i as f64 + 0.5) / 60.0;
    let bell = |x: f64, y: f64| (-0.5 * (x * x + y * y)).exp();
    let row = |j: usize| (0..60).map(|i| bell(middle(i), middle(j))).collect();
    let rows: Vec<Vec<f64>> = (0..60).map(row).collect();
    // What lies outside of the field and its cells are worth a percent or two.
    let found = level(&rows, 0.5);
    assert!((found - 0.5).abs() < 0.02, "{found}");
}
