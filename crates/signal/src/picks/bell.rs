//! Maximum of a bell whose skewness and flatness are free.

use super::flanks::Flanks;
use super::local_model::{Top, finish};
use super::normal::{Descent, MOST, Normal, descend};
use super::polynomial::{Polynomial, powers, slope_row};
use super::{Picked, Sight};
use crate::Pulse;

/// Full width of the fit in widths of the steeper flank: down to a third of the maximum.
const WIDTH: f64 = 1.2;
/// Degree of the logarithm: pulses of computed dry and wet rows between 0.1 and
/// 1.2 m/s are followed to 30 ns.
const DEGREE: usize = MOST - 1;
/// How large even coefficients may be where nothing shows them.
const NEARLY_NONE: f64 = 0.1;
/// The first coefficient that makes a bell other than a Gaussian.
const SHAPE: usize = 3;
/// Deviations by which the squares that a fit leaves may exceed those of noise.
const ADEQUATE: f64 = 3.0;

/// Time in samples, by y = exp(Σ c_k u^k) with u from −1 to 1 across the fit.
///
/// The logarithm of a bell is nearly a parabola, so few coefficients tell much.
/// Those beyond it are taken to be 0 ± 1 before the samples are looked at: noise
/// leaves them there, a strong signal moves them. So one model goes all the way from smooth to
/// close, and the stated error holds what it does not know of the shape.
/// Where more is left than noise, the error grows by as much.
pub(super) fn pick(sight: &Sight<'_>, pulse: &Pulse) -> Option<Picked> {
    let begun = pulse.at as f64;
    let half = (0.5 * WIDTH * pulse.steep_width_samples()).max(4.0);
    let thought = [1.0; MOST];
    about(sight, pulse, begun, &Window { half, thought })
}

/// As [`pick`], of a pulse whose top is clipped: its flanks are fitted, farther down, and
/// what lies between them is what bells have there. The stated error holds how little
/// that is known. Where noise gives them no top, flanks are thought to be those of a flatter or
/// steeper Gaussian, which hardly moves a maximum: as skewed as they like, but else no other shape.
pub(super) fn from_flanks(sight: &Sight<'_>, pulse: &Pulse) -> Option<Picked> {
    let flanks = Flanks::of(sight, pulse)?;
    let whole = flanks.pulse(pulse);
    let half = flanks.half(pulse);
    let widths = half / whole.width_samples / (0.5 * WIDTH);
    let tries = [1.0, NEARLY_NONE].into_iter();
    let mut tries = tries.map(|even| Window {
        half,
        thought: thought(widths, even),
    });
    tries.find_map(|window| about(sight, &whole, flanks.at, &window))
}

/// Where a bell is fitted, and what is thought of it beforehand.
struct Window {
    /// Samples from the middle to either end.
    half: f64,
    /// How large coefficients may be.
    thought: [f64; MOST],
}

/// How large each coefficient may be over so many times the usual width, over which it is 1;
/// even ones beyond a Gaussian's by another factor.
fn thought(widths: f64, even: f64) -> [f64; MOST] {
    let mut thought = powers(widths);
    thought
        .iter_mut()
        .skip(SHAPE + 1)
        .step_by(2)
        .for_each(|one| *one *= even);
    thought
}

/// The bell's maximum, looked for from `begun` on.
fn about(sight: &Sight<'_>, pulse: &Pulse, begun: f64, window: &Window) -> Option<Picked> {
    let noise = sight.broad_noise(pulse);
    let mut centre = begun;
    for _ in 0..4 {
        let (fit, u) = fit(sight, pulse, centre, window, noise)?;
        let next = fit.sample(u).round();
        if (next - begun).abs() > window.half {
            return None;
        }
        if (next - centre).abs() <= 0.1 * window.half {
            return Some(picked(sight, pulse, &fit, u, &window.thought));
        }
        centre = next;
    }
    None
}

/// At the top the logarithm's slope is 0, so slope and bend of the pulse itself
/// are its height times those of the logarithm.
fn picked(
    sight: &Sight<'_>,
    pulse: &Pulse,
    fit: &Polynomial,
    u: f64,
    thought: &[f64; MOST],
) -> Picked {
    let at = fit.course(u);
    let height = at.value.exp();
    let noise = sight.noise(pulse);
    let beyond = (fit.left / noise).powi(2) > 1.0 + ADEQUATE * (2.0 / fit.freedom).sqrt();
    let excess = if beyond { fit.left / noise } else { 1.0 };
    let top = Top {
        height,
        height_share: height * fit.value_variance(u).sqrt() * excess,
        slope_share: height * fit.slope_variance(u).sqrt() * excess,
        bend: height * at.bend,
        bend_share: height * fit.bend_variance(u).sqrt() * excess,
        open_share: height
            * open_variance(fit, u, sight.broad_noise(pulse), thought).sqrt()
            * excess,
    };
    finish(sight, pulse, fit, u, &top)
}

