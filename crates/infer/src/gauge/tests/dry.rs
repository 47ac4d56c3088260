use super::*;

#[test]
fn shifts_sum_to_the_covariance() {
    let matrix = vec![vec![4.0, 1.2], vec![1.2, 0.9]];
    let shifts = shifts(&matrix);
    for i in 0..2 {
        for j in 0..2 {
            let sum: f64 = shifts.iter().map(|shift| shift[i] * shift[j]).sum();
            // Rounding.
            assert!((sum - matrix[i][j]).abs() < 1e-15, "{i} {j}");
        }
    }
}
