//! Stages of one step: weighted sums of accelerations.

use std::ops::Range;

/// Velocities and positions of a stage from those at the start of the step:
/// V = v + h Σ w_j A_j, X = x + h c v + h² Σ u_j A_j.
pub(super) fn stage(
    bodies: Range<usize>,
    (h, node): (f64, f64),
    (position, velocity): (&[f64], &[f64]),
    (x, v): (&[f64], &[f64]),
    a: &[Vec<f64>],
    (x_out, v_out): (&mut [f64], &mut [f64]),
) {
    let start = (&x[bodies.clone()], &v[bodies.clone()]);
    let out = (&mut x_out[bodies.clone()], &mut v_out[bodies.clone()]);
    let weights = (position, velocity);
    match velocity.len() {
        1 => combine::<1>(bodies, (h, node), weights, start, a, out),
        2 => combine::<2>(bodies, (h, node), weights, start, a, out),
        3 => combine::<3>(bodies, (h, node), weights, start, a, out),
        4 => combine::<4>(bodies, (h, node), weights, start, a, out),
        5 => combine::<5>(bodies, (h, node), weights, start, a, out),
        6 => combine::<6>(bodies, (h, node), weights, start, a, out),
        _ => combine::<7>(bodies, (h, node), weights, start, a, out),
    }
}

/// The sum with a number of stages known at compile time, so that it unrolls.
fn combine<const S: usize>(
    bodies: Range<usize>,
    (h, node): (f64, f64),
    (position, velocity): (&[f64], &[f64]),
    (x, v): (&[f64], &[f64]),
    a: &[Vec<f64>],
    (x_out, v_out): (&mut [f64], &mut [f64]),
) {
    let n = bodies.len();
    let a: [&[f64]; S] = std::array::from_fn(|j| &a[j][bodies.clone()][..n]);
    let moved: [f64; S] = std::array::from_fn(|j| h * h * position[j]);
    let sped: [f64; S] = std::array::from_fn(|j| h * velocity[j]);
    let (x, v) = (&x[..n], &v[..n]);
    let (x_out, v_out) = (&mut x_out[..n], &mut v_out[..n]);
    let drift = h * node;
    for i in 0..n {
        let (mut dx, mut dv) = (0.0, 0.0);
        for j in 0..S {
            dx += moved[j] * a[j][i];
            dv += sped[j] * a[j][i];
        }
        x_out[i] = x[i] + (drift * v[i] + dx);
        v_out[i] = v[i] + dv;
    }
}

/// Bodies whose errors are summed side by side.
const LANES: usize = 8;

/// The largest error estimate of a step, in units of the scales, and the
/// body that has it. NaN where any estimate is NaN.
pub(super) fn error_norm(
    bodies: Range<usize>,
    h: f64,
    [velocity, position]: &[Vec<f64>; 2],
    a: &[Vec<f64>],
    (speed, length): (f64, f64),
) -> (f64, usize) {
    let (mut worst, mut at) = (0.0_f64, bodies.start);
    let mut first = bodies.start;
    while first < bodies.end {
        let count = LANES.min(bodies.end - first);
        let (mut dv, mut dx) = ([0.0; LANES], [0.0; LANES]);
        for (a, (speed_weight, length_weight)) in a.iter().zip(velocity.iter().zip(position)) {
            let (sped, moved) = (h * speed_weight / speed, h * h * length_weight / length);
            for (lane, value) in a[first..first + count].iter().enumerate() {
                dv[lane] += sped * value;
                dx[lane] += moved * value;
            }
        }
        for lane in 0..count {
            let error = dv[lane].abs().max(dx[lane].abs()) + 0.0 * (dv[lane] + dx[lane]);
            if error.is_nan() {
                return (error, first + lane);
            }
            if error > worst {
                (worst, at) = (error, first + lane);
            }
        }
        first += count;
    }
    (worst, at)
}

/// The bodies from the first to the last whose error estimate is above a limit
/// or not a number.
pub(super) fn worse_than(
    limit: f64,
    bodies: Range<usize>,
    h: f64,
    [velocity, position]: &[Vec<f64>; 2],
    a: &[Vec<f64>],
    (speed, length): (f64, f64),
) -> Option<Range<usize>> {
    let is_worse = |body: &usize| {
        let (mut dv, mut dx) = (0.0, 0.0);
        for (a, (speed_weight, length_weight)) in a.iter().zip(velocity.iter().zip(position)) {
            dv += h * speed_weight / speed * a[*body];
            dx += h * h * length_weight / length * a[*body];
        }
        let error = dv.abs().max(dx.abs()) + 0.0 * (dv + dx);
        error > limit || error.is_nan()
    };
    let first = bodies.clone().find(is_worse)?;
    let last = bodies.rev().find(is_worse)?;
    Some(first..last + 1)
}
