//! Power laws by York's weighted least squares in the logarithms \[York2004\].

use crate::error::{MeasureError, Result};
use crate::signal::ChiSquare;

/// y = `prefactor` · x^`exponent` with its errors.
#[derive(Clone, Debug, PartialEq)]
pub struct PowerLaw {
    /// y at x = 1.
    pub prefactor: f64,
    /// Slope in log–log.
    pub exponent: f64,
    /// Standard error of the prefactor: prefactor · standard error of its logarithm.
    pub prefactor_error: f64,
    /// Standard error of the exponent.
    pub exponent_error: f64,
    /// Covariance of ln(prefactor) and the exponent.
    pub covariance: f64,
    /// Share of the variance of ln y that the law explains; weighted if the fit is.
    pub r_squared: f64,
    /// ln y − ln(prefactor · x^exponent), one a point: relative deviations, nearly.
    pub residuals: Vec<f64>,
    /// Chi-square of the points in their own errors; `None` where these are unknown, or two points
    /// leave no degree of freedom.
    pub chi_square: Option<ChiSquare>,
}

/// Error of a fit of a power law.
pub type FitError = MeasureError;

/// Probability of chi-square below which points do not follow a law.
const UNLIKELY: f64 = 0.01;

impl PowerLaw {
    /// The law's value.
    pub fn at(&self, x: f64) -> f64 {
        self.prefactor * x.powf(self.exponent)
    }

    /// Largest |y / law − 1| over the fitted points.
    pub fn largest_deviation(&self) -> f64 {
        let relative = self.residuals.iter().map(|r| r.exp_m1().abs());
        relative.fold(0.0, f64::max)
    }

    /// Whether the points follow the law within their errors: p ≥ 0.01. `None` if their errors are
    /// unknown.
    pub fn is_supported(&self) -> Option<bool> {
        self.chi_square.map(|c| c.probability >= UNLIKELY)
    }

    /// Factor that makes the errors as large as the points' scatter about the law,
    /// √(χ²/degrees of freedom); 1 if they are large enough, or chi-square is unknown.
    pub fn excess(&self) -> f64 {
        let reduced = self.chi_square.map(|c| c.value / c.freedom as f64);
        reduced.map_or(1.0, |reduced| reduced.sqrt().max(1.0))
    }
}

/// Fits y = a x^b by least squares in ln y against ln x.
///
/// With `sigmas`, standard deviations of the values, points are weighted by (y/σ)² and errors
/// follow from the σ alone; without, all weigh the same and errors follow from the scatter with
/// n − 2 degrees of freedom (not a number when n = 2).
///
/// # Errors
/// As [`power_law_both_errors`].
pub fn power_law(abscissas: &[f64], values: &[f64], sigmas: Option<&[f64]>) -> Result<PowerLaw> {
    let exact = vec![0.0; abscissas.len()];
    // Without sigmas relative errors of 1 give all points one weight.
    let law = power_law_both_errors(abscissas, &exact, values, sigmas.unwrap_or(values))?;
    if sigmas.is_some() {
        return Ok(law);
    }
    let left: f64 = law.residuals.iter().map(|r| r * r).sum();
    let variance = match law.residuals.len() - 2 {
        0 => f64::NAN,
        freedom => left / freedom as f64,
    };
    Ok(PowerLaw {
        prefactor_error: law.prefactor_error * variance.sqrt(),
        exponent_error: law.exponent_error * variance.sqrt(),
        covariance: law.covariance * variance,
        chi_square: None,
        ..law
    })
}

/// Fits y = a x^b with standard deviations of both x and y.
///
/// York's method for a straight line through points with independent errors \[York2004\], in ln y
/// against ln x with errors σ_y/y and σ_x/x, minimises
/// Σ (ln y − ln a − b ln x)²/((σ_y/y)² + b² (σ_x/x)²), the fit's chi-square. Errors follow from the
/// σ alone; `r_squared` and residuals are those of ln y. Errors of x may be 0.
///
/// # Errors
/// [`MeasureError::Lengths`], [`MeasureError::NotPositive`], [`MeasureError::TooFew`].
pub fn power_law_both_errors(
    abscissas: &[f64],
    abscissa_sigmas: &[f64],
    values: &[f64],
    sigmas: &[f64],
) -> Result<PowerLaw> {
    check(abscissas, &[values, sigmas], Some(abscissa_sigmas))?;
    let variances = |of: &[f64], sigmas: &[f64]| {
        let relative = of.iter().zip(sigmas).map(|(x, s)| s / x);
        relative.map(|relative: f64| relative.powi(2)).collect()
    };
    let points = LogPoints {
        x: abscissas.iter().map(|x| x.ln()).collect(),
        y: values.iter().map(|y| y.ln()).collect(),
        x_variance: variances(abscissas, abscissa_sigmas),
        y_variance: variances(values, sigmas),
    };
    points.fit().ok_or(MeasureError::TooFew)
}

struct LogPoints {
    x: Vec<f64>,
    y: Vec<f64>,
    x_variance: Vec<f64>,
    y_variance: Vec<f64>,
}

