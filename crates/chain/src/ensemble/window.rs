//! The part of the chain that a step has to look at.
//!
//! Ahead of the wave nothing has moved. Where the wave has been, contacts that
//! stay open until the next look give no force, and bodies between such
//! contacts fly on. Leaving out what they would add changes no bit.

use super::column::{Reader, WIDTH, chunks};
use crate::system::System;
use std::ops::Range;

/// Positions, velocities and how contacts hang on them.
#[derive(Clone, Copy)]
pub(super) struct Places<'a> {
    pub offset_m: Reader<'a>,
    pub x: &'a [f64],
    pub v: &'a [f64],
    pub lanes: usize,
}

impl Places<'_> {
    /// Whether a chunk of contacts is open and stays so for a time, unless a
    /// force moves its bodies.
    #[inline]
    fn stays_open(&self, chunk: usize, ahead_s: &[f64; WIDTH]) -> bool {
        let side = |values: &[f64], from: usize| -> [f64; WIDTH] {
            let side = values[from..].first_chunk();
            side.copied().unwrap_or([f64::NAN; WIDTH])
        };
        let (left, right) = (chunk * WIDTH, chunk * WIDTH + self.lanes);
        let (x, beyond) = (side(self.x, left), side(self.x, right));
        let (v, ahead) = (side(self.v, left), side(self.v, right));
        let offset_m = self.offset_m.at(chunk);
        let mut open = true;
        for i in 0..WIDTH {
            let now = offset_m[i] - (beyond[i] - x[i]);
            let then = now + (v[i] - ahead[i]) * ahead_s[i];
            open &= now < 0.0 && then < 0.0;
        }
        open
    }
}

/// Chunks that a step looks at.
#[derive(Clone, Debug)]
pub(super) struct Window {
    /// Chunks from the striker on that the wave has reached in any lane.
    pub chunks: usize,
    /// Chunks of contacts whose force must be computed.
    pub contacts: Range<usize>,
    /// Chunks of bodies that forces have moved within the memory of the
    /// method; those outside fly on.
    pub bodies: Range<usize>,
    all: usize,
    /// Chunks that hold contacts.
    with_contacts: usize,
    /// Nothing but contacts moves bodies.
    may_sleep: bool,
}

impl Window {
    pub fn new(systems: &[&System], (x, v): (&[f64], &[f64]), whole_chain: bool) -> Self {
        let lanes = systems.len();
        let all = chunks(systems[0].bodies(), lanes);
        let with_contacts = chunks(systems[0].contacts(), lanes);
        let moves = |at: &usize| x[*at] != 0.0 || v[*at] != 0.0;
        let last = (0..all * WIDTH).rev().find(moves).unwrap_or(0);
        let pulled = systems.iter().any(|s| s.slope_m_s2 != 0.0 || s.periodic);
        let reached = match whole_chain || pulled {
            true => all,
            false => (last / WIDTH + 2).min(all),
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
    pub fn follow(&mut self, places: Places<'_>) {
        if self.chunks < self.all {
            let edge = &places.v[(self.chunks - 1) * WIDTH..self.chunks * WIDTH];
            if edge.iter().any(|&v| v != 0.0) {
                self.grow();
            }
        }
        let now = [0.0; WIDTH];
        while self.contacts.start > 0 && !places.stays_open(self.contacts.start - 1, &now) {
            self.contacts.start -= 1;
        }
        while self.contacts.end < self.reached_contacts()
            && !places.stays_open(self.contacts.end, &now)
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
    pub fn look(&mut self, places: Places<'_>, ahead_s: &[f64; WIDTH]) {
        if !self.may_sleep {
            return;
        }
        let slept = self.contacts.clone();
        let awake = |chunk: &usize| !places.stays_open(*chunk, ahead_s);
        let first = (0..self.reached_contacts()).find(awake).unwrap_or(0);
        let last = (first..self.reached_contacts())
            .rev()
            .find(awake)
            .unwrap_or(first);
        // Ahead of the wave contacts touch: nothing there is open.
        self.contacts = first..(last + 1).min(self.reached_contacts());
        self.bodies = slept.start..(slept.end + 1).min(self.chunks);
        self.wake_bodies();
    }

    /// All chunks.
    pub fn whole(&self) -> Self {
        Self {
            chunks: self.all,
            contacts: 0..self.with_contacts,
            bodies: 0..self.all,
            ..self.clone()
        }
    }
}
