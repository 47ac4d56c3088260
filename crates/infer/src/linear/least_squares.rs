//! Linear least squares of many unknowns.

use super::norm;
use rayon::prelude::*;

/// A column is a combination of earlier ones if so little of it is left beside them.
const NOTHING_NEW: f64 = 1e-10;

/// For each right-hand side the weights with which columns come nearest to it, by
/// modified Gram–Schmidt on columns and right-hand sides together, which is as
/// stable as reflections [Bjorck1967]. Columns that are combinations of earlier ones
/// weigh nothing.
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
        row.par_extend(rest.par_iter_mut().map(|other| taken_out(own, other)));
        triangle.push(row);
    }
    let right = |at: usize| weights(&triangle, count + at);
    (0..all.len() - count).into_par_iter().map(right).collect()
}

/// Takes out of a vector what lies along another of unit length; how much that was.
fn taken_out(unit: &[f64], from: &mut [f64]) -> f64 {
    let along = product(unit, from);
    for (from, unit) in from.iter_mut().zip(unit) {
        *from -= along * unit;
    }
    along
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

#[cfg(test)]
#[path = "tests/least_squares.rs"]
mod tests;
