//! Maximum of a bell whose skewness and flatness are free.

use super::amplifier::Slope;
use super::flanks::Flanks;
use super::local_model::{Top, finish};
use super::normal::{Descent, MOST, Normal, descend};
use super::polynomial::{Polynomial, powers};
use super::{Moved, Picked, Sight};
use crate::signal::{Place, Pulse};

/// Full width of the fit to a whole pulse in widths of the steeper flank: down to two fifths of the
/// maximum, above the kink with which the rise begins in fast dry shots.
const WHOLE_WIDTH: f64 = 1.1;
/// The same where a clipped top is looked for: down to a third of the maximum.
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
/// One deviation, more, of the coefficients of incident pulses together: from slow shots to fast dry ones,
/// whose rise begins with a kink.
const KINK: [f64; MOST - SHAPE] = [0.26, 0.0, -0.43, 0.0, 0.35, 0.0, -0.1, 0.0];
/// What bells leave of computed pulses without noise, as a share of the height, at the top and in
/// flanks that are fitted farther down: up to 2.5 m/s their rise begins with a kink.
const INEXACT: (f64, f64) = (1.6e-4, 4e-4);
/// Deviations by which the squares that a fit leaves may exceed those of noise.
const ADEQUATE: f64 = 3.0;
/// Shares of the window that are tried, in this order, where a bell leaves more than noise.
const NARROWER: [f64; 4] = [1.0, 0.8, 0.65, 0.5];
/// Samples beside a clipped top that are left out, too, as a share of the width, where a window of no
/// length is tried: amplifiers round the corners.
const SOFT: f64 = 0.3;

/// Time in samples, by y = exp(Σ c_k u^k) with u from −1 to 1 across the fit.
///
/// The logarithm of a bell is nearly a parabola, so few coefficients tell much.
/// Those beyond it are taken to be what computed rows have before the samples are looked at: noise
/// leaves them there, a strong signal moves them. So one model goes all the way from smooth to
/// close, and the stated error holds what it does not know of the shape.
/// Where more is left than noise, the error grows by as much.
pub(super) fn pick(sight: &Sight<'_>, pulse: &Pulse) -> Option<Picked> {
    let begun = pulse.at as f64;
    let half = 0.5 * WHOLE_WIDTH * pulse.steep_width_samples();
    let tries = NARROWER.iter().map(|share| {
        let window = Window {
            half: (share * half).max(4.0),
            thought: Thought::of_whole(pulse, *share),
        };
        Some(widened(about(sight, pulse, begun, &window)?, *share))
    });
    adequate(tries)
}

/// As [`pick`], of a pulse whose top is clipped: its flanks are fitted, farther down, and
/// what lies between them is what bells have there. The stated error holds how little
/// that is known. Where noise gives them no top, flanks are thought to be those of a flatter or
/// steeper Gaussian, which hardly moves a maximum: as skewed as they like, but else no other shape.
pub(super) fn from_flanks(sight: &Sight<'_>, pulse: &Pulse) -> Option<Picked> {
    let tries = NARROWER.iter().flat_map(|share| {
        let spread = ((1.0 - share) * SOFT * pulse.width_samples) as usize;
        let pulse = pulse.with_clipped_spread(spread);
        [1.0, NEARLY_NONE].map(|even| {
            let flanks = Flanks::of(sight, &pulse)?;
            let whole = flanks.pulse(&pulse);
            let half = (share * flanks.half(&pulse)).max(4.0);
            let widths = half / whole.width_samples / (0.5 * WIDTH);
            let thought = Thought::of_flanks(widths, even);
            let found = about(sight, &whole, flanks.at, &Window { half, thought })?;
            Some(widened(found, *share))
        })
    });
    adequate(tries)
}

/// The same with the error of a shape that is no bell over the whole window.
fn widened((picked, adequate): (Picked, bool), share: f64) -> (Picked, bool) {
    let moved = Moved {
        shape_s: picked.moved.shape_s / share,
        ..picked.moved
    };
    let sigma_s = picked.sigma_s / share;
    let picked = Picked {
        sigma_s,
        moved,
        ..picked
    };
    (picked, adequate)
}

/// The first fit that leaves no more than noise, else the last that there is.
fn adequate(tries: impl Iterator<Item = Option<(Picked, bool)>>) -> Option<Picked> {
    let mut last = None;
    for (picked, adequate) in tries.flatten() {
        if adequate {
            return Some(picked);
        }
        last = Some(picked);
    }
    last
}

/// Where a bell is fitted, and what is thought of it beforehand.
struct Window {
    /// Samples from the middle to either end.
    half: f64,
    thought: Thought,
}

