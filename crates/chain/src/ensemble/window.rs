//! The part of the chain that a step has to look at.
//!
//! Ahead of the wave nothing has moved. Where the wave has been, contacts that
//! stay open until the next look give no force, and bodies between such
//! contacts fly on. Leaving out what they would add changes no bit.

use super::column::{ColumnReader, chunks};
use super::number::Number;
use crate::instruction_set::InstructionSet;
use crate::system::System;
use fearless_simd::{dispatch, prelude::*};
use std::ops::Range;

/// Rounding of a position over the steps between looks, in roundings of one.
const ROUNDINGS: f64 = 32.0;

/// Positions, velocities and how contacts hang on them.
#[derive(Clone, Copy)]
pub(super) struct Places<'a, N, const W: usize> {
    pub offset_m: ColumnReader<'a, N, W>,
    pub x: &'a [N],
    pub v: &'a [N],
    pub lanes: usize,
}

impl<N: Number<W>, const W: usize> Places<'_, N, W> {
    /// Whether a chunk of contacts is open and stays so for a time, whatever
    /// rounding does, unless a force moves its bodies.
    #[inline(always)]
    fn stays_open<S: Simd>(&self, simd: S, chunk: usize, ahead_s: &[N; W]) -> bool {
        let load =
            |values: &[N], from: usize| N::Wide::<S>::from_slice(simd, &values[from..from + W]);
        let (left, right) = (chunk * W, chunk * W + self.lanes);
        let (x, beyond) = (load(self.x, left), load(self.x, right));
        let rate = load(self.v, left) - load(self.v, right);
        let now = load(self.offset_m.at(chunk), 0) - (beyond - x);
        let rounded = (x.abs() + beyond.abs()) * N::of(ROUNDINGS * N::ROUNDING);
        let then = rate.mul_add(load(ahead_s, 0), now) + rounded;
        let zero = N::Wide::<S>::simd_from(simd, N::default());
        (now.simd_lt(zero) & then.simd_lt(zero)).all_true()
    }

    #[inline(always)]
    fn moves<S: Simd>(&self, simd: S, chunk: usize) -> bool {
        let v = N::Wide::<S>::from_slice(simd, &self.v[chunk * W..(chunk + 1) * W]);
        v.simd_ne(N::Wide::<S>::simd_from(simd, N::default())).any_true()
    }
}

#[derive(Clone, Debug)]
pub(super) struct LaneWindow {
    /// Chunks from the striker on that the wave has reached in any lane.
    pub chunks: usize,
    /// Chunks of contacts whose force must be computed.
    pub contacts: Range<usize>,
    /// Chunks of bodies that forces have moved within the memory of the
    /// method; those outside fly on.
    pub bodies: Range<usize>,
    all: usize,
    with_contacts: usize,
    may_sleep: bool,
}

impl LaneWindow {
    /// Of chains whose first `moving` bodies can move, from where those are.
    pub(super) fn new<N: Number<W>, const W: usize>(
        (lanes, systems): (usize, &[&System]),
        (x, v): (&[N], &[N]),
        moving: usize,
        whole_chain: bool,
    ) -> Self {
        let all = chunks::<W>(moving, lanes);
        let with_contacts = chunks::<W>(systems[0].contacts(), lanes);
        let rest = N::default();
        let moves = |at: &usize| x[*at] != rest || v[*at] != rest;
        let last = (0..all * W).rev().find(moves).unwrap_or(0);
        let pulled = systems.iter().any(|s| s.slope_m_s2 != 0.0 || s.periodic);
        let reached = match whole_chain || pulled {
            true => all,
            false => (last / W + 2).min(all),
        };
        Self {
            chunks: reached,
            contacts: 0..reached.min(with_contacts),
            with_contacts,
            bodies: 0..reached,
            all,
            may_sleep: !whole_chain && systems.iter().all(|system| system.flies_free()),
        }
    }

    /// Takes in what the last step has reached: the next chunk once the last
    /// one moves, and sleeping contacts next to what is awake once they close.
    #[inline(always)]
    pub(super) fn follow<S: Simd, N: Number<W>, const W: usize>(
        &mut self,
        simd: S,
        places: Places<'_, N, W>,
    ) {
        if self.chunks < self.all && places.moves(simd, self.chunks - 1) {
            self.grow();
        }
        let now = [N::default(); W];
        while self.contacts.start > 0 && !places.stays_open(simd, self.contacts.start - 1, &now) {
            self.contacts.start -= 1;
        }
        while self.contacts.end < self.reached_contacts()
            && !places.stays_open(simd, self.contacts.end, &now)
        {
            self.contacts.end += 1;
        }
        self.wake_bodies();
    }

    /// Chunks of contacts that the wave has reached.
    fn reached_contacts(&self) -> usize {
        self.chunks.min(self.with_contacts)
    }

    fn grow(&mut self) {
        let awake = self.contacts.end == self.reached_contacts();
        self.chunks += 1;
        if awake {
            self.contacts.end = self.reached_contacts();
        }
    }

    /// Bodies at contacts that are awake are awake.
    fn wake_bodies(&mut self) {
        self.bodies.start = self.bodies.start.min(self.contacts.start);
        let end = (self.contacts.end + 1).min(self.chunks);
        self.bodies.end = self.bodies.end.max(end);
    }

    /// Lets sleep what stays open for a time from here; contacts that have
    /// slept since the last look have let their bodies forget all forces.
    pub(super) fn look<N: Number<W>, const W: usize>(
        &mut self,
        set: InstructionSet,
        places: Places<'_, N, W>,
        ahead_s: &[N; W],
    ) {
        if !self.may_sleep {
            return;
        }
        let slept = self.contacts.clone();
        // Ahead of the wave contacts touch: nothing there is open.
        self.contacts = dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || self.awake(simd, places, ahead_s)
        ));
        self.bodies = slept.start..(slept.end + 1).min(self.chunks);
        self.wake_bodies();
    }

    /// From the first to the last contact that does not stay open.
    #[inline(always)]
    fn awake<S: Simd, N: Number<W>, const W: usize>(
        &self,
        simd: S,
        places: Places<'_, N, W>,
        ahead_s: &[N; W],
    ) -> Range<usize> {
        let reached = self.reached_contacts();
        let mut first = 0;
        while first < reached && places.stays_open(simd, first, ahead_s) {
            first += 1;
        }
        let mut end = reached;
        while end > first && places.stays_open(simd, end - 1, ahead_s) {
            end -= 1;
        }
        match first < end {
            true => first..end,
            false => 0..reached.min(1),
        }
    }

    pub(super) fn whole(&self) -> Self {
        Self {
            chunks: self.all,
            contacts: 0..self.with_contacts,
            bodies: 0..self.all,
            ..self.clone()
        }
    }
}
