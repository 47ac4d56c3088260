//! Maximum of a bell whose logarithm is a polynomial with a prior on its shape.

use super::clipping::Flanks;
use super::polynomial::Top;
use super::{ChannelView, Picked};
use crate::signal::linear::{
    LocalPolynomial, MOST, NormalEquations, Optimum, Row, levenberg_marquardt, powers,
};
use crate::signal::{MOST_POLES, Pulse, PulseKind};
use std::array::from_fn;
use std::f64::consts::LN_2;

/// Full width of the fit to a whole pulse in widths of the steeper flank: down to two fifths of the
/// maximum, above the kink with which the rise begins in fast dry shots.
pub(super) const WHOLE_WIDTH: f64 = 1.1;
/// The same where a clipped top is searched for: down to a third of the maximum.
pub(super) const WIDTH: f64 = 1.2;
/// Noise over height above which the flanks do not show which is the steeper.
const NOISY: f64 = 0.05;
/// The widest fit there, in widths of the steeper flank.
const WIDER: f64 = 1.4;
/// Degree of the logarithm: pulses of computed dry and wet rows between 0.1 and
/// 1.2 m/s are followed to 30 ns.
pub(super) const DEGREE: usize = MOST - 1;
/// How large even coefficients may be where nothing shows them.
const NEARLY_NONE: f64 = 0.1;
/// The first coefficient that makes a bell other than a Gaussian.
pub(super) const SHAPE: usize = 3;
/// Place of the level of a capped bell among its parameters.
pub(super) const LEVEL: usize = MOST - 1;
/// How much of a clipped bell may be cut off, as a logarithm: half of its height and more.
pub(super) const CUT_OFF: f64 = 0.4;
/// Shapes of computed pulses over the usual width, from the first coefficient beyond a Gaussian's on.
struct Shapes {
    mean: [f64; MOST - SHAPE],
    /// One deviation of coefficients together along each of the largest directions.
    together: [[f64; MOST - SHAPE]; 4],
    /// Deviation of each alone.
    alone: f64,
    /// Deviation of their change, in one speed's shots, with the logarithm of the height, over all these:
    /// fragments that part change a reflected pulse, and others hardly change.
    change: f64,
}

/// Of incident, wall's and reflected pulses of 1,000 chains at random, dry and wet, from 0.06 to
/// 2.5 m/s (`bench/picking/shapes.py`); the range of the first two is covered evenly.
const SHAPES: [Shapes; 3] = [
    Shapes {
        mean: [0.24, -0.19, -0.42, 0.14, 0.35, -0.1, -0.1, 0.03],
        together: [
            [0.23, 0.09, -0.39, -0.07, 0.3, 0.03, -0.09, -0.01],
            [0.0, 0.14, 0.05, -0.26, -0.06, 0.21, 0.02, -0.07],
            [0.0, -0.08, -0.01, -0.01, 0.0, 0.04, 0.0, -0.01],
            [0.02, 0.0, 0.0, 0.0, -0.01, 0.0, 0.01, 0.0],
        ],
        alone: 0.04,
        change: 0.3,
    },
    Shapes {
        mean: [-0.02, -0.02, 0.04, 0.01, 0.0, 0.0, 0.0, 0.0],
        together: [
            [0.09, 0.0, -0.05, 0.0, 0.02, 0.0, 0.0, 0.0],
            [0.01, 0.02, 0.02, 0.0, -0.01, 0.0, 0.0, 0.0],
            [0.0; 8],
            [0.0; 8],
        ],
        alone: 0.04,
        change: 0.3,
    },
    Shapes {
        mean: [-0.03, -0.28, -0.01, 0.14, 0.04, -0.05, -0.01, 0.01],
        together: [
            [0.13, -0.03, -0.19, 0.03, 0.16, -0.03, -0.05, 0.01],
            [0.0, 0.13, -0.04, -0.14, 0.02, 0.1, 0.0, -0.03],
            [0.05, -0.07, 0.0, -0.02, -0.03, 0.06, 0.01, -0.03],
            [0.06, 0.04, 0.0, 0.01, -0.04, -0.02, 0.02, 0.0],
        ],
        alone: 0.05,
        change: 3.0,
    },
];
/// Residuals of bells fitted to computed pulses without noise, as a share of the height, at the top
/// and in flanks that are fitted farther down: up to 2.5 m/s their rise begins with a kink.
pub(super) const INEXACT: (f64, f64) = (1.4e-4, 4e-4);
/// Power of the window's width as which errors of time by them go: of fast dry shots they are 10, 3.4
/// and 2.3 ns over widths of 1, 0.8 and 0.65.
pub(super) const EXPONENT: i32 = 3;
/// Deviations by which the squares that a fit leaves may exceed those of noise.
const ADEQUATE: f64 = 3.0;
/// Shares of the window that are tried, in this order, where a bell leaves more than noise; of shots
/// together also where a narrower one has the smaller error.
pub(super) const NARROWER: [f64; 4] = [1.0, 0.8, 0.65, 0.5];
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
    let half = half_width(pulse, view.broad_noise(pulse));
    let tries = NARROWER.iter().map(|share| {
        let window = BellWindow {
            half: (share * half).max(4.0),
            prior: ShapePrior::of_whole(pulse.kind, pulse.skewness(), *share),
        };
        Some((fit_about(view, pulse, pulse.at as f64, &window)?, *share))
    });
    first_adequate(tries)
}

