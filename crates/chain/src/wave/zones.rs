//! Two clocks in one long chain.
//!
//! A pulse needs short steps; what creeps and rattles behind it, or lies loose
//! ahead of it, does not. Where many bodies are awake and few of them need the
//! short step, the others take one long step of the same method first, and the
//! few follow with short steps to its end. At the seam the few feel bodies that
//! move as the long step's dense output says.

use super::dense::polynomial;
use super::state::WaveState;
use super::table::Table;
use crate::system::System;
use std::ops::Range;

/// Bodies between the last one that needs short steps and the seam: a step
/// carries errors over as many bodies as it has stages.
const MARGIN: usize = 12;

/// Fewer bodies are not worth two clocks.
const LEAST_BODIES: usize = 128;

/// Short steps between looks whether two clocks pay.
const LOOK_EVERY: usize = 16;

/// Long over short step: where it begins, and its bounds.
const RATIO: f64 = 8.0;
const RATIOS: (f64, f64) = (3.0, 64.0);

/// A long step changes its ratio by this factor.
const ADJUST: f64 = 1.05;

#[derive(Clone, Debug)]
pub(super) struct LongStep {
    /// Between the start and the end of a long step.
    pub active: bool,
    pub start_s: f64,
    pub step_s: f64,
    /// Bodies with short steps; those of the window outside have the long one.
    pub quick: Range<usize>,
    /// Bodies that were awake when the long step began.
    window: Range<usize>,
    /// Accelerations of its stages, and positions and velocities at its end.
    pub a: Vec<Vec<f64>>,
    pub x: Vec<f64>,
    pub v: Vec<f64>,
    ratio: f64,
    wait: usize,
}

impl LongStep {
    /// Of a chain in which it may pay, or of none.
    pub(super) fn new(system: &System, stages: usize, pays: bool) -> Self {
        let bodies = || vec![0.0; if pays { system.bodies() } else { 0 }];
        Self {
            active: false,
            start_s: 0.0,
            step_s: 0.0,
            quick: 0..0,
            window: 0..0,
            a: vec![bodies(); stages],
            x: bodies(),
            v: bodies(),
            ratio: RATIO,
            wait: if pays { LOOK_EVERY } else { usize::MAX },
        }
    }

    /// Whether it is time to try a long step; counts the short ones.
    pub(super) fn is_due(&mut self, awake: usize) -> bool {
        if self.wait == usize::MAX || awake < LEAST_BODIES {
            return false;
        }
        self.wait = self.wait.saturating_sub(1);
        self.wait == 0
    }

    /// Length of a long step beside short ones.
    pub(super) fn proposed_s(&self, short_s: f64) -> f64 {
        self.ratio * short_s
    }

    /// Whether bodies with short steps are around those that need them, and few more.
    pub(super) fn suits(&self, needy: &Range<usize>, window: &Range<usize>) -> bool {
        let quick = self.quick.start.max(window.start)..self.quick.end.min(window.end);
        let start = needy.start.saturating_sub(MARGIN).max(window.start);
        let end = (needy.end + MARGIN).min(window.end);
        quick.start <= start && quick.end >= end && quick.len() <= needy.len() + 8 * MARGIN
    }

    /// Half the long step, unless that is no gain.
    pub(super) fn shorten(&mut self) -> bool {
        self.ratio *= 0.5;
        self.ratio >= RATIOS.0
    }

    /// A longer step, unless it is at its bound.
    pub(super) fn lengthen(&mut self) -> bool {
        self.ratio *= 2.0;
        self.ratio <= RATIOS.1
    }

    pub(super) fn give_up(&mut self) {
        self.wait = LOOK_EVERY;
        self.ratio = self.ratio.clamp(RATIOS.0, RATIOS.1);
        self.quick = 0..0;
    }

    /// Begins a long step that has been computed.
    pub(super) fn begin(&mut self, (start_s, step_s): (f64, f64), window: Range<usize>) {
        self.active = true;
        (self.start_s, self.step_s) = (start_s, step_s);
        let quick = self.quick.start.max(window.start)..self.quick.end.min(window.end);
        let balanced = quick.len() as f64 * self.ratio;
        let ratio = match balanced < window.len() as f64 {
            true => self.ratio * ADJUST,
            false => self.ratio / ADJUST,
        };
        self.ratio = ratio.clamp(RATIOS.0, RATIOS.1);
        self.window = window;
    }

