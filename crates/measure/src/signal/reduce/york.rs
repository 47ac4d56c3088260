//! A straight line through points with errors in both coordinates \[York2004\].

use super::ChiSquare;
use crate::signal::PowerLaw;

/// Iterations after which the slope is taken as it is.
const ITERATIONS: usize = 200;

/// Points in the logarithms.
pub(crate) struct Points {
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) x_variance: Vec<f64>,
    pub(crate) y_variance: Vec<f64>,
}

/// Whether points have one abscissa, or there are none.
pub(crate) fn all_equal(x: &[f64]) -> bool {
    x.iter().all(|other| *other == x[0])
}

/// Weights, weighted means and York's adjusted departures for one slope.
struct Weighed {
    weights: Vec<f64>,
    all: f64,
    mean_x: f64,
    mean_y: f64,
    /// Adjusted abscissas, less their mean: where on the line each point belongs.
    adjusted: Vec<f64>,
}

impl Points {
    fn weigh(&self, slope: f64) -> Weighed {
        let variances = self.x_variance.iter().zip(&self.y_variance);
        let weights: Vec<f64> = variances
            .map(|(x, y)| (y + slope * slope * x).recip())
            .collect();
        let all: f64 = weights.iter().sum();
        let mean_x = weighted(&weights, &self.x) / all;
        let mean_y = weighted(&weights, &self.y) / all;
        let adjusted = (0..self.x.len()).map(|i| {
            let (u, v) = (self.x[i] - mean_x, self.y[i] - mean_y);
            weights[i] * (u * self.y_variance[i] + slope * v * self.x_variance[i])
        });
        Weighed {
            adjusted: adjusted.collect(),
            weights,
            all,
            mean_x,
            mean_y,
        }
    }

    /// Σ W β V / Σ W β U.
    fn next_slope(&self, weighed: &Weighed) -> f64 {
        let (mut above, mut below) = (0.0, 0.0);
        for (i, beta) in weighed.adjusted.iter().enumerate() {
            let part = weighed.weights[i] * beta;
            above += part * (self.y[i] - weighed.mean_y);
            below += part * (self.x[i] - weighed.mean_x);
        }
        above / below
    }

    /// `None` without two abscissas.
    pub(crate) fn fit(&self) -> Option<PowerLaw> {
        if all_equal(&self.x) {
            return None;
        }
        // Without errors of x the first step is ordinary weighted least squares.
        let mut slope = 0.0;
        for _ in 0..ITERATIONS {
            let next = self.next_slope(&self.weigh(slope));
            let done = (next - slope).abs() <= 1e-15 * next.abs();
            slope = next;
            if done || !slope.is_finite() {
                break;
            }
        }
        slope.is_finite().then(|| self.law(slope))
    }

    fn law(&self, slope: f64) -> PowerLaw {
        let at = self.weigh(slope);
        let level = at.mean_y - slope * at.mean_x;
        let shift = weighted(&at.weights, &at.adjusted) / at.all;
        let spread = at.adjusted.iter().map(|beta| (beta - shift).powi(2));
        let spread: f64 = spread.zip(&at.weights).map(|(s, w)| s * w).sum();
        let centre = at.mean_x + shift;
        let level_variance = at.all.recip() + centre * centre / spread;
        let pairs = self.x.iter().zip(&self.y);
        let residual = |(x, y): (&f64, &f64)| (y - at.mean_y) - slope * (x - at.mean_x);
        let residuals: Vec<f64> = pairs.map(residual).collect();
        let squares = |of: &mut dyn Iterator<Item = f64>| -> f64 {
            of.zip(&at.weights).map(|(d, w)| w * d * d).sum()
        };
        let left = squares(&mut residuals.iter().copied());
        let total = squares(&mut self.y.iter().map(|y| y - at.mean_y));
        PowerLaw {
            prefactor: level.exp(),
            exponent: slope,
            prefactor_error: level.exp() * level_variance.sqrt(),
            exponent_error: spread.recip().sqrt(),
            covariance: -centre / spread,
            r_squared: if total > 0.0 { 1.0 - left / total } else { 1.0 },
            chi_square: ChiSquare::of(left, residuals.len() - 2),
            residuals,
        }
    }
}

fn weighted(weights: &[f64], of: &[f64]) -> f64 {
    weights.iter().zip(of).map(|(w, x)| w * x).sum()
}