/// Half the usual width of a fit in samples. In noise, which widens either side or narrows it, the
/// shorter one is too short; but flanks that differ by more are those of a skewed pulse.
pub(super) fn half_width(pulse: &Pulse, noise: f64) -> f64 {
    let noisy = noise > NOISY * pulse.height;
    let steep = pulse.steep_width_samples();
    let width = if noisy { pulse.width_samples.min(WIDER * steep) } else { steep };
    0.5 * WHOLE_WIDTH * width
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

/// Prior of the coefficients beyond a Gaussian's.
#[derive(Clone, Copy)]
pub(super) struct ShapePrior {
    mean: Row,
    /// Inverse root of the covariance: by its rows, coefficients less their means are independent
    /// and of deviation 1.
    pub(super) root: [Row; MOST],
    /// See [`Shapes`].
    pub(super) change: f64,
}

impl ShapePrior {
    /// Of a whole pulse over a share of the usual width. A skewed one is of no usual shape, and
    /// its coefficients may be as large as those of any.
    pub(super) fn of_whole(kind: PulseKind, skewness: f64, share: f64) -> Self {
        let Shapes { mean, together, alone, change } = &SHAPES[kind as usize];
        let powers = powers(share);
        let scaled = |of: &[f64; MOST - SHAPE]| -> Row {
            from_fn(|k| k.checked_sub(SHAPE).map_or(0.0, |i| of[i] * powers[k]))
        };
        let alone = powers.map(|power| alone.hypot(skewness) * power);
        let change = *change;
        Self { change, ..Self::new(scaled(mean), alone, &together.each_ref().map(scaled)) }
    }

    /// Of a pulse of unknown shape over so many times the usual width, over which coefficients are
    /// 0 ± 1; even ones times another factor.
    pub(super) fn of_flanks(widths: f64, even: f64) -> Self {
        let mut alone = powers(widths);
        let even_ones = alone.iter_mut().skip(SHAPE + 1).step_by(2);
        even_ones.for_each(|one| *one *= even);
        Self::new([0.0; MOST], alone, &[])
    }

    /// Of coefficients that vary each alone by a deviation, and along directions together by one
    /// more: the inverse of the Cholesky factor of that covariance.
    fn new(mean: Row, alone: Row, together: &[Row]) -> Self {
        let (mut factor, mut root) = ([[0.0; MOST]; MOST], [[0.0; MOST]; MOST]);
        for j in SHAPE..MOST {
            for k in SHAPE..=j {
                let shared: f64 = together.iter().map(|row| row[j] * row[k]).sum();
                let own = if j == k { alone[j] * alone[j] } else { 0.0 };
                let known: f64 = (SHAPE..k).map(|i| factor[j][i] * factor[k][i]).sum();
                let left = shared + own - known;
                factor[j][k] = if j == k { left.sqrt() } else { left / factor[k][k] };
            }
            root[j] = from_fn(|k| {
                let known: f64 = (SHAPE..j).map(|i| factor[j][i] * root[i][k]).sum();
                let own = if j == k { 1.0 } else { 0.0 };
                (own - known) / factor[j][j]
            });
        }
        Self { mean, root, change: 0.0 }
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

/// The maximum of a bell whose logarithm is a polynomial, in units of u, before an amplifier's
/// low-pass. At the top the logarithm's slope is 0, so slope and curvature of the pulse itself are its
/// height times those of the logarithm.
pub(super) struct BellTop {
    pub(super) u: f64,
    /// Logarithm of the height behind the low-pass, of that before it over that, and the curvature.
    pub(super) log_height: f64,
    pub(super) log_gain: f64,
    pub(super) curvature: f64,
    /// Variances for unit noise: of the logarithm of the height before the low-pass, of slope and curvature.
    pub(super) height_variance: f64,
    pub(super) slope_variance: f64,
    pub(super) curvature_variance: f64,
    /// The part of the slope's that is of the shape, which the samples leave open.
    pub(super) open_variance: f64,
}

impl BellTop {
    /// Near the maximum u of the logarithm, of samples with so much noise, of which a part is what
    /// bells leave of a pulse: it is the same in all of a pulse's shots.
    pub(super) fn new(
        fit: &LocalPolynomial,
        (u, inverse): (f64, [f64; MOST_POLES]),
        prior: &ShapePrior,
        (noise, inexact): (f64, f64),
    ) -> Option<Self> {
        let before = Slope::zero(fit, inverse, u)?;
        let slope = Slope::new(fit, inverse, before);
        let variances = fit.variances(u);
        let slope_variance = fit.solution.variance(&slope.row);
        // What the prior leaves open: C P C with C the covariance and P that of the prior.
        let along = fit.solution.covariance_with(&slope.row);
        let open = (SHAPE..MOST).map(|k| noise * shape_product(&along, &prior.root[k]));
        let open: f64 = open.map(|open| open * open).sum();
        let of_inexact = (inexact / noise).powi(2) * slope_variance;
        Some(Self {
            u: before,
            log_height: fit.at(u).value,
            log_gain: slope.log_height(fit)? - fit.at(u).value,
            curvature: slope.derivative,
            height_variance: fit.solution.variance(&slope.height_row),
            slope_variance,
            curvature_variance: variances.curvature,
            open_variance: (open + of_inexact).min(slope_variance),
        })
    }
}

/// Whether a bell over `noise` leaves no more than that.
pub(super) fn is_adequate(fit: &LocalPolynomial, noise: f64) -> bool {
    (fit.residual / noise).powi(2) <= 1.0 + ADEQUATE * (2.0 / fit.freedom).sqrt()
}

fn pick_at(
    view: &ChannelView<'_>,
    pulse: &Pulse,
    fit: &LocalPolynomial,
    u: f64,
    prior: &ShapePrior,
) -> Option<(Picked, bool)> {
    let inexact = inexact(pulse);
    let noise = view.noise(pulse).hypot(inexact);
    let modelled = view.broad_noise(pulse).hypot(inexact);
    let bell = BellTop::new(fit, (u, view.inverse), prior, (modelled, inexact))?;
    let adequate = is_adequate(fit, noise);
    let excess = if adequate { 1.0 } else { fit.residual / noise };
    let height = bell.log_height.exp();
    let top = Top {
        noise: excess * modelled,
        height,
        gain: bell.log_gain.exp(),
        height_share: bell.height_variance.sqrt(),
        slope_share: height * bell.slope_variance.sqrt(),
        curvature: height * bell.curvature,
        curvature_share: height * bell.curvature_variance.sqrt(),
        open_share: height * bell.open_variance.sqrt(),
        reach: reach(fit, u, excess * modelled),
    };
    Some((top.pick(view, pulse, fit, bell.u), adequate))
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
            let row = self.prior.root[k].map(|x| self.noise * x);
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

    pub(super) fn polynomial(
        &self,
        optimum: &Optimum<Row>,
        centre: f64,
        half: f64,
    ) -> Option<LocalPolynomial> {
        let mut solution = optimum.normal.solve()?;
        solution.values = optimum.model;
        // What the samples, not the prior, determine.
        let known: f64 = (SHAPE..=self.degree)
            .map(|k| solution.variance(&self.prior.root[k]) * self.noise.powi(2))
            .sum();
        let freedom = self.points.len() as f64 - (self.degree + 1) as f64 + known;
        let residuals = self.residuals(&optimum.model);
        let squares: f64 = residuals.map(|(residual, _)| residual * residual).sum();
        Some(LocalPolynomial {
            centre,
            half,
            solution,
            residual: (squares / freedom).sqrt(),
            freedom,
        })
    }
}

/// The signal x = y + a₁ y′ + a₂ y″ + … before an amplifier's low-pass, over y, at one place of a bell
/// y = exp(Σ c_k u^k), in units of u; the coefficients a are in samples.
struct Slope {
    u: f64,
    /// x over y.
    gain: f64,
    /// x′ over y.
    value: f64,
    /// Its derivative.
    derivative: f64,
    /// Derivatives of the logarithm of x, and of x′ over y, by the coefficients of the bell's logarithm.
    height_row: Row,
    row: Row,
}

impl Slope {
    fn new(bell: &LocalPolynomial, inverse: [f64; MOST_POLES], u: f64) -> Self {
        let rows = derivative_rows(u);
        let logs = rows.each_ref().map(|row| bell.solution.value(row));
        // Leibniz: y⁽ⁿ⁺¹⁾ = Σ C(n, i) p⁽ⁱ⁾ y⁽ⁿ⁻ⁱ⁾ with p = y′/y, and so of u^j y, whose term i = 0 is
        // that of a factor.
        let mut y = [1.0; DERIVATIVES];
        for n in 1..DERIVATIVES {
            y[n] = (0..n).map(|i| choose(n - 1, i) * logs[i + 1] * y[n - 1 - i]).sum();
        }
        let weight =
            |k: usize| k.checked_sub(1).map_or(1.0, |i| inverse[i] / bell.half.powi(k as i32));
        let of = |order: usize| (0..=MOST_POLES).map(|k| weight(k) * y[k + order]).sum::<f64>();
        let by = |order: usize, j: usize| -> f64 {
            let term =
                |n: usize| (1..=n).map(|i| choose(n, i) * rows[i][j] * y[n - i]).sum::<f64>();
            (0..=MOST_POLES).map(|k| weight(k) * term(k + order)).sum()
        };
        let (gain, value) = (of(0), of(1));
        Self {
            u,
            gain,
            value,
            derivative: of(2) - logs[1] * value,
            height_row: from_fn(|j| rows[0][j] + by(0, j) / gain),
            row: from_fn(|j| by(1, j)),
        }
    }

    fn log_height(&self, bell: &LocalPolynomial) -> Option<f64> {
        (self.gain > 0.0).then(|| bell.at(self.u).value + self.gain.ln())
    }

    /// Where it falls through 0, from the bell's own maximum on.
    fn zero(bell: &LocalPolynomial, inverse: [f64; MOST_POLES], from: f64) -> Option<f64> {
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

/// Derivatives of a bell that [`Slope`] needs, from the 0th on.
const DERIVATIVES: usize = MOST_POLES + 3;

fn derivative_rows(u: f64) -> [Row; DERIVATIVES] {
    from_fn(|order| from_fn(|k| falling(k, order) * u.powi(k.saturating_sub(order) as i32)))
}

/// n (n − 1) … of so many factors.
fn falling(n: usize, count: usize) -> f64 {
    (0..count).map(|i| n.saturating_sub(i) as f64).product()
}

fn choose(n: usize, k: usize) -> f64 {
    falling(n, k) / falling(k, k)
}
