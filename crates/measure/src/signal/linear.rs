//! Linear and nonlinear least squares of a few parameters, and polynomials fitted to samples.

/// Most parameters of one fit: a polynomial of degree 10.
pub(crate) const MOST: usize = 11;

/// One number a parameter; those beyond a fit's own count are not used.
pub(crate) type Row = [f64; MOST];

#[derive(Clone)]
pub(crate) struct NormalEquations<const N: usize = MOST> {
    matrix: [[f64; N]; N],
    right: [f64; N],
    size: usize,
}

/// Parameters, and the inverse of the normal matrix: their covariance for unit noise.
#[derive(Clone)]
pub(crate) struct LinearSolution<const N: usize = MOST> {
    pub(crate) values: [f64; N],
    pub(crate) inverse: [[f64; N]; N],
    size: usize,
}

impl<const N: usize> NormalEquations<N> {
    pub(crate) fn new(size: usize) -> Self {
        Self { matrix: [[0.0; N]; N], right: [0.0; N], size: size.min(N) }
    }

    /// Adds one equation Σ row_k · parameter_k = value of weight 1.
    pub(crate) fn add(&mut self, row: &[f64; N], value: f64) {
        for j in 0..self.size {
            for k in 0..=j {
                self.matrix[j][k] += row[j] * row[k];
            }
            self.right[j] += row[j] * value;
        }
    }

    /// A step of Marquardt's method: the diagonal multiplied by `factor`.
    fn damped_step(&self, factor: f64) -> Option<[f64; N]> {
        let mut damped = self.clone();
        (0..self.size).for_each(|j| damped.matrix[j][j] *= factor);
        Some(damped.substitute(&damped.cholesky()?, self.right))
    }

    /// `None` if the equations do not determine every parameter.
    pub(crate) fn solve(&self) -> Option<LinearSolution<N>> {
        let root = self.cholesky()?;
        let mut inverse = [[0.0; N]; N];
        for j in 0..self.size {
            let mut unit = [0.0; N];
            unit[j] = 1.0;
            inverse[j] = self.substitute(&root, unit);
        }
        Some(LinearSolution {
            values: self.substitute(&root, self.right),
            inverse,
            size: self.size,
        })
    }

    pub(crate) fn log_determinant(&self) -> Option<f64> {
        let root = self.cholesky()?;
        Some(2.0 * (0..self.size).map(|j| root[j][j].ln()).sum::<f64>())
    }

    /// Half of what a solution takes off the sum of squares, less half of the determinant's logarithm: the
    /// logarithm of the probability of the values of unit noise, parameters integrated out.
    pub(crate) fn log_evidence(&self) -> Option<f64> {
        let root = self.cholesky()?;
        let solution = self.substitute(&root, self.right);
        let off: f64 = (0..self.size).map(|j| solution[j] * self.right[j]).sum();
        Some(0.5 * off - (0..self.size).map(|j| root[j][j].ln()).sum::<f64>())
    }

