//! The bell of the pulses of several shots, its change with their heights, and what is a shot's own.

use super::log_polynomial::{
    BellData, BellTop, DEGREE, EXPONENT, INEXACT, SHAPE, ShapePrior, WHOLE_WIDTH, is_adequate,
};
use crate::signal::MOST_POLES;
use crate::signal::linear::{LinearSolution, LocalPolynomial, MOST, NormalEquations, powers};
use std::array::from_fn;
use std::f64::consts::LN_2;

/// The bell of the pulses of several shots, and how it changes with their heights.
pub(super) struct CommonBell {
    polynomial: LocalPolynomial,
    /// Change of the coefficients over that of a height's logarithm.
    change: LinearSolution,
    prior: ShapePrior,
    /// Relative noise of a sample, and residuals of the bell that all shots share: over all of a mean.
    noise: (f64, f64),
    /// The same residuals of one shot.
    pub(super) inexact: f64,
}

impl CommonBell {
    /// Of points (u, height, logarithm of the shot's height over the mean) with so much noise of so
    /// many shots, over a share of the usual width, so many samples on either side; the search begins
    /// at another bell.
    pub(super) fn new(
        points: &[[f64; 3]],
        (noise, shots): (f64, f64),
        (prior, share, half): (ShapePrior, f64, f64),
        before: Option<&Self>,
    ) -> Option<Self> {
        // Noise averages out over shots, and what bells leave does not.
        let inexact = INEXACT.0 * share.powi(EXPONENT);
        let shared = shots.sqrt() * inexact;
        let changed = |u: f64, off: f64| {
            before.map_or(1.0, |bell| (off * bell.change.value(&powers(u))).exp())
        };
        let points_at_mean = points.iter().map(|[u, height, off]| (*u, height / changed(*u, *off)));
        let data = BellData {
            degree: DEGREE,
            points: points_at_mean.collect(),
            noise: noise.hypot(shared),
            prior,
            capped: false,
        };
        let mut start = [0.0; MOST];
        start[2] = -LN_2 * (WHOLE_WIDTH * share).powi(2);
        let start = before.map_or(start, |bell| bell.polynomial.solution.values);
        let polynomial = data.polynomial(&data.fit(start)?, 0.0, half)?;
        let change = change(points, &polynomial, &prior, data.noise)?;
        Some(Self { polynomial, change, prior, noise: (noise, shared), inexact })
    }

    pub(super) fn is_adequate(&self) -> bool {
        is_adequate(&self.polynomial, self.noise.0.hypot(self.inexact))
    }

    /// The bell of a shot of so high a pulse, as a logarithm over the mean.
    pub(super) fn of_shot(&self, off: f64) -> LocalPolynomial {
        let mut bell = self.polynomial.clone();
        bell.solution.values = from_fn(|k| bell.solution.values[k] + off * self.change.values[k]);
        bell
    }

    /// The maximum of such a shot's bell, with variances by noise, those by the change aside.
    pub(super) fn top(&self, inverse: [f64; MOST_POLES], off: f64) -> Option<BellTop> {
        let bell = self.of_shot(off);
        let (noise, inexact) = (self.noise.0.hypot(self.noise.1), self.noise.1);
        let at = (bell.maximum()?, inverse);
        let top = BellTop::new(&bell, at, &self.prior, (noise, inexact))?;
        let squared = noise * noise;
        Some(BellTop {
            height_variance: squared * top.height_variance,
            slope_variance: squared * top.slope_variance,
            open_variance: squared * top.open_variance,
            ..top
        })
    }

    /// The maximum of the mean bell, with variances by the change where a height's logarithm is 1
    /// above the mean.
    pub(super) fn top_of_change(&self, inverse: [f64; MOST_POLES]) -> Option<BellTop> {
        let mut bell = self.of_shot(0.0);
        bell.solution.inverse = self.change.inverse;
        BellTop::new(&bell, (bell.maximum()?, inverse), &self.prior, (1.0, 0.0))
    }

    /// Logarithm of the probability of a pulse's samples, but for a constant, if its shape differs from
    /// the common one by a share of the deviations of shapes; `normal` is of its samples in unit noise.
    pub(super) fn log_evidence(&self, normal: &NormalEquations, share: f64) -> Option<f64> {
        let of_prior = (SHAPE..MOST).map(|k| (self.prior.root[k][k] / share).ln()).sum::<f64>();
        Some(with_prior(normal, &self.prior, share).log_evidence()? + of_prior)
    }

    /// The maximum of such a shot's own bell, with variances by noise.
    pub(super) fn own_top(
        &self,
        normal: &NormalEquations,
        (off, share): (f64, f64),
        inverse: [f64; MOST_POLES],
    ) -> Option<BellTop> {
        let own = with_prior(normal, &self.prior, share).solve()?;
        let mut bell = self.of_shot(off);
        bell.solution.values = from_fn(|k| bell.solution.values[k] + own.values[k]);
        bell.solution.inverse = own.inverse;
        BellTop::new(&bell, (bell.maximum()?, inverse), &self.prior, (1.0, 0.0))
    }
}

/// Least squares of the change of a bell's coefficients over that of a height's logarithm, with
/// variances by noise.
fn change(
    points: &[[f64; 3]],
    bell: &LocalPolynomial,
    prior: &ShapePrior,
    noise: f64,
) -> Option<LinearSolution> {
    let mut normal = NormalEquations::new(MOST);
    for [u, height, off] in points {
        let value = bell.at(*u).value.exp();
        normal.add(&powers(*u).map(|power| off * value * power / noise), (height - value) / noise);
    }
    with_prior(&normal, prior, prior.change).solve()
}

/// With a share of the deviations of shapes as prior; of the first coefficients it is 1.
fn with_prior(normal: &NormalEquations, prior: &ShapePrior, share: f64) -> NormalEquations {
    let mut normal = normal.clone();
    for k in 0..MOST {
        let mut row = prior.root[k].map(|x| x / share);
        row[k] = if k < SHAPE { 1.0 } else { row[k] };
        normal.add(&row, 0.0);
    }
    normal
}
