//! The sweep over bodies: from contact forces to the next step's positions
//! and velocities.

use super::aligned::Aligned;
use super::column::LaneColumn;
use super::number::Number;
use super::weights::{EARLIER, USED, Weights};
use super::window::LaneWindow;
use crate::system::System;
use fearless_simd::prelude::*;
use std::ops::Range;

#[derive(Debug)]
pub(super) struct LaneMotion<N, const W: usize> {
    /// Predicted positions and velocities, with a chunk to spare.
    pub x: Aligned<N>,
    pub v: Aligned<N>,
    /// Accelerations of the last steps in units of [`unit_per_kg`]: the newest
    /// at `newest`, older ones after it, round the ring.
    accelerations: [Aligned<N>; USED],
    newest: usize,
    inverse_mass: LaneColumn<N, W>,
    /// Accelerations by what is not a contact, in that unit, if anything is.
    pub external: Option<Aligned<N>>,
}

/// The inverse mass that accelerations are multiples of, in 1/kg: bead 1's, so
/// that a row of equal balls accelerates by as much as its forces say, and no
/// sweep multiplies by a mass. Weights hold it instead.
pub(super) fn unit_per_kg(system: &System) -> f64 {
    system.inverse_mass[1]
}

#[derive(Clone, Copy, Debug)]
pub(super) struct LanePace {
    /// Full step in s.
    pub step_s: f64,
    /// How much a step is [ahead of](super::weights::ahead_of) the exact motion.
    pub ahead: f64,
    /// [`unit_per_kg`].
    pub unit_per_kg: f64,
}

/// Weights times powers of each lane's step and its unit of accelerations.
#[derive(Clone, Debug)]
pub(super) struct LaneScaled<N, const W: usize> {
    drift: [N; W],
    velocity: [[N; W]; USED],
    position: [[N; W]; USED],
}

impl<N: Number<W>, const W: usize> LaneScaled<N, W> {
    pub(super) fn new(weights: &Weights, paces: &[LanePace; W]) -> Self {
        let none = [N::default(); W];
        let (mut velocity, mut position) = ([none; USED], [none; USED]);
        for (lane, pace) in paces.iter().enumerate() {
            let sped = pace.step_s * pace.unit_per_kg;
            let moved = pace.step_s * sped;
            let weighted = weights.velocity(pace.ahead);
            for k in 0..USED {
                velocity[k][lane] = N::of(sped * weighted[k]);
                position[k][lane] = N::of(moved * weights.position[k]);
            }
        }
        Self { drift: paces.map(|pace| N::of(pace.step_s * weights.drift)), velocity, position }
    }
}

impl<N: Number<W>, const W: usize> LaneMotion<N, W> {
    /// From positions and velocities, with nothing accelerated yet.
    pub(super) fn new(
        x: Aligned<N>,
        v: Aligned<N>,
        inverse_mass: LaneColumn<N, W>,
        external: bool,
    ) -> Self {
        let zeros = || Aligned::of(N::default(), x.len());
        Self {
            accelerations: std::array::from_fn(|_| zeros()),
            newest: 0,
            inverse_mass,
            external: external.then(zeros),
            x,
            v,
        }
    }

    pub(super) fn accelerations(&self, age: usize) -> &[N] {
        &self.accelerations[(self.newest + age) % USED]
    }

    /// Sets a body where no other is; nothing has ever moved it.
    pub(super) fn set_apart(&mut self, at: usize, x: N) {
        self.x[at] = x;
        for accelerations in &mut self.accelerations {
            accelerations[at] = N::default();
        }
    }

    pub(super) fn newest_mut(&mut self) -> &mut [N] {
        &mut self.accelerations[self.newest]
    }

    /// One step of what the wave has reached: `force` holds the dynamic force
    /// on each body from the left, and `lanes` further on from the right.
    #[inline(always)]
    pub(super) fn step<S: Simd>(
        &mut self,
        simd: S,
        window: &LaneWindow,
        lanes: usize,
        force: &[N],
        scaled: &LaneScaled<N, W>,
    ) {
        self.newest = (self.newest + USED - 1) % USED;
        let mut now = std::mem::take(&mut self.accelerations[self.newest]);
        let (awake, all) = (window.bodies.clone(), window.chunks);
        fly(simd, self, 0..awake.start, scaled);
        sweep(simd, self, &mut now, (awake.clone(), lanes), force, scaled);
        fly(simd, self, awake.end..all, scaled);
        self.accelerations[self.newest] = now;
    }
}

#[inline(always)]
fn chunks_of<N, const W: usize>(values: &[N], which: Range<usize>) -> &[[N; W]] {
    values[which.start * W..which.end * W].as_chunks().0
}

