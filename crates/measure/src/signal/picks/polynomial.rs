//! A polynomial through a few samples, with its covariance.

use super::normal::{MOST, Normal, Solution};

/// A polynomial in u = (sample − centre)/half, fitted where |u| ≤ 1.
pub(crate) struct Polynomial {
    pub(crate) centre: f64,
    /// Samples in one unit of u.
    pub(crate) half: f64,
    pub(crate) degree: usize,
    /// Coefficients and their covariance for unit noise.
    pub(crate) solution: Solution,
    /// Root mean square of what it leaves, over its degrees of freedom.
    pub(crate) left: f64,
    /// Samples less what they determine.
    pub(crate) freedom: f64,
}

/// Value, slope and bend of a polynomial at one place, in units of u.
pub(crate) struct Course {
    pub(crate) value: f64,
    pub(crate) slope: f64,
    pub(crate) bend: f64,
}

impl Polynomial {
    /// Through `values`, the first of which is sample `first`.
    ///
    /// The degree is lowered where there are too few samples for it. `None`
    /// when fewer than three samples lie within reach.
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
        let mut normal = Normal::new(degree + 1);
        let at = |i: usize| (first + low + i as f64 - centre) / half;
        for (i, value) in part.iter().enumerate() {
            normal.add(&powers(at(i)), *value);
        }
        let mut polynomial = Self {
            centre,
            half,
            degree,
            solution: normal.solve()?,
            left: 0.0,
            freedom: (part.len() - degree - 1) as f64,
        };
        let miss = |(i, value): (usize, &f64)| (value - polynomial.course(at(i)).value).powi(2);
        let squares: f64 = part.iter().enumerate().map(miss).sum();
        polynomial.left = (squares / polynomial.freedom).sqrt();
        (degree > 0).then_some(polynomial)
    }

    pub(crate) fn course(&self, u: f64) -> Course {
        let (mut value, mut slope, mut bend) = (0.0, 0.0, 0.0);
        for c in self.solution.values[..=self.degree].iter().rev() {
            bend = bend * u + 2.0 * slope;
            slope = slope * u + value;
            value = value * u + c;
        }
        Course { value, slope, bend }
    }

    /// Sample at u.
    pub(crate) fn sample(&self, u: f64) -> f64 {
        self.centre + self.half * u
    }

    /// Where the slope falls through 0, found from u = 0.
    pub(crate) fn top(&self) -> Option<f64> {
        self.newton(|here| (here.bend < 0.0).then(|| -here.slope / here.bend))
    }

    /// Where the value rises through `height`, found from u = 0.
    pub(crate) fn rise_through(&self, height: f64) -> Option<f64> {
        self.newton(|here| (here.slope > 0.0).then(|| (height - here.value) / here.slope))
    }

    fn newton(&self, step: impl Fn(&Course) -> Option<f64>) -> Option<f64> {
        let mut u = 0.0_f64;
        for _ in 0..30 {
            let by = step(&self.course(u))?;
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

    /// Variance of the value at u for unit noise.
    pub(crate) fn value_variance(&self, u: f64) -> f64 {
        self.solution.variance(&powers(u))
    }

    /// Variance of the slope at u for unit noise.
    pub(crate) fn slope_variance(&self, u: f64) -> f64 {
        self.solution.variance(&slope_row(u))
    }

    /// Variance of the bend at u for unit noise.
    pub(crate) fn bend_variance(&self, u: f64) -> f64 {
        self.solution.variance(&bend_row(u))
    }
}

/// 0, 1, 2 u, 3 u² and so on.
pub(crate) fn slope_row(u: f64) -> [f64; MOST] {
    let mut row = [0.0; MOST];
    let below = powers(u);
    for k in 1..MOST {
        row[k] = k as f64 * below[k - 1];
    }
    row
}

/// 0, 0, 2, 6 u and so on.
fn bend_row(u: f64) -> [f64; MOST] {
    let mut row = [0.0; MOST];
    let below = slope_row(u);
    for k in 2..MOST {
        row[k] = k as f64 * below[k - 1];
    }
    row
}

/// 1, u, u² and so on.
pub(crate) fn powers(u: f64) -> [f64; MOST] {
    let mut row = [1.0; MOST];
    for k in 1..MOST {
        row[k] = row[k - 1] * u;
    }
    row
}

#[cfg(test)]
#[path = "tests/polynomial.rs"]
mod tests;