    /// Bodies that shall have short steps, around those that need them; `None`
    /// where that is too large a part of the window.
    pub(super) fn around(
        needy: Range<usize>,
        window: &Range<usize>,
        (bodies, reaches): (usize, usize),
    ) -> Option<Range<usize>> {
        let start = needy.start.saturating_sub(2 * MARGIN);
        let end = needy.end + 2 * MARGIN;
        let start = if start < window.start + 2 * MARGIN { 0 } else { start };
        // Ahead of a wave that still runs on, bodies wake at every short step.
        let runs_on = window.end == reaches && window.end < bodies;
        let end = if runs_on || end + 2 * MARGIN > window.end { bodies } else { end };
        let quick = end.min(window.end) - start.max(window.start);
        (2 * quick < window.len()).then_some(start..end)
    }

    pub(super) fn end_s(&self) -> f64 {
        self.start_s + self.step_s
    }

    /// Whether a body is on the long step.
    pub(super) fn holds(&self, body: usize) -> bool {
        self.active && self.window.contains(&body) && !self.quick.contains(&body)
    }

    pub(super) fn holds_contact(&self, contact: usize) -> bool {
        self.holds(contact) && self.holds(contact + 1)
    }

    pub(super) fn bodies(&self) -> impl Iterator<Item = usize> + use<> {
        let before = self.window.start..self.quick.start.max(self.window.start);
        let after = self.quick.end.min(self.window.end)..self.window.end;
        before.chain(after)
    }

    /// The short-stepped bodies of a window and one more at each seam.
    pub(super) fn quick_with_seams(&self, window: &Range<usize>) -> Range<usize> {
        let start = self.quick.start.saturating_sub(1).max(window.start);
        start..self.quick.end.saturating_add(1).min(window.end)
    }

    /// Contacts of which neither body has short steps: on both sides of the seams.
    pub(super) fn contacts(quick: &Range<usize>, window: &Range<usize>) -> [Range<usize>; 2] {
        let before = window.start..quick.start.saturating_sub(1).max(window.start);
        let after = quick.end.min(window.end - 1)..window.end - 1;
        [before, after]
    }

    /// Weights of the stages' powers from the start of the long step to a time.
    pub(super) fn weights(&self, table: &Table, time_s: f64) -> Vec<f64> {
        let theta = (time_s - self.start_s) / self.step_s;
        let dense = table.dense_velocity.iter();
        dense.map(|row| polynomial(row, theta)).collect()
    }

    /// Displacement and velocity of a body on the long step.
    pub(super) fn at(
        &self,
        table: &Table,
        state: &WaveState,
        body: usize,
        time_s: f64,
    ) -> (f64, f64) {
        let h = self.step_s;
        let theta = (time_s - self.start_s) / h;
        let (mut moved, mut sped) = (0.0, 0.0);
        let rows = table.dense_velocity.iter().zip(&table.dense_position);
        for (a, (velocity, position)) in self.a.iter().zip(rows) {
            sped += polynomial(velocity, theta) * a[body];
            moved += polynomial(position, theta) * a[body];
        }
        let (x, v) = (state.x[body], state.v[body]);
        (x + h * theta * v + h * h * moved, v + h * sped)
    }

    /// A state at a time within the long step: all bodies and gates there.
    pub(super) fn bring_to(
        &self,
        system: &System,
        table: &Table,
        state: &mut WaveState,
        time_s: f64,
    ) {
        if !self.active {
            return;
        }
        let now: Vec<(usize, (f64, f64))> =
            self.bodies().map(|body| (body, self.at(table, state, body, time_s))).collect();
        for (body, (x, v)) in now {
            (state.x[body], state.v[body]) = (x, v);
        }
        self.set_gates(system, state);
    }

    /// The state at the end of the long step.
    pub(super) fn finish(&mut self, system: &System, state: &mut WaveState) {
        for body in self.bodies() {
            (state.x[body], state.v[body]) = (self.x[body], self.v[body]);
        }
        self.set_gates(system, state);
        state.time_s = self.end_s();
        self.active = false;
        self.wait = 1;
    }

    /// Gates that the long step has looked at afresh in every pass.
    fn set_gates(&self, system: &System, state: &mut WaveState) {
        for contact in Self::contacts(&self.quick, &self.window).into_iter().flatten() {
            state.follow(system, contact);
        }
    }
}