#[inline(always)]
fn chunks_of_mut<N, const W: usize>(values: &mut [N], which: Range<usize>) -> &mut [[N; W]] {
    values[which.start * W..which.end * W].as_chunks_mut().0
}

/// Bodies that no force has moved of late: what [`sweep`] does to them, but for
/// adding zeros.
#[inline(always)]
fn fly<S: Simd, N: Number<W>, const W: usize>(
    simd: S,
    motion: &mut LaneMotion<N, W>,
    asleep: Range<usize>,
    scaled: &LaneScaled<N, W>,
) {
    let load = |chunk: &[N; W]| N::Wide::<S>::load_array_ref(simd, chunk);
    let drift = load(&scaled.drift);
    let v = chunks_of::<N, W>(&motion.v, asleep.clone());
    let x = chunks_of_mut::<N, W>(&mut motion.x, asleep);
    for (x, v) in x.iter_mut().zip(v) {
        let (x0, v0) = (load(x), load(v));
        (x0 + drift * v0).store_array(x);
    }
}

#[inline(always)]
fn sweep<S: Simd, N: Number<W>, const W: usize>(
    simd: S,
    motion: &mut LaneMotion<N, W>,
    now: &mut [N],
    (awake, lanes): (Range<usize>, usize),
    force: &[N],
    scaled: &LaneScaled<N, W>,
) {
    let load = |chunk: &[N; W]| N::Wide::<S>::load_array_ref(simd, chunk);
    let mut earlier = [&[] as &[_]; EARLIER];
    for (age, earlier) in (1..).zip(&mut earlier) {
        let at = (motion.newest + age) % USED;
        *earlier = chunks_of(&motion.accelerations[at], awake.clone());
    }
    let bodies = LaneBodies {
        force: [force, &force[lanes..]].map(|force| chunks_of(force, awake.clone())),
        earlier,
        now: chunks_of_mut(now, awake.clone()),
        x: chunks_of_mut(&mut motion.x, awake.clone()),
        v: chunks_of_mut(&mut motion.v, awake.clone()),
    };
    match (motion.inverse_mass.is_all(1.0), &motion.external) {
        (true, None) => bodies.step(simd, scaled, |_, net| net),
        (false, None) => {
            let mass = &motion.inverse_mass.reader().all()[awake];
            bodies.step(simd, scaled, |i, net| net * load(&mass[i]));
        }
        (_, Some(external)) => {
            let (mass, from) = (motion.inverse_mass.reader(), awake.start);
            let external = chunks_of(external, awake);
            bodies.step(simd, scaled, |i, net| net * load(mass.at(from + i)) + load(&external[i]));
        }
    }
}

struct LaneBodies<'a, N, const W: usize> {
    force: [&'a [[N; W]]; 2],
    earlier: [&'a [[N; W]]; EARLIER],
    now: &'a mut [[N; W]],
    x: &'a mut [[N; W]],
    v: &'a mut [[N; W]],
}

impl<N: Number<W>, const W: usize> LaneBodies<'_, N, W> {
    /// A step of bodies that accelerate as follows from their place and net force.
    #[inline(always)]
    fn step<S: Simd>(
        self,
        simd: S,
        scaled: &LaneScaled<N, W>,
        acceleration: impl Fn(usize, N::Wide<S>) -> N::Wide<S>,
    ) {
        let load = |chunk: &[N; W]| N::Wide::<S>::load_array_ref(simd, chunk);
        let drift = load(&scaled.drift);
        let velocity: [_; USED] = std::array::from_fn(|k| load(&scaled.velocity[k]));
        let position: [_; USED] = std::array::from_fn(|k| load(&scaled.position[k]));
        // Of lengths that are seen to be the same, so that nothing is checked in the loop.
        let count = self.now.len();
        let (now, x, v) = (self.now, &mut self.x[..count], &mut self.v[..count]);
        let [left, right] = self.force.map(|force| &force[..count]);
        let earlier = self.earlier.map(|a| &a[..count]);
        for i in 0..count {
            let a = acceleration(i, load(&left[i]) - load(&right[i]));
            a.store_array(&mut now[i]);
            let (x0, v0) = (load(&x[i]), load(&v[i]));
            // What is small first: single precision rounds once where it is large.
            let mut sped = velocity[0] * a;
            let mut moved = position[0] * a;
            for k in 1..USED {
                let a = load(&earlier[k - 1][i]);
                sped = velocity[k].mul_add(a, sped);
                moved = position[k].mul_add(a, moved);
            }
            (v0 + sped).store_array(&mut v[i]);
            (x0 + drift.mul_add(v0, moved)).store_array(&mut x[i]);
        }
    }
}
