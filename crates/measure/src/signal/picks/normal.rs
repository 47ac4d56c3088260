//! Least squares of a few parameters by the normal equations.

/// Most parameters of one fit: a polynomial of degree 10.
pub(crate) const MOST: usize = 11;

/// Normal equations, gathered row by row.
#[derive(Clone)]
pub(crate) struct Normal {
    matrix: [[f64; MOST]; MOST],
    right: [f64; MOST],
    size: usize,
}

/// Steps after which a descent is given up.
const STEPS: usize = 60;

/// Where a descent ended: the model, and the normal equations of a step from it.
pub(crate) struct Descent<M> {
    pub(crate) model: M,
    pub(crate) normal: Normal,
    /// Sum of squares left.
    pub(crate) left: f64,
}

/// The model of least squares, by Levenberg and Marquardt's damped steps.
///
/// `equations` gives the normal equations of a step from a model and the model's
/// sum of squares, or nothing where a model is out of bounds; `still` says
/// whether two models are the same.
pub(crate) fn descend<M>(
    start: M,
    equations: impl Fn(&M) -> Option<(Normal, f64)>,
    moved: impl Fn(&M, &[f64; MOST]) -> M,
    still: impl Fn(&M, &M) -> bool,
) -> Option<Descent<M>> {
    let (normal, left) = equations(&start)?;
    let mut at = Descent {
        model: start,
        normal,
        left,
    };
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        let step = at.normal.damped(1.0 + damping).values()?;
        let model = moved(&at.model, &step);
        let tried = equations(&model).filter(|(_, left)| *left <= at.left);
        if let Some((normal, left)) = tried {
            let done = still(&at.model, &model);
            at = Descent {
                model,
                normal,
                left,
            };
            damping *= 0.1;
            if done {
                return Some(at);
            }
        } else if damping > 1e8 {
            // No step makes it better: this is the least, to rounding.
            return Some(at);
        } else {
            damping *= 10.0;
        }
    }
    None
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
    fn damped(&self, factor: f64) -> Self {
        let mut damped = self.clone();
        for j in 0..self.size {
            damped.matrix[j][j] *= factor;
        }
        damped
    }

    /// Parameters alone; `None` as in [`Self::solve`].
    fn values(&self) -> Option<[f64; MOST]> {
        Some(self.back(&self.cholesky()?, self.right))
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

    /// Logarithm of the matrix's determinant.
    pub(crate) fn log_determinant(&self) -> Option<f64> {
        let root = self.cholesky()?;
        Some(2.0 * (0..self.size).map(|j| root[j][j].ln()).sum::<f64>())
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
        let along = self.covariance_with(row);
        let used = row.iter().zip(along).take(self.size);
        used.map(|(weight, along)| weight * along).sum()
    }

    /// Covariance of each parameter with Σ row_k · parameter_k for unit noise.
    pub(crate) fn covariance_with(&self, row: &[f64; MOST]) -> [f64; MOST] {
        let along = |line: &[f64; MOST]| {
            let terms = line.iter().zip(row).take(self.size);
            terms.map(|(c, r)| c * r).sum()
        };
        std::array::from_fn(|k| along(&self.inverse[k]))
    }
}
