//! Stages of one step: weighted sums of accelerations.

use super::dense::StageWeights;
use crate::instruction_set::InstructionSet;
use fearless_simd::{dispatch, f64x4, prelude::*};
use std::ops::Range;

/// Bodies or contacts that are computed side by side; each has the bits that it has alone.
pub(super) const LANES: usize = 4;

/// Velocities and positions of a stage from those at the start of the step:
/// V = v + h Σ w_j A_j, X = x + h c v + h² Σ u_j A_j.
pub(super) fn stage(
    set: InstructionSet,
    bodies: Range<usize>,
    (h, node): (f64, f64),
    (position, velocity): (&[f64], &[f64]),
    (x, v): (&[f64], &[f64]),
    a: &[Vec<f64>],
    (x_out, v_out): (&mut [f64], &mut [f64]),
) {
    let start = (&x[bodies.clone()], &v[bodies.clone()]);
    let out = (&mut x_out[bodies.clone()], &mut v_out[bodies.clone()]);
    let (weights, step) = ((position, velocity), (h, node));
    macro_rules! of_stages {
        ($simd:ident, $($count:literal)+) => {
            match velocity.len() {
                $($count => combine::<_, $count>($simd, bodies, step, weights, start, a, out),)+
                _ => combine::<_, 13>($simd, bodies, step, weights, start, a, out),
            }
        };
    }
    dispatch!(set.level(), simd => simd.vectorize(
        #[inline(always)]
        || of_stages!(simd, 1 2 3 4 5 6 7 8 9 10 11 12)
    ));
}

/// The sum with a number of stages known at compile time, so that it unrolls.
#[inline(always)]
fn combine<S: Simd, const STAGES: usize>(
    simd: S,
    bodies: Range<usize>,
    (h, node): (f64, f64),
    (position, velocity): (&[f64], &[f64]),
    (x, v): (&[f64], &[f64]),
    a: &[Vec<f64>],
    (x_out, v_out): (&mut [f64], &mut [f64]),
) {
    let n = bodies.len();
    let a: [&[f64]; STAGES] = std::array::from_fn(|j| &a[j][bodies.clone()][..n]);
    let moved: [f64; STAGES] = std::array::from_fn(|j| h * h * position[j]);
    let sped: [f64; STAGES] = std::array::from_fn(|j| h * velocity[j]);
    let (x, v) = (&x[..n], &v[..n]);
    let (x_out, v_out) = (&mut x_out[..n], &mut v_out[..n]);
    let drift = h * node;
    let whole = n - n % LANES;
    for i in (0..whole).step_by(LANES) {
        let load = |values: &[f64]| f64x4::from_slice(simd, &values[i..i + LANES]);
        let zero = f64x4::splat(simd, 0.0);
        let (mut dx, mut dv) = (zero, zero);
        for j in 0..STAGES {
            let a = load(a[j]);
            dx += a * moved[j];
            dv += a * sped[j];
        }
        let v = load(v);
        (load(x) + (v * drift + dx)).store_slice(&mut x_out[i..i + LANES]);
        (v + dv).store_slice(&mut v_out[i..i + LANES]);
    }
    for i in whole..n {
        let (mut dx, mut dv) = (0.0, 0.0);
        for j in 0..STAGES {
            dx += moved[j] * a[j][i];
            dv += sped[j] * a[j][i];
        }
        x_out[i] = x[i] + (drift * v[i] + dx);
        v_out[i] = v[i] + dv;
    }
}

/// Most stages of a method.
pub(super) const MOST_STAGES: usize = 14;

/// Error estimates of a step, in units of the scales.
struct Errors<'a> {
    a: &'a [Vec<f64>],
    /// Weights of each stage's acceleration for velocity and position.
    weights: StageWeights,
}

impl<'a> Errors<'a> {
    #[inline(always)]
    fn new(
        h: f64,
        [velocity, position]: &[Vec<f64>; 2],
        a: &'a [Vec<f64>],
        (speed, length): (f64, f64),
    ) -> Self {
        let weight = |of: &[f64], j: usize| of.get(j).copied().unwrap_or(0.0);
        let weights = |j| [h * weight(velocity, j) / speed, h * h * weight(position, j) / length];
        Self { a, weights: std::array::from_fn(weights) }
    }

    /// That of a body; NaN if anything is.
    #[inline(always)]
    fn of(&self, body: usize) -> f64 {
        let (mut dv, mut dx) = (0.0, 0.0);
        for (a, [sped, moved]) in self.a.iter().zip(self.weights) {
            dv += sped * a[body];
            dx += moved * a[body];
        }
        dv.abs().max(dx.abs()) + 0.0 * (dv + dx)
    }

    /// Those of [`LANES`] bodies.
    #[inline(always)]
    fn from<S: Simd>(&self, simd: S, body: usize) -> f64x4<S> {
        let zero = f64x4::splat(simd, 0.0);
        let (mut dv, mut dx) = (zero, zero);
        for (a, [sped, moved]) in self.a.iter().zip(self.weights) {
            let a = f64x4::from_slice(simd, &a[body..body + LANES]);
            dv += a * sped;
            dx += a * moved;
        }
        dv.abs().max(dx.abs()) + (dv + dx) * 0.0
    }
}

/// The largest error estimate of a step, in units of the scales, and the
/// body that has it. NaN where any estimate is NaN.
pub(super) fn error_norm(
    set: InstructionSet,
    bodies: Range<usize>,
    h: f64,
    weights: &[Vec<f64>; 2],
    a: &[Vec<f64>],
    scales: (f64, f64),
) -> (f64, usize) {
    let errors = Errors::new(h, weights, a, scales);
    dispatch!(set.level(), simd => simd.vectorize(
        #[inline(always)]
        || largest(simd, bodies, &errors)
    ))
}

#[inline(always)]
fn largest<S: Simd>(simd: S, bodies: Range<usize>, errors: &Errors<'_>) -> (f64, usize) {
    let (mut worst, mut at) = (0.0_f64, bodies.start);
    let mut body = bodies.start;
    while body < bodies.end {
        let mut count = 1;
        if body + LANES <= bodies.end {
            count = LANES;
            let errors = errors.from(simd, body);
            let small = errors.simd_le(f64x4::splat(simd, worst));
            if small.all_true() {
                body += count;
                continue;
            }
        }
        for body in body..body + count {
            let error = errors.of(body);
            if error.is_nan() {
                return (error, body);
            }
            if error > worst {
                (worst, at) = (error, body);
            }
        }
        body += count;
    }
    (worst, at)
}

/// The bodies from the first to the last whose error estimate is above a limit
/// or not a number.
pub(super) fn worse_than(
    limit: f64,
    bodies: Range<usize>,
    h: f64,
    weights: &[Vec<f64>; 2],
    a: &[Vec<f64>],
    scales: (f64, f64),
) -> Option<Range<usize>> {
    let errors = Errors::new(h, weights, a, scales);
    let is_worse = |body: &usize| {
        let error = errors.of(*body);
        error > limit || error.is_nan()
    };
    let first = bodies.clone().find(is_worse)?;
    let last = bodies.rev().find(is_worse)?;
    Some(first..last + 1)
}
