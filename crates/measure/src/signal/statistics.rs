//! Robust and weighted means, chi-square, coverage, and ratios of curves.

/// A number with its standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its standard deviation, in the same unit.
    pub sigma: f64,
}

impl Estimate {
    pub(crate) fn widen(&mut self, relative: f64) {
        self.sigma = self.sigma.hypot(relative * self.value);
    }

    /// Quotient of two independent numbers, errors to first order.
    pub(crate) fn over(self, other: Self) -> Self {
        let value = self.value / other.value;
        let sigma = (self.sigma / other.value).hypot(value * other.sigma / other.value);
        Self { value, sigma }
    }
}

/// Standard deviation over median absolute deviation, normal distribution.
pub(crate) const NORMAL_MAD: f64 = 1.482_602_218_505_602;

/// Median by partial sorting; the lower middle one of an even number. `None` without values.
pub fn median(values: &[f64]) -> Option<f64> {
    let mut values = values.to_vec();
    let middle = values.len().checked_sub(1)? / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

pub(crate) fn squares_about_mean(values: &[f64]) -> f64 {
    let mean = mean(values);
    values.iter().map(|value| (value - mean).powi(2)).sum()
}

/// Least and largest number, eight lanes at a time; 0 of none.
pub(crate) fn extremes(samples: &[f64]) -> (f64, f64) {
    let start = samples.first().copied().unwrap_or(0.0);
    let (mut low, mut high) = ([start; 8], [start; 8]);
    let (whole, rest) = samples.as_chunks::<8>();
    for chunk in whole {
        for (lane, x) in chunk.iter().enumerate() {
            low[lane] = if *x < low[lane] { *x } else { low[lane] };
            high[lane] = if *x > high[lane] { *x } else { high[lane] };
        }
    }
    let low = low.iter().chain(rest).copied().fold(start, f64::min);
    let high = high.iter().chain(rest).copied().fold(start, f64::max);
    (low, high)
}

pub(crate) fn median_and_spread(values: &[f64]) -> Option<(f64, f64)> {
    let centre = median(values)?;
    let far: Vec<f64> = values.iter().map(|x| (x - centre).abs()).collect();
    Some((centre, NORMAL_MAD * median(&far)?))
}

/// Mean and spread of repeated measurements of one quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Number of measurements.
    pub count: usize,
    /// Their mean.
    pub mean: f64,
    /// Standard deviation of one, with n − 1; not a number for one alone.
    pub deviation: f64,
    /// Standard error of the mean, deviation/√n; of one alone, its own sigma.
    pub error: f64,
    /// Mean weighted by 1/σ², with the error that follows from the σ alone.
    /// Equal to mean and error where a σ is 0 or not finite.
    pub weighted: Estimate,
    /// Σ ((x − weighted mean)/σ)²; near count − 1 if the σ explain the spread.
    pub chi_square: f64,
}

impl Summary {
    /// Adds an error of all measurements to those of their means; of one alone it is in its own.
    pub(crate) fn share(&mut self, error: f64) {
        if self.count > 1 && error.is_finite() {
            self.error = self.error.hypot(error);
            self.weighted.sigma = self.weighted.sigma.hypot(error);
        }
    }
}

/// Summarises the finite ones of some measurements; `None` if there is none.
///
/// The plain mean and its error describe what varies from shot to shot, the weighted ones what the
/// σ describe. Where chi-square is far above count − 1, the plain ones are the right ones.
pub fn summary(measured: &[Estimate]) -> Option<Summary> {
    let finite = measured.iter().filter(|m| m.value.is_finite());
    let finite: Vec<Estimate> = finite.copied().collect();
    let count = finite.len();
    let first = finite.first()?;
    let n = count as f64;
    // About the first: differences keep the digits of a small spread.
    let mean = first.value + finite.iter().map(|m| m.value - first.value).sum::<f64>() / n;
    let squares: f64 = finite.iter().map(|m| (m.value - mean).powi(2)).sum();
    let deviation = (squares / (n - 1.0)).sqrt();
    let error = match count {
        1 => first.sigma,
        _ => deviation / n.sqrt(),
    };
    let plain = Estimate { value: mean, sigma: error };
    let (weighted, chi_square) = weighted(&finite, mean).unwrap_or((plain, f64::NAN));
    Some(Summary { count, mean, deviation, error, weighted, chi_square })
}

fn weighted(measured: &[Estimate], about: f64) -> Option<(Estimate, f64)> {
    let weight = |m: &Estimate| m.sigma.powi(2).recip();
    let all: f64 = measured.iter().map(weight).sum();
    if !all.is_finite() || all <= 0.0 {
        return None;
    }
    let shift: f64 = measured.iter().map(|m| weight(m) * (m.value - about)).sum();
    let value = about + shift / all;
    let squares = measured.iter().map(|m| weight(m) * (m.value - value).powi(2));
    let sigma = all.recip().sqrt();
    Some((Estimate { value, sigma }, squares.sum()))
}

/// Agreement of points with a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquare {
    /// Σ ((measured − expected)/σ)².
    pub value: f64,
    /// Points less fitted parameters.
    pub freedom: usize,
    /// Probability of this value or a larger one by chance alone.
    pub probability: f64,
}

/// Chi-square of measured points against a curve's values at the same abscissas, `fitted` of whose
/// parameters were found from these points.
///
/// `None` if the numbers of points differ, a number is not finite or a σ not positive, or no degree
/// of freedom is left.
pub fn chi_square(measured: &[Estimate], expected: &[f64], fitted: usize) -> Option<ChiSquare> {
    let freedom = measured.len().checked_sub(fitted)?;
    if measured.len() != expected.len() || !measured.iter().all(|m| m.sigma > 0.0) {
        return None;
    }
    let pairs = measured.iter().zip(expected);
    let squares = pairs.map(|(m, expected)| ((m.value - expected) / m.sigma).powi(2));
    ChiSquare::of(squares.sum(), freedom, 1.0)
}

