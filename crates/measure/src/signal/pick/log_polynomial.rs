//! Maximum of a bell whose logarithm is a polynomial with a prior on its shape.

use super::clipping::Flanks;
use super::polynomial::Top;
use super::{ChannelView, Picked};
use crate::signal::linear::{
    LocalPolynomial, MOST, NormalEquations, Optimum, Row, levenberg_marquardt, powers,
};
use crate::signal::{Pulse, PulseKind};
use std::array::from_fn;
use std::f64::consts::LN_2;

/// Full width of the fit to a whole pulse in widths of the steeper flank: down to two fifths of the
/// maximum, above the kink with which the rise begins in fast dry shots.
const WHOLE_WIDTH: f64 = 1.1;
/// The same where a clipped top is searched for: down to a third of the maximum.
pub(super) const WIDTH: f64 = 1.2;
/// Degree of the logarithm: pulses of computed dry and wet rows between 0.1 and
/// 1.2 m/s are followed to 30 ns.
pub(super) const DEGREE: usize = MOST - 1;
/// How large even coefficients may be where nothing shows them.
const NEARLY_NONE: f64 = 0.1;
/// The first coefficient that makes a bell other than a Gaussian.
const SHAPE: usize = 3;
/// Place of the level of a capped bell among its parameters.
pub(super) const LEVEL: usize = MOST - 1;
/// How much of a clipped bell may be cut off, as a logarithm: half of its height and more.
pub(super) const CUT_OFF: f64 = 0.4;
/// Mean coefficients, from the first beyond a Gaussian's on, and their standard deviation over the
/// usual width of incident, wall's and reflected pulses: of computed rows, dry and wet, from 0.06 to
/// 2.4 m/s, whose own deviations are 0.07 to 0.27, 0 to 0.11 and 0.06 to 0.34.
const SHAPES: [([f64; MOST - SHAPE], f64); 3] = [
    ([0.11, -0.22, -0.21, 0.22, 0.19, -0.17, -0.06, 0.05], 0.25),
    ([0.07, -0.02, 0.01, 0.0, 0.0, 0.0, 0.0, 0.0], 0.17),
    ([-0.03, -0.26, 0.01, 0.07, 0.0, 0.04, 0.0, -0.03], 0.23),
];
/// One deviation, more, of the coefficients of incident pulses together: from slow shots to fast dry
/// ones, whose rise begins with a kink.
const KINK: [f64; MOST - SHAPE] = [0.26, 0.0, -0.43, 0.0, 0.35, 0.0, -0.1, 0.0];
/// Residuals of bells fitted to computed pulses without noise, as a share of the height, at the top
/// and in flanks that are fitted farther down: up to 2.5 m/s their rise begins with a kink.
const INEXACT: (f64, f64) = (1.6e-4, 4e-4);
/// Deviations by which the squares that a fit leaves may exceed those of noise.
const ADEQUATE: f64 = 3.0;
/// Shares of the window that are tried, in this order, where a bell leaves more than noise.
const NARROWER: [f64; 4] = [1.0, 0.8, 0.65, 0.5];
/// Samples beside a clipped top that are left out, too, as a share of the width, where a window of
/// no length is tried: amplifiers round the corners.
const SOFT: f64 = 0.3;

/// Time in samples, by y = exp(Σ c_k u^k) with u from −1 to 1 across the fit.
///
/// The logarithm of a bell is nearly a parabola, so few coefficients determine it. Those beyond it
/// have those of computed rows as prior: noise leaves them there, a strong signal moves them. So one
/// model goes all the way from smooth to close, and the stated error holds what it leaves open of
/// the shape. Where more is left than noise, the error grows by as much.
pub(super) fn pick(view: &ChannelView<'_>, pulse: &Pulse) -> Option<Picked> {
    let half = 0.5 * WHOLE_WIDTH * pulse.steep_width_samples();
    let tries = NARROWER.iter().map(|share| {
        let window = BellWindow {
            half: (share * half).max(4.0),
            prior: ShapePrior::of_whole(pulse, *share),
        };
        Some((fit_about(view, pulse, pulse.at as f64, &window)?, *share))
    });
    first_adequate(tries)
}

