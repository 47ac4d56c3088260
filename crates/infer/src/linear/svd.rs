//! Singular values by rotations of columns.

use super::{dot, norm};

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
    let mut right: Vec<Vec<f64>> = (0..n)
        .map(|k| (0..n).map(|i| f64::from(u8::from(i == k))).collect())
        .collect();
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
    let mut triples: Vec<(f64, Vec<f64>, Vec<f64>)> = rotated
        .into_iter()
        .zip(right)
        .map(|(left, right)| (norm(&left), left, right))
        .collect();
    triples.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut found = Svd {
        values: Vec::new(),
        left: Vec::new(),
        right: Vec::new(),
    };
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
#[path = "tests/svd.rs"]
mod tests;
