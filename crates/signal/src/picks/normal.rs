//! Least squares of a few parameters by the normal equations.

/// Most parameters of one fit: a polynomial of degree 8.
pub(crate) const MOST: usize = 9;

/// Normal equations, gathered row by row.
#[derive(Clone)]
pub(crate) struct Normal {
    matrix: [[f64; MOST]; MOST],
    right: [f64; MOST],
    size: usize,
}

/// Parameters, and the inverse of the normal matrix: their covariance for unit noise.
pub(crate) struct Solution {
    pub(crate) values: [f64; MOST],
    pub(crate) inverse: [[f64; MOST]; MOST],
    size: usize,
}

impl Normal {
    pub(crate) fn new(size: usize) -> Self {
        Self {
            matrix: [[0.0; MOST]; MOST],
            right: [0.0; MOST],
            size: size.min(MOST),
        }
    }

    /// One equation Σ row_k · parameter_k = value, all of weight 1.
    pub(crate) fn add(&mut self, row: &[f64; MOST], value: f64) {
        for j in 0..self.size {
            for k in 0..=j {
                self.matrix[j][k] += row[j] * row[k];
            }
            self.right[j] += row[j] * value;
        }
    }

    /// Multiplies the diagonal, as Marquardt's method does to shorten steps.
    pub(crate) fn damped(&self, factor: f64) -> Self {
        let mut damped = self.clone();
        for j in 0..self.size {
            damped.matrix[j][j] *= factor;
        }
        damped
    }

    /// `None` if the equations do not determine every parameter.
    pub(crate) fn solve(&self) -> Option<Solution> {
        let root = self.cholesky()?;
        let mut solution = Solution {
            values: self.back(&root, self.right),
            inverse: [[0.0; MOST]; MOST],
            size: self.size,
        };
        for j in 0..self.size {
            let mut unit = [0.0; MOST];
            unit[j] = 1.0;
            solution.inverse[j] = self.back(&root, unit);
        }
        Some(solution)
    }

    /// Lower triangular factor of the matrix.
    fn cholesky(&self) -> Option<[[f64; MOST]; MOST]> {
        let mut root = [[0.0; MOST]; MOST];
        for j in 0..self.size {
            for k in 0..=j {
                let known: f64 = (0..k).map(|i| root[j][i] * root[k][i]).sum();
                let left = self.matrix[j][k] - known;
                if j == k {
                    // Less than rounding is left of the diagonal: rows depend on each other.
                    let sound = left > 1e-14 * self.matrix[j][j] && left.is_finite();
                    root[j][j] = sound.then(|| left.sqrt())?;
                } else {
                    root[j][k] = left / root[k][k];
                }
            }
        }
        Some(root)
    }

    /// Solves with the factor: forward, then backward.
    fn back(&self, root: &[[f64; MOST]; MOST], right: [f64; MOST]) -> [f64; MOST] {
        let mut x = right;
        for j in 0..self.size {
            let known: f64 = (0..j).map(|k| root[j][k] * x[k]).sum();
            x[j] = (x[j] - known) / root[j][j];
        }
        for j in (0..self.size).rev() {
            let known: f64 = (j + 1..self.size).map(|k| root[k][j] * x[k]).sum();
            x[j] = (x[j] - known) / root[j][j];
        }
        x
    }
}

impl Solution {
    /// Variance of Σ row_k · parameter_k for unit noise.
    pub(crate) fn variance(&self, row: &[f64; MOST]) -> f64 {
        let n = self.size;
        let mut sum = 0.0;
        for (weight, line) in row.iter().zip(&self.inverse).take(n) {
            let along: f64 = line.iter().zip(row).take(n).map(|(c, r)| c * r).sum();
            sum += weight * along;
        }
        sum
    }
}
