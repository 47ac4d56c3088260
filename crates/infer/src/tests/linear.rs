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

use crate::linear::combine;

#[test]
fn products_of_the_factors_are_the_matrix() {
    let columns =
        vec![vec![1.0, 2.0, 3.0, -1.0], vec![0.5, -1.0, 2.0, 4.0], vec![1e-9, 3.0, 1.0, 0.0]];
    let found = svd(&columns);
    for (k, column) in columns.iter().enumerate() {
        let weights: Vec<f64> = (0..3).map(|i| found.values[i] * found.right[i][k]).collect();
        let back = combine(&found.left, &weights);
        // Rounding of a few operations on numbers up to 5.
        assert!(back.iter().zip(column).all(|(a, b)| (a - b).abs() < 1e-14));
    }
    assert!(found.values.is_sorted_by(|a, b| a >= b));
}

#[test]
fn small_singular_values_are_right_to_all_digits() {
    // Columns e₁ and e₁ + t e₂: the product of both values is t exactly,
    // the sum of their squares 2 + t². Rounding.
    let t = 1e-9;
    let found = svd(&[vec![1.0, 0.0, 0.0], vec![1.0, t, 0.0]]);
    assert!((found.values[0] * found.values[1] / t - 1.0).abs() < 1e-14);
}

#[test]
fn more_columns_than_rows_and_zero_columns_are_decomposed() {
    let found = svd(&[vec![1.0], vec![0.0], vec![2.0]]);
    assert!((found.values[0] - 5.0_f64.sqrt()).abs() < 1e-15); // rounding
    assert_eq!(&found.values[1..], [0.0, 0.0]);
}

#[test]
fn a_matrix_is_its_root_squared_and_a_singular_one_has_none() {
    let root = cholesky(2, |i, j| [[4.0, 2.0], [2.0, 10.0]][i][j]);
    assert_eq!(root, Some(vec![vec![2.0], vec![1.0, 3.0]]));
    assert_eq!(cholesky(2, |_, _| 1.0), None);
}