/// As [`pick`], of a pulse whose top is clipped: its flanks are fitted, farther down, and
/// what lies between them is what bells have there. The stated error holds how little that is
/// known. Where noise gives them no top, the prior is a flatter or steeper Gaussian, which hardly
/// moves a maximum, of any skewness.
pub(super) fn pick_from_flanks(view: &ChannelView<'_>, pulse: &Pulse) -> Option<Picked> {
    let tries = NARROWER.iter().flat_map(|share| {
        let spread = ((1.0 - share) * SOFT * pulse.width_samples) as usize;
        let pulse = pulse.with_clipped_spread(spread);
        [1.0, NEARLY_NONE].map(|even| {
            let flanks = Flanks::new(view, &pulse)?;
            let whole = flanks.pulse(&pulse);
            let half = (share * flanks.half(&pulse)).max(4.0);
            let widths = half / whole.width_samples / (0.5 * WIDTH);
            let prior = ShapePrior::of_flanks(widths, even);
            let window = BellWindow { half, prior };
            Some((fit_about(view, &whole, flanks.at, &window)?, *share))
        })
    });
    first_adequate(tries)
}

/// The first pick whose fit leaves no more than noise, else the last one, with the error of a shape
/// that is no bell over the whole window.
fn first_adequate(tries: impl Iterator<Item = Option<((Picked, bool), f64)>>) -> Option<Picked> {
    let mut last = None;
    for ((mut picked, adequate), share) in tries.flatten() {
        picked.systematic.shape_s /= share;
        picked.sigma_s /= share;
        last = Some(picked);
        if adequate {
            break;
        }
    }
    last
}

struct BellWindow {
    half: f64,
    prior: ShapePrior,
}

/// Mean and standard deviation of each coefficient beyond a Gaussian's, independent of the samples.
#[derive(Clone, Copy)]
pub(super) struct ShapePrior {
    mean: Row,
    deviation: Row,
    /// One deviation, more, of all of them together.
    together: Row,
}

impl ShapePrior {
    /// Of a whole pulse over a share of the usual width. An asymmetric one is of no usual shape, and
    /// its coefficients may be as large as those of any.
    fn of_whole(pulse: &Pulse, share: f64) -> Self {
        let (means, usual) = SHAPES[pulse.kind as usize];
        let deviation = usual + (1.0 - usual) * pulse.asymmetry();
        let powers = powers(share);
        let scaled = |of: [f64; MOST - SHAPE]| -> Row {
            from_fn(|k| k.checked_sub(SHAPE).map_or(0.0, |i| of[i] * powers[k]))
        };
        let kink = match pulse.kind {
            PulseKind::Incident => KINK,
            _ => [0.0; MOST - SHAPE],
        };
        Self {
            mean: scaled(means),
            deviation: powers.map(|power| deviation * power),
            together: scaled(kink),
        }
    }

    /// Of a pulse of unknown shape over so many times the usual width, over which coefficients are
    /// 0 ± 1; even ones times another factor.
    pub(super) fn of_flanks(widths: f64, even: f64) -> Self {
        let mut deviation = powers(widths);
        let even_ones = deviation.iter_mut().skip(SHAPE + 1).step_by(2);
        even_ones.for_each(|one| *one *= even);
        Self { mean: [0.0; MOST], deviation, together: [0.0; MOST] }
    }