/// Mean and standard deviation of each coefficient beyond a Gaussian's before the samples are
/// looked at.
#[derive(Clone, Copy)]
pub(super) struct Thought {
    mean: [f64; MOST],
    deviation: [f64; MOST],
    /// One deviation, more, of all of them together.
    together: [f64; MOST],
}

impl Thought {
    /// Of a whole pulse over a share of the usual width. One that trails is of no usual shape, and
    /// its coefficients may be as large as those of any.
    fn of_whole(pulse: &Pulse, share: f64) -> Self {
        let (means, usual) = SHAPES[pulse.place as usize];
        let deviation = usual + (1.0 - usual) * pulse.trailing();
        let powers = powers(share);
        let scaled = |of: [f64; MOST - SHAPE]| -> [f64; MOST] {
            std::array::from_fn(|k| k.checked_sub(SHAPE).map_or(0.0, |i| of[i] * powers[k]))
        };
        let kink = if pulse.place == Place::Passing {
            KINK
        } else {
            [0.0; MOST - SHAPE]
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
        Self {
            mean: [0.0; MOST],
            deviation,
            together: [0.0; MOST],
        }
    }

    /// Row k of the inverse root of the covariance: by it, coefficients less their means are
    /// independent and of deviation 1. Of D² + t tᵀ it is (1 − γ v vᵀ) D⁻¹, with D⁻¹ t = |D⁻¹ t| v.
    fn row(&self, k: usize) -> [f64; MOST] {
        let over = |j: usize| self.together[j] / self.deviation[j];
        let squared: f64 = (SHAPE..MOST).map(|j| over(j).powi(2)).sum();
        let share = match squared > 0.0 {
            true => (1.0 - (1.0 + squared).sqrt().recip()) / squared,
            false => 0.0,
        };
        std::array::from_fn(|j| {
            let own = f64::from(u8::from(j == k));
            (own - share * over(k) * over(j)) / self.deviation[j]
        })
    }
}

/// Σ a_k b_k over coefficients beyond a Gaussian's.
fn along_shape(a: &[f64; MOST], b: &[f64; MOST]) -> f64 {
    a.iter().zip(b).skip(SHAPE).map(|(a, b)| a * b).sum()
}

/// The bell's maximum, looked for from `begun` on.
fn about(sight: &Sight<'_>, pulse: &Pulse, begun: f64, window: &Window) -> Option<(Picked, bool)> {
    let noise = sight.broad_noise(pulse).hypot(inexact(pulse));
    let mut centre = begun;
    for _ in 0..4 {
        let (fit, u) = fit(sight, pulse, centre, window, noise)?;
        let next = fit.sample(u).round();
        if (next - begun).abs() > window.half {
            return None;
        }
        if (next - centre).abs() <= 0.1 * window.half {
            return picked(sight, pulse, &fit, u, &window.thought);
        }
        centre = next;
    }
    None
}

/// What bells leave of computed pulses without noise, in the samples' unit.
fn inexact(pulse: &Pulse) -> f64 {
    let share = if pulse.clipped.is_some() {
        INEXACT.1
    } else {
        INEXACT.0
    };
    share * pulse.height
}

/// At the top the logarithm's slope is 0, so slope and bend of the pulse itself
/// are its height times those of the logarithm.
fn picked(
    sight: &Sight<'_>,
    pulse: &Pulse,
    fit: &Polynomial,
    u: f64,
    thought: &Thought,
) -> Option<(Picked, bool)> {
    let height = fit.course(u).value.exp();
    let before = Slope::top(fit, sight.inverse, u)?;
    let slope = Slope::of(fit, sight.inverse, before);
    let inexact = inexact(pulse);
    let noise = sight.noise(pulse).hypot(inexact);
    let modelled = sight.broad_noise(pulse).hypot(inexact);
    let beyond = (fit.left / noise).powi(2) > 1.0 + ADEQUATE * (2.0 / fit.freedom).sqrt();
    let excess = if beyond { fit.left / noise } else { 1.0 };
    let slope_variance = fit.solution.variance(&slope.row);
    // What bells leave of a pulse is the same in all of its shots.
    let of_inexact = (inexact / modelled).powi(2) * slope_variance;
    let open = open_variance(fit, &slope.row, modelled, thought) + of_inexact;
    let top = Top {
        noise: excess * modelled,
        height,
        height_share: height * fit.value_variance(u).sqrt(),
        slope_share: height * slope_variance.sqrt(),
        bend: height * slope.bend,
        bend_share: height * fit.bend_variance(u).sqrt(),
        open_share: height * open.min(slope_variance).sqrt(),
        reach: reach(fit, u, excess * modelled),
    };
    Some((finish(sight, pulse, fit, before, &top), !beyond))
}

/// Steps from the middle of a fit to either end.
const STEPS: i32 = 24;

/// From u to the farthest place at which noise may have made the logarithm the lower.
fn reach(fit: &Polynomial, u: f64, noise: f64) -> f64 {
    let (top, row) = (fit.course(u).value, powers(u));
    let may_be_top = |v: &f64| {
        let other = powers(*v);
        let lower: [f64; MOST] = std::array::from_fn(|k| row[k] - other[k]);
        let error = noise * fit.solution.variance(&lower).sqrt();
        top - fit.course(*v).value < error
    };
    let places = (-STEPS..=STEPS).map(|step| f64::from(step) / f64::from(STEPS));
    let apart = places.filter(may_be_top).map(|v| (v - u).abs());
    apart.fold(0.0, f64::max)
}

/// Variance of a slope, for unit noise, by coefficients that may be other than the 0 they
/// are thought to be: C P C with C the covariance and P what is thought beforehand.
fn open_variance(fit: &Polynomial, slope: &[f64; MOST], noise: f64, thought: &Thought) -> f64 {
    let along = fit.solution.covariance_with(slope);
    let open = (SHAPE..MOST).map(|k| along_shape(&along, &thought.row(k)));
    open.map(|open| (noise * open).powi(2)).sum()
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
        capped: false,
    };
    let mut start = [0.0; MOST];
    start[0] = pulse.height.ln();
    start[2] = -4.0 * std::f64::consts::LN_2 * widths * widths;
    let descent = data.descend(start)?;
    let polynomial = data.polynomial(&descent, centre, half)?;
    let u = polynomial.top()?;
    Some((polynomial, u))
}

