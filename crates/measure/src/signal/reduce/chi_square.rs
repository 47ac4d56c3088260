//! Points against a curve.

use crate::signal::Estimate;

/// How well points agree with a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquare {
    /// Σ ((measured − expected)/σ)².
    pub value: f64,
    /// Points less fitted parameters.
    pub freedom: usize,
    /// How often chance alone gives this value or a larger one.
    pub probability: f64,
}

/// Chi-square of measured points against a curve's values at the same places,
/// `fitted` parameters of which were found from these points.
///
/// `None` if the numbers of points differ, a number is not finite or a σ not
/// positive, or no degree of freedom is left.
#[must_use]
pub fn chi_square(measured: &[Estimate], expected: &[f64], fitted: usize) -> Option<ChiSquare> {
    let freedom = measured.len().checked_sub(fitted)?;
    let sound = measured.iter().all(|m| m.sigma > 0.0);
    if measured.len() != expected.len() || !sound {
        return None;
    }
    let pairs = measured.iter().zip(expected);
    let value: f64 = pairs
        .map(|(m, expected)| ((m.value - expected) / m.sigma).powi(2))
        .sum();
    ChiSquare::of(value, freedom)
}

impl ChiSquare {
    /// A sum of squares of so many independent standard errors, and how often chance alone
    /// makes it as large; `None` if it is not finite or no degree of freedom is left.
    #[must_use]
    pub fn of(value: f64, freedom: usize) -> Option<Self> {
        (value.is_finite() && freedom > 0).then(|| Self {
            value,
            freedom,
            probability: upper_gamma(0.5 * freedom as f64, 0.5 * value),
        })
    }
}

/// Regularised upper incomplete gamma function Q(a, x): the series of P below
/// a + 1, the continued fraction of Q (Lentz's method) above.
fn upper_gamma(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    let scale = (a * x.ln() - x - libm::lgamma(a)).exp();
    if x < a + 1.0 {
        1.0 - scale * series(a, x)
    } else {
        scale * fraction(a, x)
    }
}

/// Terms after which either expansion has long converged for up to 10⁵ degrees of freedom.
const TERMS: u32 = 100_000;

fn series(a: f64, x: f64) -> f64 {
    let (mut term, mut sum, mut n) = (a.recip(), a.recip(), a);
    for _ in 0..TERMS {
        n += 1.0;
        term *= x / n;
        sum += term;
        if term < sum * f64::EPSILON {
            break;
        }
    }
    sum
}

fn fraction(a: f64, x: f64) -> f64 {
    let mut b = x + 1.0 - a;
    let mut c = f64::MAX.sqrt();
    let mut d = b.recip();
    let mut product = d;
    for i in 1..TERMS {
        let n = f64::from(i);
        let term = -n * (n - a);
        b += 2.0;
        d = (term * d + b).recip();
        c = b + term / c;
        product *= c * d;
        if (c * d - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    product
}

#[cfg(test)]
#[path = "tests/chi_square.rs"]
mod tests;