    /// Row k of the inverse root of the covariance: by it, coefficients less their means are
    /// independent and of deviation 1. Of D² + t tᵀ it is (1 − γ v vᵀ) D⁻¹, with D⁻¹ t = |D⁻¹ t| v.
    fn row(&self, k: usize) -> Row {
        let over = |j: usize| self.together[j] / self.deviation[j];
        let squared: f64 = (SHAPE..MOST).map(|j| over(j).powi(2)).sum();
        let share = match squared > 0.0 {
            true => (1.0 - (1.0 + squared).sqrt().recip()) / squared,
            false => 0.0,
        };
        from_fn(|j| {
            let own = f64::from(u8::from(j == k));
            (own - share * over(k) * over(j)) / self.deviation[j]
        })
    }
}

/// Σ a_k b_k over coefficients beyond a Gaussian's.
fn shape_product(a: &Row, b: &Row) -> f64 {
    a.iter().zip(b).skip(SHAPE).map(|(a, b)| a * b).sum()
}

/// The bell's maximum, searched for from `begun` on, and whether it leaves no more than noise.
fn fit_about(
    view: &ChannelView<'_>,
    pulse: &Pulse,
    begun: f64,
    window: &BellWindow,
) -> Option<(Picked, bool)> {
    let noise = view.broad_noise(pulse).hypot(inexact(pulse));
    let mut centre = begun;
    for _ in 0..4 {
        let (fit, u) = fit(view, pulse, centre, window, noise)?;
        let next = fit.sample(u).round();
        if (next - begun).abs() > window.half {
            return None;
        }
        if (next - centre).abs() <= 0.1 * window.half {
            return pick_at(view, pulse, &fit, u, &window.prior);
        }
        centre = next;
    }
    None
}

/// Residuals of bells without noise, in the samples' unit.
fn inexact(pulse: &Pulse) -> f64 {
    let clipped = pulse.clipped.is_some();
    (if clipped { INEXACT.1 } else { INEXACT.0 }) * pulse.height
}

/// At the top the logarithm's slope is 0, so slope and curvature of the pulse itself
/// are its height times those of the logarithm.
fn pick_at(
    view: &ChannelView<'_>,
    pulse: &Pulse,
    fit: &LocalPolynomial,
    u: f64,
    prior: &ShapePrior,
) -> Option<(Picked, bool)> {
    let height = fit.at(u).value.exp();
    let before = Slope::zero(fit, view.inverse, u)?;
    let slope = Slope::new(fit, view.inverse, before);
    let inexact = inexact(pulse);
    let noise = view.noise(pulse).hypot(inexact);
    let modelled = view.broad_noise(pulse).hypot(inexact);
    let beyond = (fit.residual / noise).powi(2) > 1.0 + ADEQUATE * (2.0 / fit.freedom).sqrt();
    let excess = if beyond { fit.residual / noise } else { 1.0 };
    let variances = fit.variances(u);
    let slope_variance = fit.solution.variance(&slope.row);
    // What bells leave of a pulse is the same in all of its shots.
    let of_inexact = (inexact / modelled).powi(2) * slope_variance;
    // What the prior leaves open: C P C with C the covariance and P that of the prior.
    let along = fit.solution.covariance_with(&slope.row);
    let open = (SHAPE..MOST).map(|k| shape_product(&along, &prior.row(k)));
    let open = open.map(|open| (modelled * open).powi(2)).sum::<f64>() + of_inexact;
    let top = Top {
        noise: excess * modelled,
        height,
        height_share: height * variances.value.sqrt(),
        slope_share: height * slope_variance.sqrt(),
        curvature: height * slope.derivative,
        curvature_share: height * variances.curvature.sqrt(),
        open_share: height * open.min(slope_variance).sqrt(),
        reach: reach(fit, u, excess * modelled),
    };
    Some((top.pick(view, pulse, fit, before), !beyond))
}

/// From u to the place furthest at which noise may have made the logarithm the lower.
fn reach(fit: &LocalPolynomial, u: f64, noise: f64) -> f64 {
    const STEPS: i32 = 24;
    let (top, row) = (fit.at(u).value, powers(u));
    let may_be_top = |v: &f64| {
        let other = powers(*v);
        let lower: Row = from_fn(|k| row[k] - other[k]);
        let error = noise * fit.solution.variance(&lower).sqrt();
        top - fit.at(*v).value < error
    };
    let places = (-STEPS..=STEPS).map(|step| f64::from(step) / f64::from(STEPS));
    let apart = places.filter(may_be_top).map(|v| (v - u).abs());
    apart.fold(0.0, f64::max)
}

