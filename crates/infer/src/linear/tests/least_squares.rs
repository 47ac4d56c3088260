use super::*;

#[test]
fn a_line_with_a_column_twice_has_the_weights_of_regression() {
    let x = [0.0, 1.0, 2.0, 4.0];
    let y = vec![1.0, 2.0, 2.0, 5.0];
    let columns = vec![vec![1.0; 4], x.to_vec(), x.to_vec()];
    let found = least_squares(columns, vec![y]);
    // Slope Sxy/Sxx = 8.5/8.75, through the mean (1.75, 2.5).
    let slope = 8.5 / 8.75;
    let expected = [2.5 - 1.75 * slope, slope, 0.0];
    for (found, expected) in found[0].iter().zip(expected) {
        // Rounding of a dozen operations.
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
}