    fn cholesky(&self) -> Option<[[f64; N]; N]> {
        let mut root = [[0.0; N]; N];
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
    fn substitute(&self, root: &[[f64; N]; N], right: [f64; N]) -> [f64; N] {
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

impl<const N: usize> LinearSolution<N> {
    /// Least squares of equations Σ row_k · parameter_k = value for so many parameters; `None` if they
    /// do not determine every one.
    pub(crate) fn of(
        size: usize,
        equations: impl Iterator<Item = ([f64; N], f64)>,
    ) -> Option<Self> {
        let mut normal = NormalEquations::new(size);
        equations.for_each(|(row, value)| normal.add(&row, value));
        normal.solve()
    }

    /// Σ row_k · parameter_k.
    pub(crate) fn value(&self, row: &[f64; N]) -> f64 {
        row.iter().zip(self.values).take(self.size).map(|(term, c)| term * c).sum()
    }

    /// Variance of Σ row_k · parameter_k for unit noise.
    pub(crate) fn variance(&self, row: &[f64; N]) -> f64 {
        let covariances = self.covariance_with(row);
        let used = row.iter().zip(covariances).take(self.size);
        used.map(|(weight, covariance)| weight * covariance).sum()
    }

    /// Covariance of each parameter with Σ row_k · parameter_k for unit noise.
    pub(crate) fn covariance_with(&self, row: &[f64; N]) -> [f64; N] {
        let covariance = |line: &[f64; N]| {
            let terms = line.iter().zip(row).take(self.size);
            terms.map(|(c, r)| c * r).sum()
        };
        std::array::from_fn(|k| covariance(&self.inverse[k]))
    }
}

/// Where a Levenberg–Marquardt search ended: the model, and the normal equations of a step from it.
pub(crate) struct Optimum<M, const N: usize = MOST> {
    pub(crate) model: M,
    pub(crate) normal: NormalEquations<N>,
    pub(crate) squares: f64,
}

/// Nonlinear least squares by Levenberg and Marquardt's damped steps.
///
/// `equations` returns the normal equations of a step from a model and the model's sum of squares,
/// or nothing where a model is out of bounds; `converged` compares two successive models.
pub(crate) fn levenberg_marquardt<M, const N: usize>(
    start: M,
    equations: impl Fn(&M) -> Option<(NormalEquations<N>, f64)>,
    moved: impl Fn(&M, &[f64; N]) -> M,
    converged: impl Fn(&M, &M) -> bool,
) -> Option<Optimum<M, N>> {
    let (normal, squares) = equations(&start)?;
    let mut at = Optimum { model: start, normal, squares };
    let mut damping = 1e-3;
    for _ in 0..60 {
        let model = moved(&at.model, &at.normal.damped_step(1.0 + damping)?);
        let tried = equations(&model).filter(|(_, squares)| *squares <= at.squares);
        if let Some((normal, squares)) = tried {
            let done = converged(&at.model, &model);
            at = Optimum { model, normal, squares };
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

/// A polynomial in u = (sample − centre)/half, fitted where |u| ≤ 1.
#[derive(Clone)]
pub(crate) struct LocalPolynomial {
    pub(crate) centre: f64,
    pub(crate) half: f64,
    pub(crate) solution: LinearSolution,
    pub(crate) residual: f64,
    pub(crate) freedom: f64,
}

/// Value, slope and curvature of a polynomial at one place, in units of u.
pub(crate) struct Derivatives {
    pub(crate) value: f64,
    pub(crate) slope: f64,
    pub(crate) curvature: f64,
}

impl LocalPolynomial {
    /// Least squares through `values`, the first of which is sample `first`.
    ///
    /// The degree is lowered where there are too few samples for it. `None` if fewer than three
    /// samples lie within reach.
    pub(crate) fn through(
        values: &[f64],
        first: f64,
        centre: f64,
        half: f64,
        degree: usize,
    ) -> Option<Self> {
        let low = (centre - half - first).ceil().max(0.0);
        let high = (centre + half - first).floor();
        if high < low || high.is_nan() {
            return None;
        }
        let part = values.get(low as usize..values.len().min(high as usize + 1))?;
        let degree = degree.min(MOST - 1).min(part.len().checked_sub(2)?);
        let u = |i: usize| (first + low + i as f64 - centre) / half;
        let equations = part.iter().enumerate().map(|(i, value)| (powers(u(i)), *value));
        let mut polynomial = Self {
            centre,
            half,
            solution: LinearSolution::of(degree + 1, equations)?,
            residual: 0.0,
            freedom: (part.len() - degree - 1) as f64,
        };
        let square = |(i, value): (usize, &f64)| (value - polynomial.at(u(i)).value).powi(2);
        let squares: f64 = part.iter().enumerate().map(square).sum();
        polynomial.residual = (squares / polynomial.freedom).sqrt();
        (degree > 0).then_some(polynomial)
    }

    pub(crate) fn at(&self, u: f64) -> Derivatives {
        let (mut value, mut slope, mut curvature) = (0.0, 0.0, 0.0);
        for c in self.solution.values[..self.solution.size].iter().rev() {
            curvature = curvature * u + 2.0 * slope;
            slope = slope * u + value;
            value = value * u + c;
        }
        Derivatives { value, slope, curvature }
    }

    pub(crate) fn sample(&self, u: f64) -> f64 {
        self.centre + self.half * u
    }

    /// Place of the maximum, searched for from u = 0.
    pub(crate) fn maximum(&self) -> Option<f64> {
        self.newton(|at| (at.curvature < 0.0).then(|| -at.slope / at.curvature))
    }

    /// Where the value rises through `height`, searched for from u = 0.
    pub(crate) fn rise_through(&self, height: f64) -> Option<f64> {
        self.newton(|at| (at.slope > 0.0).then(|| (height - at.value) / at.slope))
    }

    fn newton(&self, step: impl Fn(&Derivatives) -> Option<f64>) -> Option<f64> {
        let mut u = 0.0_f64;
        for _ in 0..30 {
            let by = step(&self.at(u))?;
            u += by.clamp(-0.5, 0.5);
            if u.is_nan() || u.abs() > 1.2 {
                return None;
            }
            if by.abs() < 1e-12 {
                break;
            }
        }
        Some(u)
    }

    /// Variances of value, slope and curvature at u for unit noise.
    pub(crate) fn variances(&self, u: f64) -> Derivatives {
        let value = powers(u);
        let slope = differentiated(&value);
        Derivatives {
            value: self.solution.variance(&value),
            slope: self.solution.variance(&slope),
            curvature: self.solution.variance(&differentiated(&slope)),
        }
    }
}

pub(crate) fn powers(u: f64) -> Row {
    let mut row = [1.0; MOST];
    for k in 1..MOST {
        row[k] = row[k - 1] * u;
    }
    row
}

/// From the row of powers that of their derivatives, 0, 1, 2 u, 3 u², and so on.
pub(crate) fn differentiated(below: &Row) -> Row {
    std::array::from_fn(|k| k.checked_sub(1).map_or(0.0, |j| k as f64 * below[j]))
}

#[cfg(test)]
#[path = "tests/polynomial.rs"]
mod tests;