fn fit(
    view: &ChannelView<'_>,
    pulse: &Pulse,
    centre: f64,
    window: &BellWindow,
    noise: f64,
) -> Option<(LocalPolynomial, f64)> {
    let half = window.half;
    let (first, heights) = view.window(centre - half, centre + half);
    let point = |(i, height): (usize, f64)| {
        let u = (first as f64 + i as f64 - centre) / half;
        (u.abs() <= 1.0 && !pulse.is_clipped(first + i)).then_some((u, height))
    };
    let points: Vec<(f64, f64)> = heights.into_iter().enumerate().filter_map(point).collect();
    let widths = half / pulse.steep_width_samples();
    let data = BellData {
        degree: DEGREE.min(points.len().checked_sub(2)?),
        points,
        noise,
        prior: window.prior,
        capped: false,
    };
    let mut start = [0.0; MOST];
    start[0] = pulse.height.ln();
    start[2] = -4.0 * LN_2 * widths * widths;
    let polynomial = data.polynomial(&data.fit(start)?, centre, half)?;
    let u = polynomial.maximum()?;
    Some((polynomial, u))
}

/// Samples to be fitted, as (u, height), and the model.
pub(super) struct BellData {
    pub(super) points: Vec<(f64, f64)>,
    pub(super) degree: usize,
    pub(super) noise: f64,
    pub(super) prior: ShapePrior,
    /// Whether the bell ends at a level, which is then the last parameter.
    pub(super) capped: bool,
}

impl BellData {
    fn terms(&self) -> usize {
        if self.capped { LEVEL } else { MOST }
    }

    /// Residual of each sample, and derivatives of the model there by its parameters.
    fn residuals<'a>(&'a self, bell: &'a Row) -> impl Iterator<Item = (f64, Row)> + 'a {
        let terms = self.terms();
        self.points.iter().map(move |(u, height)| {
            let mut row = powers(*u);
            let value = self.logarithm(bell, *u).exp();
            if self.capped && value > bell[LEVEL] {
                row = [0.0; MOST];
                row[LEVEL] = 1.0;
                return (height - bell[LEVEL], row);
            }
            row.iter_mut().take(terms).for_each(|r| *r *= value);
            row.iter_mut().skip(terms).for_each(|r| *r = 0.0);
            (height - value, row)
        })
    }

    /// The bell of least squares, from where the search begins.
    pub(super) fn fit(&self, start: Row) -> Option<Optimum<Row>> {
        levenberg_marquardt(
            start,
            |bell| self.normal(bell),
            |bell, step| from_fn(|k| bell[k] + step[k]),
            |before, after| before.iter().zip(after).all(|(a, b)| (a - b).abs() < 1e-7),
        )
    }

    fn logarithm(&self, bell: &Row, u: f64) -> f64 {
        let terms = powers(u).into_iter().zip(bell).take(self.terms());
        terms.map(|(r, c)| r * c).sum()
    }

    pub(super) fn is_capped(&self, bell: &Row, u: f64) -> bool {
        self.capped && self.logarithm(bell, u).exp() > bell[LEVEL]
    }

