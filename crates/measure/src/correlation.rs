//! Correlation of the errors of incident and reflected times of flight, which share the wall's pick.

use crate::SpeedRow;
use crate::signal::{Estimate, Flight, Ratio};

/// Covariance of two means over shots, and what is known of each shot alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pairs {
    /// Shots with both times, and those of which the first mean is.
    shots: (usize, usize),
    /// Covariance of both means by the scatter of shots; 0 if there are too few.
    scatter: f64,
    /// The same as far as errors of picking make it.
    pub picking: f64,
}

impl Pairs {
    /// Of pairs of times in s with the covariance of each pair's picking, among `all` shots
    /// with the first time: the second mean is of these pairs alone.
    pub(crate) fn new(pairs: &[([f64; 2], f64)], all: usize) -> Self {
        let count = pairs.len() as f64;
        let mean = |at: usize| pairs.iter().map(|(pair, _)| pair[at]).sum::<f64>() / count;
        let [first, second] = [mean(0), mean(1)];
        let products = pairs.iter().map(|(pair, _)| (pair[0] - first) * (pair[1] - second));
        let scatter = match pairs.len() {
            0 | 1 => 0.0,
            _ => products.sum::<f64>() / (count - 1.0) / all as f64,
        };
        let picking: f64 = pairs.iter().map(|(_, covariance)| covariance).sum();
        Self {
            shots: (pairs.len(), all),
            scatter,
            picking: match pairs.is_empty() {
                true => 0.0,
                false => picking / count / all as f64,
            },
        }
    }

    /// Covariance of what scatters beyond picking, of which each mean has this variance.
    /// `of_speed` is the part of the scatter that speeds account for.
    pub(crate) fn excess(&self, of_speed: f64, variances: [f64; 2]) -> f64 {
        let most = (variances[0] * variances[1]).sqrt();
        let found = (self.scatter - of_speed - self.picking).clamp(-most, most);
        self.certain() * found
    }

    /// Correlation of the plain means, whose standard errors are those of the scatter and of what
    /// all shots share; one shot's own covariance holds it.
    pub(crate) fn of_means(&self, errors: [f64; 2], shared_s2: f64) -> Option<f64> {
        let covariance = match self.shots.0 > 1 {
            true => self.certain() * self.scatter + shared_s2,
            false => self.picking,
        };
        correlation(covariance, errors)
    }

    /// Two shots leave their correlation at ±1 whatever it is, many determine it: (n − 2)/(n − 1).
    fn certain(&self) -> f64 {
        let count = self.shots.0 as f64;
        ((count - 2.0) / (count - 1.0)).max(0.0)
    }
}

/// Covariance over both standard errors, if both are above 0.
pub(crate) fn correlation(covariance: f64, errors: [f64; 2]) -> Option<f64> {
    let product = errors[0] * errors[1];
    let known = product > 0.0 && covariance.is_finite() && product.is_finite();
    known.then(|| (covariance / product).clamp(-1.0, 1.0))
}

/// The part in s² of the covariance of both means that all shots share: what moves the wall's
/// pulse in all of them, and an error of the sampling interval.
pub(crate) fn shared_s2(flights: &[&Flight]) -> f64 {
    let count = flights.len().max(1) as f64;
    let mean = |of: &dyn Fn(&Flight) -> f64| flights.iter().map(|f| of(f)).sum::<f64>() / count;
    let under = mean(&|flight| flight.picks.wall.systematic.superposition_s);
    let shape = mean(&|flight| flight.picks.wall.systematic.shape_s);
    let [forth, back] = [0, 1]
        .map(|at| mean(&|f| f.interval_error * f.times_s()[at].map_or(0.0, |time| time.value)));
    forth * back - under.powi(2) - shape.powi(2)
}

/// Correlations of the ratios of incident and of reflected times, for each of the former; both
/// rows' errors and those of their speeds count, by `exponent`.
pub(crate) fn of_ratios(
    (upper, lower): (&[SpeedRow], &[SpeedRow]),
    (incident, reflected): (&[Ratio], &[Ratio]),
    exponent: f64,
) -> Vec<Option<f64>> {
    let one = |ratio: &Ratio| {
        let other = reflected.iter().find(|other| other.speed == ratio.speed)?;
        let pairs = upper.iter().flat_map(|u| lower.iter().map(move |l| (u, l)));
        let midpoint = |(u, l): &(&SpeedRow, &SpeedRow)| {
            f64::midpoint(u.speed_m_s.value, l.speed_m_s.value) == ratio.speed
        };
        let (u, l) = pairs.into_iter().find(midpoint)?;
        let of_speed = |row: &SpeedRow| exponent * row.speed_m_s.sigma / row.speed_m_s.value;
        let of_rows = relative_covariance(u)? + relative_covariance(l)?;
        let covariance = of_rows + of_speed(u).powi(2) + of_speed(l).powi(2);
        let relative = |ratio: &Ratio| ratio.ratio.sigma / ratio.ratio.value;
        correlation(covariance, [relative(ratio), relative(other)])
    };
    incident.iter().map(one).collect()
}

fn relative_covariance(row: &SpeedRow) -> Option<f64> {
    let [forth, back] = row.at_mean_speed_s;
    let (forth, back) = (forth?, back?);
    let relative = |of: Estimate| of.sigma / of.value;
    Some(row.correlation_at_mean_speed? * relative(forth) * relative(back))
}

#[cfg(test)]
#[path = "tests/correlation.rs"]
mod tests;
