//! Linear algebra on small matrices given by columns.

use rayon::prelude::*;

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

/// A square matrix of these entries, row by row.
pub(crate) fn square(size: usize, entry: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect()
}

/// A vector of zeros but for a 1 at one place.
pub(crate) fn unit(size: usize, at: usize) -> Vec<f64> {
    (0..size).map(|i| f64::from(u8::from(i == at))).collect()
}

/// L⁻¹ r of a lower triangle, row by row up to the diagonal.
pub(crate) fn forward(lower: &[Vec<f64>], rights: &[f64]) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::with_capacity(lower.len());
    for (at, (row, right)) in lower.iter().zip(rights).enumerate() {
        found.push((right - dot(&row[..at], &found)) / row[at]);
    }
    found
}

/// What rounding leaves of a number that is 0: some tens of operations.
const CHOLESKY_ROUNDING: f64 = 1e-14;

/// L with L Lᵀ = the symmetric matrix of these entries, row by row up to the diagonal; none if it is
/// not positive definite as far as rounding matters.
pub(crate) fn cholesky(size: usize, entry: impl Fn(usize, usize) -> f64) -> Option<Vec<Vec<f64>>> {
    let mut lower: Vec<Vec<f64>> = Vec::with_capacity(size);
    for at in 0..size {
        let mut row: Vec<f64> = Vec::with_capacity(at + 1);
        for above in &lower {
            let known: f64 = above.iter().zip(&row).map(|(a, b)| a * b).sum();
            row.push((entry(at, row.len()) - known) / above[above.len() - 1]);
        }
        let diagonal = entry(at, at);
        let left = diagonal - row.iter().map(|x| x * x).sum::<f64>();
        if left.is_nan() || left <= CHOLESKY_ROUNDING * diagonal {
            return None;
        }
        row.push(left.sqrt());
        lower.push(row);
    }
    Some(lower)
}

/// A column is a combination of earlier ones if so little of it is left beside them.
const NOTHING_NEW: f64 = 1e-10;

/// For each right-hand side the weights with which columns come nearest to it, by modified
/// Gram–Schmidt on columns and right-hand sides together, which is as stable as reflections
/// [Bjorck1967]. Columns that are combinations of earlier ones weigh nothing.
pub(crate) fn least_squares(columns: Vec<Vec<f64>>, rights: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let count = columns.len();
    let lengths: Vec<f64> = columns.iter().map(|column| norm(column)).collect();
    let mut all = columns;
    all.extend(rights);
    let mut triangle: Vec<Vec<f64>> = Vec::with_capacity(count);
    for at in 0..count {
        let (done, rest) = all.split_at_mut(at + 1);
        let own = &mut done[at];
        let length = norm(own);
        let new = length > NOTHING_NEW * lengths[at];
        let scale = if new { 1.0 / length } else { 0.0 };
        own.iter_mut().for_each(|x| *x *= scale);
        let mut row = vec![if new { length } else { 0.0 }];
        let own = &*own;
        row.par_extend(rest.par_iter_mut().map(|other| {
            let along = product(own, other);
            other.iter_mut().zip(own).for_each(|(from, unit)| *from -= along * unit);
            along
        }));
        triangle.push(row);
    }
    let right = |at: usize| weights(&triangle, count + at);
    (0..all.len() - count).into_par_iter().map(right).collect()
}

/// Scalar product, in eight sums side by side.
fn product(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest = a.remainder().iter().zip(b.remainder());
    let rest: f64 = rest.map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// By back substitution. Rows of the triangle begin at their diagonal.
fn weights(triangle: &[Vec<f64>], right: usize) -> Vec<f64> {
    let mut found = vec![0.0; triangle.len()];
    for (at, row) in triangle.iter().enumerate().rev() {
        let known = row[1..].iter().zip(&found[at + 1..]);
        let known: f64 = known.map(|(r, weight)| r * weight).sum();
        if row[0] > 0.0 {
            found[at] = (row[right - at] - known) / row[0];
        }
    }
    found
}

/// J = Σ values\[k\] · left\[k\] right\[k\]ᵀ, largest value first.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Svd {
    pub values: Vec<f64>,
    pub left: Vec<Vec<f64>>,
    pub right: Vec<Vec<f64>>,
}

/// Sweeps after which rotations stop; convergence is quadratic and takes less than ten.
const SWEEPS: usize = 60;

/// Decomposes a matrix given by its columns, of which there may be more than rows.
///
/// One-sided Jacobi rotations: slower than bidiagonalisation, but small
/// singular values come out to high relative accuracy [DemmelVeselic1992], and
/// whether these are small is what is asked of a fit.
pub(crate) fn svd(columns: &[Vec<f64>]) -> Svd {
    let n = columns.len();
    let mut rotated = columns.to_vec();
    let mut right: Vec<Vec<f64>> = (0..n).map(|k| unit(n, k)).collect();
    for _ in 0..SWEEPS {
        if !sweep(&mut rotated, &mut right) {
            break;
        }
    }
    sorted(rotated, right)
}

/// Makes every pair of columns orthogonal once; whether anything had to be turned.
fn sweep(columns: &mut [Vec<f64>], right: &mut [Vec<f64>]) -> bool {
    let mut turned = false;
    for i in 0..columns.len() {
        for j in i + 1..columns.len() {
            let (a, b) = (dot(&columns[i], &columns[i]), dot(&columns[j], &columns[j]));
            let product = dot(&columns[i], &columns[j]);
            if product.abs() <= f64::EPSILON * (a * b).sqrt() {
                continue;
            }
            turned = true;
            let turn = (b - a) / (2.0 * product);
            let tangent = turn.signum() / (turn.abs() + turn.hypot(1.0));
            rotate(columns, (i, j), tangent);
            rotate(right, (i, j), tangent);
        }
    }
    turned
}

fn rotate(columns: &mut [Vec<f64>], (i, j): (usize, usize), tangent: f64) {
    let cosine = tangent.hypot(1.0).recip();
    let sine = cosine * tangent;
    let (head, tail) = columns.split_at_mut(j);
    for (a, b) in head[i].iter_mut().zip(&mut tail[0]) {
        (*a, *b) = (cosine * *a - sine * *b, sine * *a + cosine * *b);
    }
}

fn sorted(rotated: Vec<Vec<f64>>, right: Vec<Vec<f64>>) -> Svd {
    let mut triples: Vec<(f64, Vec<f64>, Vec<f64>)> =
        rotated.into_iter().zip(right).map(|(left, right)| (norm(&left), left, right)).collect();
    triples.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut found = Svd { values: Vec::new(), left: Vec::new(), right: Vec::new() };
    for (value, mut left, right) in triples {
        if value > 0.0 {
            left.iter_mut().for_each(|x| *x /= value);
        }
        found.values.push(value);
        found.left.push(left);
        found.right.push(right);
    }
    found
}

#[cfg(test)]
#[path = "tests/linear.rs"]
mod tests;