/// Weights, weighted means and York's adjusted departures for one slope.
struct YorkWeights {
    weights: Vec<f64>,
    total: f64,
    mean_x: f64,
    mean_y: f64,
    /// Adjusted abscissas, less their mean: where on the line each point belongs.
    adjusted: Vec<f64>,
}

impl LogPoints {
    fn weigh(&self, slope: f64) -> YorkWeights {
        let variances = self.x_variance.iter().zip(&self.y_variance);
        let weights = variances.map(|(x, y)| (y + slope * slope * x).recip());
        let weights: Vec<f64> = weights.collect();
        let total: f64 = weights.iter().sum();
        let mean_x = dot(&weights, &self.x) / total;
        let mean_y = dot(&weights, &self.y) / total;
        let adjusted = (0..self.x.len()).map(|i| {
            let (u, v) = (self.x[i] - mean_x, self.y[i] - mean_y);
            weights[i] * (u * self.y_variance[i] + slope * v * self.x_variance[i])
        });
        YorkWeights { adjusted: adjusted.collect(), weights, total, mean_x, mean_y }
    }

    /// Σ W β V / Σ W β U.
    fn next_slope(&self, at: &YorkWeights) -> f64 {
        let (mut above, mut below) = (0.0, 0.0);
        for (i, beta) in at.adjusted.iter().enumerate() {
            let part = at.weights[i] * beta;
            above += part * (self.y[i] - at.mean_y);
            below += part * (self.x[i] - at.mean_x);
        }
        above / below
    }

    /// `None` without two abscissas.
    fn fit(&self) -> Option<PowerLaw> {
        if all_equal(&self.x) {
            return None;
        }
        // Without errors of x the first step is ordinary weighted least squares.
        let mut slope = 0.0;
        for _ in 0..200 {
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
        let shift = dot(&at.weights, &at.adjusted) / at.total;
        let spread = at.adjusted.iter().map(|beta| (beta - shift).powi(2));
        let spread: f64 = spread.zip(&at.weights).map(|(s, w)| s * w).sum();
        let centre = at.mean_x + shift;
        let level_variance = at.total.recip() + centre * centre / spread;
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
            chi_square: ChiSquare::of(left, residuals.len() - 2, 1.0),
            residuals,
        }
    }
}

fn dot(weights: &[f64], of: &[f64]) -> f64 {
    weights.iter().zip(of).map(|(w, x)| w * x).sum()
}

fn all_equal(x: &[f64]) -> bool {
    x.iter().all(|other| *other == x[0])
}

/// Bounds on the errors of an unweighted power law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncertainty {
    /// Largest relative error of the prefactor.
    pub prefactor_relative: f64,
    /// Largest error of the exponent.
    pub exponent: f64,
}

/// Bounds on the errors of an unweighted [`power_law`] through values that are right to `relative`
/// errors.
///
/// Not standard errors: ln a = Σ cᵢ ln yᵢ and b = Σ dᵢ ln yᵢ, so the bounds are Σ |cᵢ| εᵢ and
/// Σ |dᵢ| εᵢ. Errors of one method mostly have one sign and do not average out.
///
/// # Errors
/// As [`power_law_both_errors`]; relative errors may be 0.
pub fn uncertainty(abscissas: &[f64], relative: &[f64]) -> Result<Uncertainty> {
    check(abscissas, &[], Some(relative))?;
    let x: Vec<f64> = abscissas.iter().map(|x| x.ln()).collect();
    if all_equal(&x) {
        return Err(MeasureError::TooFew);
    }
    let n = x.len() as f64;
    let mean = x.iter().sum::<f64>() / n;
    let spread: f64 = x.iter().map(|x| (x - mean).powi(2)).sum();
    let slope = |x: &f64| (x - mean) / spread;
    let level = |x: &f64| n.recip() - mean * slope(x);
    let bound = |part: &dyn Fn(&f64) -> f64| {
        let parts = x.iter().zip(relative);
        parts.map(|(x, error)| part(x).abs() * error).sum()
    };
    Ok(Uncertainty { prefactor_relative: bound(&level), exponent: bound(&slope) })
}

/// Requires positive abscissas and values, errors of 0 or more, all of one length.
fn check(abscissas: &[f64], values: &[&[f64]], errors: Option<&[f64]>) -> Result<()> {
    for slice in values.iter().copied().chain(errors) {
        let (n, found) = (abscissas.len(), slice.len());
        if found != n {
            return Err(MeasureError::Lengths(format!(
                "{n} abscissas and {found} values or standard deviations do not pair up"
            )));
        }
    }
    let bad = |slice: &[f64], least_is_good: bool| {
        let good = |n: &f64| n.is_finite() && (*n > 0.0 || least_is_good && *n == 0.0);
        slice.iter().position(|n| !good(n))
    };
    let all = std::iter::once(abscissas).chain(values.iter().copied());
    let index = all.map(|slice| bad(slice, false)).find_map(|found| found);
    let index = index.or_else(|| bad(errors?, true));
    index.map_or(Ok(()), |index| Err(MeasureError::NotPositive(index)))
}
