//! Power laws by least squares in the logarithms.

use crate::signal::reduce::{ChiSquare, Points, all_equal};

/// y = `prefactor` · x^`exponent`, with how sure that is.
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
    /// Of the points against the law, in their own errors; none where these are not
    /// known, or two points leave nothing to judge.
    pub chi_square: Option<ChiSquare>,
}

/// Probability of chi-square below which points do not follow a law.
const UNLIKELY: f64 = 0.01;

impl PowerLaw {
    /// The law's value.
    #[must_use]
    pub fn at(&self, x: f64) -> f64 {
        self.prefactor * x.powf(self.exponent)
    }

    /// Largest |y / law − 1| over the fitted points.
    #[must_use]
    pub fn largest_deviation(&self) -> f64 {
        let relative = self.residuals.iter().map(|r| r.exp_m1().abs());
        relative.fold(0.0, f64::max)
    }

    /// Whether the points follow the law within their errors: chance alone would
    /// scatter them as widely once in a hundred times or more. `None` if nobody can tell.
    #[must_use]
    pub fn is_supported(&self) -> Option<bool> {
        let judged = self.chi_square.as_ref();
        judged.map(|chi_square| chi_square.probability >= UNLIKELY)
    }

    /// What the errors must be multiplied by to be as large as the points' scatter
    /// about the law, √(χ²/degrees of freedom); 1 if they are large enough, or not judged.
    #[must_use]
    pub fn excess(&self) -> f64 {
        let reduced = |c: &ChiSquare| c.value / c.freedom as f64;
        self.chi_square
            .as_ref()
            .map_or(1.0, |c| reduced(c).sqrt().max(1.0))
    }

    /// With errors of points that are `variance` times as large, squared, and found
    /// from the points themselves.
    fn scattered(self, variance: f64) -> Self {
        Self {
            prefactor_error: self.prefactor_error * variance.sqrt(),
            exponent_error: self.exponent_error * variance.sqrt(),
            covariance: self.covariance * variance,
            chi_square: None,
            ..self
        }
    }
}

/// Why no power law can be fitted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// Slices of different lengths.
    #[error("{abscissas} abscissas and {values} values or standard deviations do not pair up")]
    Lengths {
        /// Number of abscissas.
        abscissas: usize,
        /// Number of values or standard deviations.
        values: usize,
    },
    /// Two parameters need points at three abscissas to have an error, two to exist.
    #[error("a power law needs at least two different abscissas")]
    TooFew,
    /// Logarithms need positive numbers.
    #[error("point {index} is not positive and finite")]
    NotPositive {
        /// Which point, from 0.
        index: usize,
    },
}

/// Fits y = a x^b by least squares in ln y against ln x.
///
/// With `sigmas`, standard deviations of the values, points are weighted by
/// (y/σ)² and errors follow from the σ alone; without, all weigh the same
/// and errors follow from the scatter with n − 2 degrees of freedom (not a
/// number when n = 2: two points lie on a line and tell no error).
///
/// # Errors
/// See [`FitError`].
pub fn power_law(
    abscissas: &[f64],
    values: &[f64],
    sigmas: Option<&[f64]>,
) -> Result<PowerLaw, FitError> {
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
    Ok(law.scattered(variance))
}

/// Fits y = a x^b with standard deviations of both x and y.
///
/// York's method for a straight line through points with independent errors
/// \[York2004\], in ln y against ln x with errors σ_y/y and σ_x/x: it makes
/// Σ (ln y − ln a − b ln x)²/((σ_y/y)² + b² (σ_x/x)²) least. That sum is the fit's
/// chi-square. Errors follow from the σ alone; `r_squared` and residuals are
/// those of ln y. Errors of x may be 0.
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
    check_not_negative(abscissas, abscissa_sigmas)?;
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
    points.fit().ok_or(FitError::TooFew)
}

fn logarithms(of: &[f64]) -> Vec<f64> {
    of.iter().map(|x| x.ln()).collect()
}

/// How far a fitted law can be off because of errors of its values alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncertainty {
    /// Largest relative error of the prefactor.
    pub prefactor_relative: f64,
    /// Largest error of the exponent.
    pub exponent: f64,
}

/// What values that are right to `relative` errors leave open in an unweighted
/// [`power_law`].
///
/// A bound, not a standard error: ln a = Σ cᵢ ln yᵢ and b = Σ dᵢ ln yᵢ, so it is
/// Σ |cᵢ| εᵢ and Σ |dᵢ| εᵢ. Errors of one method mostly have one sign and do not
/// average out.
///
/// # Errors
/// See [`FitError`]; relative errors may be 0.
pub fn uncertainty(abscissas: &[f64], relative: &[f64]) -> Result<Uncertainty, FitError> {
    check(abscissas, abscissas, None)?;
    check_not_negative(abscissas, relative)?;
    let x = logarithms(abscissas);
    let n = x.len() as f64;
    let mean = x.iter().sum::<f64>() / n;
    let spread: f64 = x.iter().map(|x| (x - mean).powi(2)).sum();
    if all_equal(&x) {
        return Err(FitError::TooFew);
    }
    let slope = |x: &f64| (x - mean) / spread;
    let level = |x: &f64| n.recip() - mean * slope(x);
    let bound = |part: &dyn Fn(&f64) -> f64| {
        let parts = x.iter().zip(relative);
        parts.map(|(x, error)| part(x).abs() * error).sum()
    };
    Ok(Uncertainty {
        prefactor_relative: bound(&level),
        exponent: bound(&slope),
    })
}

fn check(abscissas: &[f64], values: &[f64], sigmas: Option<&[f64]>) -> Result<(), FitError> {
    for slice in [Some(values), sigmas].into_iter().flatten() {
        if slice.len() != abscissas.len() {
            return Err(FitError::Lengths {
                abscissas: abscissas.len(),
                values: slice.len(),
            });
        }
    }
    for slice in [Some(abscissas), Some(values), sigmas]
        .into_iter()
        .flatten()
    {
        let bad = slice.iter().position(|n| !(*n > 0.0 && n.is_finite()));
        if let Some(index) = bad {
            return Err(FitError::NotPositive { index });
        }
    }
    Ok(())
}

/// Errors that may be 0, one an abscissa.
fn check_not_negative(abscissas: &[f64], errors: &[f64]) -> Result<(), FitError> {
    if errors.len() != abscissas.len() {
        return Err(FitError::Lengths {
            abscissas: abscissas.len(),
            values: errors.len(),
        });
    }
    let bad = errors.iter().position(|s| !(*s >= 0.0 && s.is_finite()));
    bad.map_or(Ok(()), |index| Err(FitError::NotPositive { index }))
}