/// Samples to be fitted, as (u, height).
pub(super) struct Data {
    pub(super) points: Vec<(f64, f64)>,
    pub(super) degree: usize,
    pub(super) noise: f64,
    /// How large coefficients may be.
    pub(super) thought: Thought,
    /// Whether the bell ends at a level, which then stands in the last coefficient's place.
    pub(super) capped: bool,
}

impl Data {
    /// Of each sample what is left, and how the model changes there with its parameters.
    fn misses<'a>(
        &'a self,
        bell: &'a [f64; MOST],
    ) -> impl Iterator<Item = (f64, [f64; MOST])> + 'a {
        let terms = if self.capped { LEVEL } else { MOST };
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
    pub(super) fn descend(&self, start: [f64; MOST]) -> Option<Descent<[f64; MOST]>> {
        descend(
            start,
            |bell| self.normal(bell),
            |bell, step| std::array::from_fn(|k| bell[k] + step[k]),
            |before, after| before.iter().zip(after).all(|(a, b)| (a - b).abs() < 1e-7),
        )
    }

    /// Logarithm of the bell at u.
    fn logarithm(&self, bell: &[f64; MOST], u: f64) -> f64 {
        let terms = if self.capped { LEVEL } else { MOST };
        let row = powers(u);
        row.iter().zip(bell).take(terms).map(|(r, c)| r * c).sum()
    }

    /// Whether the bell is above its level at u.
    pub(super) fn is_capped(&self, bell: &[f64; MOST], u: f64) -> bool {
        self.capped && self.logarithm(bell, u).exp() > bell[LEVEL]
    }

    /// Normal equations of a step from a bell, and its sum of squares; what is
    /// thought of the shape beforehand counts as further equations.
    fn normal(&self, bell: &[f64; MOST]) -> Option<(Normal, f64)> {
        let mut normal = Normal::new(self.degree + 1);
        let mut squares = 0.0;
        for (miss, row) in self.misses(bell) {
            normal.add(&row, miss);
            squares += miss * miss;
        }
        let terms = if self.capped { LEVEL } else { MOST };
        let off: [f64; MOST] = std::array::from_fn(|k| bell[k] - self.thought.mean[k]);
        for k in SHAPE..terms {
            let row = self.thought.row(k).map(|x| self.noise * x);
            let miss = -along_shape(&row, &off);
            let row = std::array::from_fn(|j| if j < SHAPE || j >= terms { 0.0 } else { row[j] });
            normal.add(&row, miss);
            squares += miss * miss;
        }
        if self.capped {
            let weight = self.noise / CUT_OFF;
            let mut row = [0.0; MOST];
            row[0] = weight;
            row[LEVEL] = -weight / bell[LEVEL];
            let miss = -weight * (bell[0] - bell[LEVEL].ln());
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
            .map(|k| solution.variance(&self.thought.row(k)) * self.noise.powi(2))
            .sum();
        let freedom = self.points.len() as f64 - (self.degree + 1) as f64 + known;
        let squares: f64 = self
            .misses(&descent.model)
            .map(|(miss, _)| miss * miss)
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
