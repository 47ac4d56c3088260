//! The sweep over bodies: from contact forces to the next step's positions
//! and velocities.

use super::aligned::Aligned;
use super::column::{Column, WIDTH};
use super::weights::{EARLIER, USED, Weights};
use super::window::Window;
use crate::instruction_set::InstructionSet;
use fearless_simd::{dispatch, f64x8, prelude::*};
use std::ops::Range;

/// Motion of all bodies of all lanes.
#[derive(Debug)]
pub(super) struct Motion {
    /// Predicted positions and velocities, with a chunk to spare.
    pub x: Aligned,
    pub v: Aligned,
    /// Accelerations of the last steps: the newest at `newest`, older ones
    /// after it, round the ring.
    accelerations: [Aligned; USED],
    newest: usize,
    pub inverse_mass: Column,
    /// Accelerations by what is not a contact, if anything is.
    pub external: Option<Aligned>,
}

/// Weights times powers of each lane's step.
#[derive(Clone, Debug)]
pub(super) struct Scaled {
    drift: [f64; WIDTH],
    velocity: [[f64; WIDTH]; USED],
    position: [[f64; WIDTH]; USED],
}

impl Scaled {
    pub fn new(weights: &Weights, step_s: &[f64; WIDTH]) -> Self {
        Self {
            drift: step_s.map(|h| h * weights.drift),
            velocity: weights.velocity.map(|weight| step_s.map(|h| h * weight)),
            position: weights
                .position
                .map(|weight| step_s.map(|h| h * h * weight)),
        }
    }
}

impl Motion {
    /// From positions and velocities, with nothing accelerated yet.
    pub fn new(x: Aligned, v: Aligned, inverse_mass: Column, external: bool) -> Self {
        let zeros = || Aligned::of(0.0, x.len());
        Self {
            accelerations: std::array::from_fn(|_| zeros()),
            newest: 0,
            inverse_mass,
            external: external.then(zeros),
            x,
            v,
        }
    }

    /// Accelerations of a step, 0 the newest.
    pub fn accelerations(&self, age: usize) -> &[f64] {
        &self.accelerations[(self.newest + age) % USED]
    }

    /// The newest accelerations.
    pub fn newest_mut(&mut self) -> &mut [f64] {
        &mut self.accelerations[self.newest]
    }

    /// One step of what the wave has reached: `force` holds the dynamic force
    /// on each body from the left, and `lanes` further on from the right.
    pub fn step(
        &mut self,
        set: InstructionSet,
        window: &Window,
        lanes: usize,
        force: &[f64],
        scaled: &Scaled,
    ) {
        self.newest = (self.newest + USED - 1) % USED;
        let mut now = std::mem::take(&mut self.accelerations[self.newest]);
        dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || {
                let (awake, all) = (window.bodies.clone(), window.chunks);
                fly(simd, self, 0..awake.start, scaled);
                sweep(simd, self, &mut now, (awake.clone(), lanes), force, scaled);
                fly(simd, self, awake.end..all, scaled);
            }
        ));
        self.accelerations[self.newest] = now;
    }
}

#[inline(always)]
fn chunks_of(values: &[f64], count: usize) -> &[[f64; WIDTH]] {
    values[..count * WIDTH].as_chunks().0
}

/// Bodies that no force has moved of late: what [`sweep`] does to them, but for
/// adding zeros.
#[inline(always)]
fn fly<S: Simd>(simd: S, motion: &mut Motion, asleep: Range<usize>, scaled: &Scaled) {
    let drift: f64x8<S> = scaled.drift.simd_into(simd);
    let v = chunks_of(&motion.v, asleep.end);
    let x = motion.x[..asleep.end * WIDTH].as_chunks_mut::<WIDTH>().0;
    for i in asleep {
        let (x0, v0): (f64x8<S>, f64x8<S>) = (x[i].simd_into(simd), v[i].simd_into(simd));
        x[i] = drift.mul_add(v0, x0).into();
    }
}

#[inline(always)]
fn sweep<S: Simd>(
    simd: S,
    motion: &mut Motion,
    now: &mut [f64],
    (awake, lanes): (Range<usize>, usize),
    force: &[f64],
    scaled: &Scaled,
) {
    let count = awake.end;
    let load = |chunk: &[f64; WIDTH]| -> f64x8<S> { (*chunk).simd_into(simd) };
    let drift = load(&scaled.drift);
    let velocity: [f64x8<S>; USED] = std::array::from_fn(|k| load(&scaled.velocity[k]));
    let position: [f64x8<S>; USED] = std::array::from_fn(|k| load(&scaled.position[k]));
    let (left, right) = (chunks_of(force, count), chunks_of(&force[lanes..], count));
    let earlier: [&[[f64; WIDTH]]; EARLIER] = std::array::from_fn(|k| {
        chunks_of(&motion.accelerations[(motion.newest + 1 + k) % USED], count)
    });
    let x = motion.x[..count * WIDTH].as_chunks_mut().0;
    let v = motion.v[..count * WIDTH].as_chunks_mut().0;
    let now = now[..count * WIDTH].as_chunks_mut().0;
    let external = motion.external.as_ref().map(|a| chunks_of(a, count));
    let inverse_mass = motion.inverse_mass.reader();
    for i in awake {
        let mut a = (load(&left[i]) - load(&right[i])) * load(inverse_mass.at(i));
        if let Some(external) = external {
            a += load(&external[i]);
        }
        now[i] = a.into();
        let (x0, v0) = (load(&x[i]), load(&v[i]));
        // Two chains of sums each, so that one need not wait for the other.
        let a1 = load(&earlier[0][i]);
        let mut sped = [velocity[0].mul_add(a, v0), velocity[1] * a1];
        let mut moved = [
            position[0] * a,
            position[1].mul_add(a1, drift.mul_add(v0, x0)),
        ];
        for k in 2..USED {
            let a = load(&earlier[k - 1][i]);
            sped[k % 2] = velocity[k].mul_add(a, sped[k % 2]);
            moved[k % 2] = position[k].mul_add(a, moved[k % 2]);
        }
        v[i] = (sped[0] + sped[1]).into();
        x[i] = (moved[0] + moved[1]).into();
    }
}
