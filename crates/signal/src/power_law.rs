//! Power laws by least squares in the logarithms.

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
}

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
    check(abscissas, values, sigmas)?;
    let x: Vec<f64> = abscissas.iter().map(|x| x.ln()).collect();
    let y: Vec<f64> = values.iter().map(|y| y.ln()).collect();
    let weights: Vec<f64> = match sigmas {
        Some(sigmas) => values
            .iter()
            .zip(sigmas)
            .map(|(y, s)| (y / s).powi(2))
            .collect(),
        None => vec![1.0; x.len()],
    };
    let line = Line::through(&x, &y, &weights).ok_or(FitError::TooFew)?;
    Ok(line.power_law(&x, &y, &weights, sigmas.is_some()))
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
    if relative.len() != abscissas.len() {
        return Err(FitError::Lengths {
            abscissas: abscissas.len(),
            values: relative.len(),
        });
    }
    let bad = relative.iter().position(|e| !(*e >= 0.0 && e.is_finite()));
    if let Some(index) = bad {
        return Err(FitError::NotPositive { index });
    }
    let x: Vec<f64> = abscissas.iter().map(|x| x.ln()).collect();
    let weights = vec![1.0; x.len()];
    let line = Line::through(&x, &x, &weights).ok_or(FitError::TooFew)?;
    let slope = |x: &f64| (x - line.mean_x) / line.spread_x;
    let level = |x: &f64| line.weight.recip() - line.mean_x * slope(x);
    let bound = |part: &dyn Fn(&f64) -> f64| {
        let parts = x.iter().zip(relative);
        parts.map(|(x, error)| part(x).abs() * error).sum()
    };
    Ok(Uncertainty {
        prefactor_relative: bound(&level),
        exponent: bound(&slope),
    })
}

pub(crate) fn check(
    abscissas: &[f64],
    values: &[f64],
    sigmas: Option<&[f64]>,
) -> Result<(), FitError> {
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

/// A weighted straight line y = intercept + slope · x, about the weighted means.
struct Line {
    weight: f64,
    mean_x: f64,
    mean_y: f64,
    spread_x: f64,
    slope: f64,
}

impl Line {
    fn through(x: &[f64], y: &[f64], weights: &[f64]) -> Option<Self> {
        let weight: f64 = weights.iter().sum();
        let mean = |of: &[f64]| weighted(of, weights) / weight;
        let (mean_x, mean_y) = (mean(x), mean(y));
        let (mut spread_x, mut together) = (0.0, 0.0);
        for ((x, y), w) in x.iter().zip(y).zip(weights) {
            spread_x += w * (x - mean_x).powi(2);
            together += w * (x - mean_x) * (y - mean_y);
        }
        // Equal abscissas leave nothing but rounding.
        let differ = x.iter().any(|other| *other != x[0]);
        (differ && spread_x > 0.0).then(|| Self {
            weight,
            mean_x,
            mean_y,
            spread_x,
            slope: together / spread_x,
        })
    }

    fn power_law(&self, x: &[f64], y: &[f64], weights: &[f64], known_errors: bool) -> PowerLaw {
        let residual = |(x, y): (&f64, &f64)| (y - self.mean_y) - self.slope * (x - self.mean_x);
        let residuals: Vec<f64> = x.iter().zip(y).map(residual).collect();
        let squares: Vec<f64> = residuals.iter().map(|r| r * r).collect();
        let left = weighted(&squares, weights);
        let spread_y: Vec<f64> = y.iter().map(|y| (y - self.mean_y).powi(2)).collect();
        let all = weighted(&spread_y, weights);
        let variance = match (known_errors, x.len() - 2) {
            (true, _) => 1.0,
            (false, 0) => f64::NAN,
            (false, freedom) => left / freedom as f64,
        };
        let prefactor = (self.mean_y - self.slope * self.mean_x).exp();
        let log_variance =
            variance * (self.weight.recip() + self.mean_x * self.mean_x / self.spread_x);
        PowerLaw {
            prefactor,
            exponent: self.slope,
            prefactor_error: prefactor * log_variance.sqrt(),
            exponent_error: (variance / self.spread_x).sqrt(),
            covariance: -variance * self.mean_x / self.spread_x,
            r_squared: if all > 0.0 { 1.0 - left / all } else { 1.0 },
            residuals,
        }
    }
}

fn weighted(of: &[f64], weights: &[f64]) -> f64 {
    of.iter()
        .zip(weights)
        .map(|(value, weight)| value * weight)
        .sum()
}
