//! Power laws with errors in both coordinates.

use crate::power_law::{FitError, PowerLaw, check};

/// Fits y = a x^b with standard deviations of both x and y.
///
/// York's method for a straight line through points with independent errors
/// (York and others, Am. J. Phys. 72, 367, 2004), in ln y against ln x with
/// errors σ_y/y and σ_x/x: it makes Σ (ln y − ln a − b ln x)²/((σ_y/y)² + b² (σ_x/x)²) least. Errors follow
/// from the σ alone; `r_squared` and residuals are those of ln y. Errors of
/// x may be 0.
///
/// # Errors
/// See [`FitError`].
pub fn power_law_both_errors(
    abscissas: &[f64],
    abscissa_sigmas: &[f64],
    values: &[f64],
    sigmas: &[f64],
) -> Result<PowerLaw, FitError> {
    check(abscissas, values, Some(sigmas))?;
    check_sigmas(abscissas, abscissa_sigmas)?;
    let logarithms = |of: &[f64]| of.iter().map(|x| x.ln()).collect::<Vec<f64>>();
    let variances = |of: &[f64], sigmas: &[f64]| -> Vec<f64> {
        let pairs = of.iter().zip(sigmas);
        pairs.map(|(x, s)| (s / x).powi(2)).collect()
    };
    let points = Points {
        x: logarithms(abscissas),
        y: logarithms(values),
        x_variance: variances(abscissas, abscissa_sigmas),
        y_variance: variances(values, sigmas),
    };
    if points.x.iter().all(|x| *x == points.x[0]) || points.x.is_empty() {
        return Err(FitError::TooFew);
    }
    points.fit().ok_or(FitError::TooFew)
}

fn check_sigmas(abscissas: &[f64], sigmas: &[f64]) -> Result<(), FitError> {
    if sigmas.len() != abscissas.len() {
        return Err(FitError::Lengths {
            abscissas: abscissas.len(),
            values: sigmas.len(),
        });
    }
    let bad = sigmas.iter().position(|s| !(*s >= 0.0 && s.is_finite()));
    bad.map_or(Ok(()), |index| Err(FitError::NotPositive { index }))
}

/// Iterations after which the slope is taken as it is.
const ITERATIONS: usize = 200;

struct Points {
    x: Vec<f64>,
    y: Vec<f64>,
    x_variance: Vec<f64>,
    y_variance: Vec<f64>,
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

    fn fit(&self) -> Option<PowerLaw> {
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
        let residuals: Vec<f64> = pairs.map(|(x, y)| y - level - slope * x).collect();
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
            residuals,
        }
    }
}

fn weighted(weights: &[f64], of: &[f64]) -> f64 {
    weights.iter().zip(of).map(|(w, x)| w * x).sum()
}
