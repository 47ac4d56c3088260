//! Residuals of one row, made independent.

use crate::data::widening;
use crate::linear::{cholesky, forward};

/// Standard errors of what was measured at one speed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Errors {
    /// Of each measured number by itself.
    sigmas: Vec<f64>,
    /// What an error of the speed of one σ moves each by.
    moved: Vec<f64>,
    /// Degrees of freedom of each, then of the speed's.
    freedom: Vec<f64>,
    of_speed: f64,
    /// Correlation of the errors of the first two.
    correlation: f64,
}

impl Errors {
    /// None yet, with the freedom of the speed's error and the correlation of the first two.
    pub(super) fn new(of_speed: f64, correlation: f64) -> Self {
        Self { sigmas: Vec::new(), moved: Vec::new(), freedom: Vec::new(), of_speed, correlation }
    }

    pub(super) fn push(&mut self, sigma: f64, freedom: f64, moved: f64) {
        self.sigmas.push(sigma);
        self.freedom.push(freedom);
        self.moved.push(moved);
    }

    /// Covariance of two of the numbers by their own errors: B.
    fn own(&self, i: usize, j: usize) -> f64 {
        let correlation = match (i, j) {
            _ if i == j => 1.0,
            (0, 1) | (1, 0) => self.correlation,
            _ => 0.0,
        };
        correlation * self.sigmas[i] * self.sigmas[j]
    }

    /// B⁻¹ s: what the speed moves, weighed by the numbers' own errors.
    fn weighed(&self) -> Vec<f64> {
        let in_sigmas: Vec<f64> =
            self.moved.iter().zip(&self.sigmas).map(|(moved, sigma)| moved / sigma).collect();
        let weigh = |(at, own): (usize, &f64)| {
            let known = in_sigmas.get(1 - at.min(1)).filter(|_| at < 2);
            let beside = known.map_or(*own, |other| {
                (own - self.correlation * other) / (1.0 - self.correlation.powi(2))
            });
            beside / self.sigmas[at]
        };
        in_sigmas.iter().enumerate().map(weigh).collect()
    }

    /// Shares of the row's covariance C = B + s sᵀ, B of the numbers' own errors:
    /// (C⁻¹ B)ᵢᵢ = 1 − sᵢ (B⁻¹ s)ᵢ/(1 + q) of each number and sᵀ C⁻¹ s = q/(1 + q) of the speed,
    /// q = sᵀ B⁻¹ s; they sum to the number of rows.
    fn shares(&self) -> (Vec<f64>, f64) {
        let parts: Vec<f64> = self.weighed().iter().zip(&self.moved).map(|(w, s)| w * s).collect();
        let q: f64 = parts.iter().sum();
        // Correlated numbers may share less than nothing with the speed.
        let own = parts.iter().map(|part| (1.0 - part / (1.0 + q)).clamp(0.0, 1.0));
        (own.collect(), q / (1.0 + q))
    }

    /// Degrees of freedom of each number's error with what the speed moves it by [Satterthwaite1946].
    pub(super) fn freedoms(&self) -> Vec<f64> {
        let (shares, _) = self.shares();
        let few = |freedom: f64| if widening(1.0, freedom) > 1.0 { freedom.recip() } else { 0.0 };
        let of = |(own, freedom): (f64, &f64)| {
            (own * few(*freedom) + (1.0 - own) * few(self.of_speed)).recip()
        };
        shares.into_iter().zip(&self.freedom).map(of).collect()
    }

    /// Each by what its own uncertainty costs, in its share.
    pub(super) fn widened(mut self) -> Self {
        let (shares, of_speed) = self.shares();
        for (at, share) in shares.into_iter().enumerate() {
            self.sigmas[at] *= widening(share, self.freedom[at]);
        }
        let of_speed = widening(of_speed, self.of_speed);
        self.moved.iter_mut().for_each(|moved| *moved *= of_speed);
        self
    }
}

/// Standardises what one speed's measurements miss: with B the covariance of their own errors and
/// `sᵢ`, what an error of the speed of one σ moves each by, their covariance is C = B + s sᵀ. Given
/// C = L Lᵀ the result is L⁻¹ r with ln Lᵢᵢ; the sum of its squares is rᵀ C⁻¹ r.
///
/// The first is standardised by itself, each further one by what it determines beside
/// those before it.
pub(super) fn whiten(residuals: &[f64], errors: &Errors) -> Vec<(f64, f64)> {
    let moved = &errors.moved;
    let covariance = |i: usize, j: usize| errors.own(i, j) + moved[i] * moved[j];
    let Some(lower) = cholesky(residuals.len(), covariance) else {
        return vec![(f64::NAN, f64::NAN); residuals.len()];
    };
    let white = forward(&lower, residuals).into_iter().zip(&lower).enumerate();
    white.map(|(at, (residual, row))| (residual, row[at].ln())).collect()
}

#[cfg(test)]
#[path = "tests/whiten.rs"]
mod tests;
