//! The little linear algebra that inference needs, on matrices given by columns.

mod cholesky;
mod least_squares;
mod svd;

pub(crate) use cholesky::cholesky;
pub(crate) use least_squares::least_squares;
pub(crate) use svd::{Svd, svd};

/// Scalar product.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Euclidean length.
pub(crate) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// Σ weight · column: the matrix applied to a vector of weights.
pub(crate) fn combine(columns: &[Vec<f64>], weights: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; columns.first().map_or(0, Vec::len)];
    for (column, weight) in columns.iter().zip(weights) {
        for (sum, value) in sum.iter_mut().zip(column) {
            *sum += weight * value;
        }
    }
    sum
}
