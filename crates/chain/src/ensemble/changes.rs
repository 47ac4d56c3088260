//! Openings and closings between two steps.
//!
//! Sums over samples integrate a smooth force to the order of the method, but
//! not one that begins or ends in between: a contact opens at w (t* − t) → 0
//! with F = F₀ + c₁ δ^{1/2} + c₃ δ^{3/2} + …, and what the sum of samples
//! taken at distances θh, (1+θ)h, … from such an end has too much is, by the
//! Euler–Maclaurin formula for end points with powers [Navot1961],
//! h Σ_p c_p (w h)^p ζ(−p, θ). That impulse is taken back.

use super::column::{Column, WIDTH};
use crate::instruction_set::InstructionSet;
use crate::laws::Closed;
use crate::system::System;
use fearless_simd::{dispatch, f64x8, prelude::*};

/// Which contacts are open, and those that have changed.
#[derive(Clone, Debug)]
pub(super) struct Changes {
    open: Vec<[bool; WIDTH]>,
    changed: Vec<usize>,
}

impl Changes {
    pub fn new(chunks: usize) -> Self {
        Self {
            open: vec![[false; WIDTH]; chunks],
            changed: Vec::with_capacity(chunks * WIDTH),
        }
    }

    /// Notes what has changed since the last look.
    pub fn look(
        &mut self,
        set: InstructionSet,
        (moving, lanes): (usize, usize),
        offset_m: &Column,
        x: &[f64],
    ) -> &[usize] {
        self.changed.clear();
        dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || self.compare(simd, (moving, lanes), offset_m, x)
        ));
        &self.changed
    }

    #[inline(always)]
    fn compare<S: Simd>(&mut self, simd: S, (moving, lanes): (usize, usize), offset_m: &Column, x: &[f64]) {
        let left = x[..moving * WIDTH].as_chunks::<WIDTH>().0;
        let right = x[lanes..][..moving * WIDTH].as_chunks::<WIDTH>().0;
        for i in 0..moving {
            let load = |chunk: &[f64; WIDTH]| -> f64x8<S> { (*chunk).simd_into(simd) };
            let depth = load(offset_m.at(i)) - (load(&right[i]) - load(&left[i]));
            let depth: [f64; WIDTH] = depth.into();
            let open = depth.map(|depth| depth < 0.0);
            if open != self.open[i] {
                let lanes = (0..WIDTH).filter(|&lane| open[lane] != self.open[i][lane]);
                self.changed.extend(lanes.map(|lane| i * WIDTH + lane));
                self.open[i] = open;
            }
        }
    }
}

/// What the sum of samples of a contact's force has too much, as an impulse in
/// N s, when the contact has changed within the last step of `step_s`: it is
/// at a depth now, changing at a rate which itself changes.
pub(super) fn excess(
    system: &System,
    contact: usize,
    (depth_m, rate_m_s, change_m_s2): (f64, f64, f64),
    step_s: f64,
) -> f64 {
    // Time since the change, from the motion now.
    let first = depth_m / rate_m_s;
    let since = first + 0.5 * change_m_s2 * first * first / rate_m_s;
    let since = (since / step_s).clamp(0.0, 1.0);
    if since.is_nan() {
        return 0.0;
    }
    let opens = depth_m < 0.0;
    let distance = if opens { 1.0 - since } else { since };
    let rate = rate_m_s - change_m_s2 * since * step_s;
    let reach = rate.abs() * step_s;
    let force = |depth: f64| system.unclipped_force(contact, Closed::new(depth, rate));
    let [at_once, root, high] = expansion(force, reach);
    step_s * (at_once * (0.5 - distance) + root * zeta(0.5, distance) + high * zeta(1.5, distance))
}

/// F₀, c₁ reach^{1/2} and c₃ reach^{3/2} of a force near no overlap.
fn expansion(force: impl Fn(f64) -> f64, reach: f64) -> [f64; 3] {
    let at_once = force(0.0);
    let (near, far) = (force(0.25 * reach) - at_once, force(reach) - at_once);
    // near = c₁/2 + c₃/8, far = c₁ + c₃.
    let root = (8.0 * near - far) / 3.0;
    [at_once, root, far - root]
}

/// ζ(−p, a), by Euler and Maclaurin after four terms.
fn zeta(p: f64, a: f64) -> f64 {
    const TERMS: i32 = 4;
    let head: f64 = (0..TERMS).map(|k| (f64::from(k) + a).powf(p)).sum();
    let end = f64::from(TERMS) + a;
    let power = end.powf(p);
    let tail = -power * end / (p + 1.0) + 0.5 * power - p * power / (12.0 * end)
        + p * (p - 1.0) * (p - 2.0) * power / (720.0 * end * end * end);
    head + tail
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeta_has_its_known_values() {
        // ζ(−1/2) and ζ(−3/2); ζ(s, 0) of a positive power is ζ(s, 1).
        assert!((zeta(0.5, 1.0) + 0.207_886_224_977_354_57).abs() < 1e-7);
        assert!((zeta(1.5, 1.0) + 0.025_485_201_889_833_035).abs() < 1e-7);
        assert!((zeta(0.5, 0.0) - zeta(0.5, 1.0)).abs() < 1e-7);
    }
}
