//! Square roots of matrices.

/// L with L Lᵀ = the matrix, row by row up to the diagonal; none if it is not
/// positive definite as far as rounding tells.
pub(crate) fn cholesky(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let mut lower: Vec<Vec<f64>> = Vec::with_capacity(matrix.len());
    for (at, entries) in matrix.iter().enumerate() {
        let mut row: Vec<f64> = Vec::with_capacity(at + 1);
        for above in &lower {
            let known: f64 = above.iter().zip(&row).map(|(a, b)| a * b).sum();
            row.push((entries[row.len()] - known) / above[above.len() - 1]);
        }
        let left = entries[at] - row.iter().map(|x| x * x).sum::<f64>();
        if left.is_nan() || left <= ROUNDING * entries[at] {
            return None;
        }
        row.push(left.sqrt());
        lower.push(row);
    }
    Some(lower)
}

/// What rounding leaves of a number that is 0: some tens of operations.
const ROUNDING: f64 = 1e-14;

#[cfg(test)]
#[path = "tests/cholesky.rs"]
mod tests;