    /// Normal equations of a step from a bell, and its sum of squares; the prior counts as further
    /// equations.
    fn normal(&self, bell: &Row) -> Option<(NormalEquations, f64)> {
        let mut normal = NormalEquations::new(self.degree + 1);
        let mut squares = 0.0;
        let mut add = |row: &Row, residual: f64| {
            normal.add(row, residual);
            squares += residual * residual;
        };
        self.residuals(bell).for_each(|(residual, row)| add(&row, residual));
        let terms = self.terms();
        let off: Row = from_fn(|k| bell[k] - self.prior.mean[k]);
        for k in SHAPE..terms {
            let row = self.prior.row(k).map(|x| self.noise * x);
            let residual = -shape_product(&row, &off);
            let row = from_fn(|j| if j < SHAPE || j >= terms { 0.0 } else { row[j] });
            add(&row, residual);
        }
        if self.capped {
            let weight = self.noise / CUT_OFF;
            let mut row = [0.0; MOST];
            row[0] = weight;
            row[LEVEL] = -weight / bell[LEVEL];
            add(&row, -weight * (bell[0] - bell[LEVEL].ln()));
        }
        squares.is_finite().then_some((normal, squares))
    }

    fn polynomial(
        &self,
        optimum: &Optimum<Row>,
        centre: f64,
        half: f64,
    ) -> Option<LocalPolynomial> {
        let mut solution = optimum.normal.solve()?;
        solution.values = optimum.model;
        // What the samples, not the prior, determine.
        let known: f64 = (SHAPE..=self.degree)
            .map(|k| solution.variance(&self.prior.row(k)) * self.noise.powi(2))
            .sum();
        let freedom = self.points.len() as f64 - (self.degree + 1) as f64 + known;
        let residuals = self.residuals(&optimum.model);
        let squares: f64 = residuals.map(|(residual, _)| residual * residual).sum();
        Some(LocalPolynomial {
            centre,
            half,
            degree: self.degree,
            solution,
            residual: (squares / freedom).sqrt(),
            freedom,
        })
    }
}

/// Slope over value of x = y + a y′ + b y″, the signal before an amplifier's low-pass, at one place
/// of a bell y = exp(Σ c_k u^k), in units of u; a and b are in samples.
struct Slope {
    value: f64,
    derivative: f64,
    /// Its derivatives by the coefficients of the bell's logarithm.
    row: Row,
}

impl Slope {
    fn new(bell: &LocalPolynomial, [a, b]: [f64; 2], u: f64) -> Self {
        let (a, b) = (a / bell.half, b / bell.half.powi(2));
        let rows = derivative_rows(u);
        let of = |row: &Row| -> f64 {
            let terms = row.iter().zip(&bell.solution.values);
            terms.take(bell.degree + 1).map(|(r, c)| r * c).sum()
        };
        let [p, q, r, s] = rows.each_ref().map(of);
        // y′ = p y, y″ = (q + p²) y, y‴ = (r + 3 p q + p³) y.
        let weights = [1.0 + 2.0 * a * p + 3.0 * b * (q + p * p), a + 3.0 * b * p, b];
        Self {
            value: p + a * (q + p * p) + b * (r + 3.0 * p * q + p.powi(3)),
            derivative: weights[0] * q + weights[1] * r + weights[2] * s,
            row: from_fn(|k| (0..3).map(|i| weights[i] * rows[i][k]).sum()),
        }
    }

    /// Where it falls through 0, from the bell's own maximum on.
    fn zero(bell: &LocalPolynomial, inverse: [f64; 2], from: f64) -> Option<f64> {
        let mut u = from;
        for _ in 0..40 {
            let at = Self::new(bell, inverse, u);
            let by = (at.derivative < 0.0).then(|| -at.value / at.derivative)?;
            u += by.clamp(-0.2, 0.2);
            if u.is_nan() || u.abs() > 1.0 {
                return None;
            }
            if by.abs() < 1e-12 {
                break;
            }
        }
        Some(u)
    }
}

fn derivative_rows(u: f64) -> [Row; 4] {
    let mut rows = [[0.0; MOST]; 4];
    for (order, row) in rows.iter_mut().enumerate() {
        for (k, term) in row.iter_mut().enumerate().skip(order + 1) {
            let falling: usize = (0..=order).map(|i| k - i).product();
            *term = falling as f64 * u.powi((k - order - 1) as i32);
        }
    }
    rows
}