/// Variance of the slope at u, for unit noise, by coefficients that may be other than the 0 they
/// are thought to be: C P C with C the covariance and P what is thought beforehand.
fn open_variance(fit: &Polynomial, u: f64, noise: f64, thought: &[f64; MOST]) -> f64 {
    let along = fit.solution.covariance_with(&slope_row(u));
    let open = along.iter().zip(thought).skip(SHAPE);
    open.map(|(covariance, thought)| (noise * covariance / thought).powi(2))
        .sum()
}

/// The bell's logarithm about a centre, and where its maximum is.
fn fit(
    sight: &Sight<'_>,
    pulse: &Pulse,
    centre: f64,
    window: &Window,
    noise: f64,
) -> Option<(Polynomial, f64)> {
    let half = window.half;
    let (first, heights) = sight.window(centre - half, centre + half);
    let us = (0..heights.len()).map(|i| (first as f64 + i as f64 - centre) / half);
    let known = |i: usize| !pulse.is_clipped(first + i);
    let points: Vec<(f64, f64)> = us
        .zip(heights)
        .enumerate()
        .filter(|(i, (u, _))| u.abs() <= 1.0 && known(*i))
        .map(|(_, point)| point)
        .collect();
    let widths = half / pulse.steep_width_samples();
    let data = Data {
        degree: DEGREE.min(points.len().checked_sub(2)?),
        points,
        noise,
        thought: window.thought,
    };
    let mut start = [0.0; MOST];
    start[0] = pulse.height.ln();
    start[2] = -4.0 * std::f64::consts::LN_2 * widths * widths;
    let descent = descend(
        start,
        |bell| data.normal(bell),
        |bell, step| std::array::from_fn(|k| bell[k] + step[k]),
        |before, after| before.iter().zip(after).all(|(a, b)| (a - b).abs() < 1e-7),
    )?;
    let polynomial = data.polynomial(&descent, centre, half)?;
    let u = polynomial.top()?;
    Some((polynomial, u))
}

/// Samples to be fitted, as (u, height).
struct Data {
    points: Vec<(f64, f64)>,
    degree: usize,
    noise: f64,
    /// How large coefficients may be.
    thought: [f64; MOST],
}

impl Data {
    fn misses<'a>(
        &'a self,
        bell: &'a [f64; MOST],
    ) -> impl Iterator<Item = (f64, f64, [f64; MOST])> + 'a {
        self.points.iter().map(move |(u, height)| {
            let row = powers(*u);
            let logarithm: f64 = row.iter().zip(bell).map(|(r, c)| r * c).sum();
            let value = logarithm.exp();
            (value, height - value, row)
        })
    }

    /// Normal equations of a step from a bell, and its sum of squares; what is
    /// thought of the shape beforehand counts as further equations.
    fn normal(&self, bell: &[f64; MOST]) -> Option<(Normal, f64)> {
        let mut normal = Normal::new(self.degree + 1);
        let mut squares = 0.0;
        for (value, miss, row) in self.misses(bell) {
            normal.add(&row.map(|r| r * value), miss);
            squares += miss * miss;
        }
        for (k, coefficient) in bell.iter().enumerate().skip(SHAPE) {
            let mut row = [0.0; MOST];
            let weight = self.noise / self.thought[k];
            row[k] = weight;
            let miss = -weight * coefficient;
            normal.add(&row, miss);
            squares += miss * miss;
        }
        squares.is_finite().then_some((normal, squares))
    }

    fn polynomial(
        &self,
        descent: &Descent<[f64; MOST]>,
        centre: f64,
        half: f64,
    ) -> Option<Polynomial> {
        let mut solution = descent.normal.solve()?;
        solution.values = descent.model;
        // What the samples, not the thought beforehand, determine.
        let known: f64 = (SHAPE..=self.degree)
            .map(|k| (self.noise / self.thought[k]).powi(2) * solution.inverse[k][k])
            .sum();
        let freedom = self.points.len() as f64 - (self.degree + 1) as f64 + known;
        let squares: f64 = self
            .misses(&descent.model)
            .map(|(_, miss, _)| miss * miss)
            .sum();
        Some(Polynomial {
            centre,
            half,
            degree: self.degree,
            solution,
            left: (squares / freedom).sqrt(),
            freedom,
        })
    }
}