impl ChiSquare {
    /// A sum of squares of deviates with its probability; `None` if it is not finite or no degree of
    /// freedom is left. The squares have mean 1 and `spread` times the variance of those of normal
    /// deviates, and their sum is taken for a multiple of a chi-square variable [Satterthwaite1946].
    pub fn of(value: f64, freedom: usize, spread: f64) -> Option<Self> {
        (value.is_finite() && freedom > 0).then(|| Self {
            value,
            freedom,
            probability: upper_gamma(0.5 * freedom as f64 / spread, 0.5 * value / spread),
        })
    }
}

/// Regularised upper incomplete gamma function Q(a, x): the series of P below
/// a + 1, the continued fraction of Q (Lentz's method) above.
fn upper_gamma(a: f64, x: f64) -> f64 {
    // Either expansion converges long before this for up to 10⁵ degrees of freedom.
    const TERMS: u32 = 100_000;
    if x <= 0.0 {
        return 1.0;
    }
    let scale = (a * x.ln() - x - libm::lgamma(a)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (a.recip(), a.recip(), a);
        for _ in 0..TERMS {
            n += 1.0;
            term *= x / n;
            sum += term;
            if term < sum * f64::EPSILON {
                break;
            }
        }
        return 1.0 - scale * sum;
    }
    let mut b = x + 1.0 - a;
    let mut c = f64::MAX.sqrt();
    let mut d = b.recip();
    let mut product = d;
    for n in (1..TERMS).map(f64::from) {
        let term = -n * (n - a);
        b += 2.0;
        d = (term * d + b).recip();
        c = b + term / c;
        product *= c * d;
        if (c * d - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    scale * product
}

/// Number of intervals that hold the true value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    /// Intervals that hold it.
    pub inside: usize,
    /// All intervals.
    pub count: usize,
    /// Their quotient.
    pub share: f64,
    /// Share for normal errors of the stated size: erf(factor/√2).
    pub expected: f64,
    /// Standard deviation of the share by chance, √(expected (1 − expected)/count).
    pub chance: f64,
    /// Root mean square of error over stated σ: 1 if the σ are right.
    pub scale: f64,
}

/// Coverage of intervals ± `factor` σ, from pulls (measured − true)/σ.
///
/// A pull that is not a number counts as outside. `None` without pulls.
pub fn coverage(pulls: &[f64], factor: f64) -> Option<Coverage> {
    let count = pulls.len();
    let inside = pulls.iter().filter(|pull| pull.abs() <= factor).count();
    let expected = libm::erf(factor / std::f64::consts::SQRT_2);
    let n = count as f64;
    let squares: f64 = pulls.iter().map(|pull| pull * pull).sum();
    (count > 0).then(|| Coverage {
        inside,
        count,
        share: inside as f64 / n,
        expected,
        chance: (expected * (1.0 - expected) / n).sqrt(),
        scale: (squares / n).sqrt(),
    })
}

/// Groups shots by speed: a new group begins wherever the next higher speed is more than `gap` away.
///
/// Speeds that are each near their neighbour make one group, however long: group by programmed
/// speeds if measured ones run into each other. Groups, and the shots' numbers in each, are in
/// order of speed. Speeds that are not finite belong to none.
pub fn groups(speeds: &[f64], gap: f64) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..speeds.len()).collect();
    order.retain(|shot| speeds[*shot].is_finite());
    order.sort_by(|a, b| speeds[*a].total_cmp(&speeds[*b]));
    let same = |a: &usize, b: &usize| speeds[*b] - speeds[*a] <= gap;
    order.chunk_by(same).map(<[usize]>::to_vec).collect()
}

/// A point of a curve with errors in both coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Speed.
    pub speed: Estimate,
    /// Value measured at that speed.
    pub value: Estimate,
}

/// Ratio of two curves at one speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// Mean of both speeds.
    pub speed: f64,
    /// Upper over lower.
    pub ratio: Estimate,
}

/// Ratios upper/lower wherever both curves have speeds at most `gap` apart.
///
/// Values scale as speed^`exponent` nearly (−0.2 for times of flight in Hertz chains): this removes
/// what is left of a difference of speeds and carries both speeds' errors into the ratio's:
/// (σ_r/r)² = (σ_u/u)² + (σ_l/l)² + exponent² ((σ_v,u/v_u)² + (σ_v,l/v_l)²).
/// Give 0 if speeds' errors are already in the values'. Each upper point is divided by the nearest
/// lower one.
pub(crate) fn ratios_at_common(
    upper: &[Point],
    lower: &[Point],
    gap: f64,
    exponent: f64,
) -> Vec<Ratio> {
    let ratio = |u: &Point| {
        let apart = |l: &Point| (l.speed.value - u.speed.value).abs();
        let near = lower.iter().filter(|l| apart(l) <= gap);
        let l = near.min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        let plain = u.value.over(l.value);
        let speeds = u.speed.over(l.speed);
        let value = plain.value * speeds.value.powf(-exponent);
        let of_speeds = exponent * speeds.sigma / speeds.value;
        let sigma = value.abs() * (plain.sigma / plain.value).hypot(of_speeds);
        value.is_finite().then(|| Ratio {
            speed: f64::midpoint(u.speed.value, l.speed.value),
            ratio: Estimate { value, sigma },
        })
    };
    upper.iter().filter_map(ratio).collect()
}

#[cfg(test)]
#[path = "tests/chi_square.rs"]
mod tests;
