//! The part of the chain that moves.
//!
//! Bodies that the wave has not reached have not moved at all, so leaving them
//! out changes no bit. Where it has been, in a chain without loads, bodies whose
//! contacts are open or relaxed fly on straight lines and are left out too, on
//! both sides of what still moves; in long chains only.

use super::state::WaveState;
use crate::system::System;
use std::ops::Range;

/// Bodies are woken and put to sleep in groups of this size.
const GROUP: usize = 4;

/// Chains shorter than this gain nothing from sleep where the wave has been.
const LONG_CHAIN: usize = 512;

/// Steps between looks for bodies that may sleep.
const LOOK_EVERY: usize = 64;

/// Relative velocities and overlaps below the tolerance of a step, or below
/// this fraction of the shot's scales where steps are fixed, are what errors
/// and rounding leave behind a wave, not motion.
const RELAXED: f64 = 1e-13;

/// Under load, deviations from rest below this fraction of the shot's scales
/// do not wake a body: round-off of the static forces themselves.
const AT_REST_UNDER_LOAD: f64 = 1e-17;

#[derive(Clone, Debug)]
pub(crate) struct MovingBodies {
    pub bodies: Range<usize>,
    /// Since when each body outside the window flies or rests, in s.
    pub asleep_since_s: Vec<f64>,
    margin: usize,
    speed_floor: f64,
    length_floor: f64,
    relaxed_speed: f64,
    relaxed_length: f64,
    untouched: usize,
    sleeps_again: bool,
    until_look: usize,
}

impl MovingBodies {
    pub(super) fn new(
        system: &System,
        state: &WaveState,
        (stages, tolerance): (usize, f64),
        whole_chain: bool,
    ) -> Self {
        let scales = system.scales();
        let loaded = system.static_force_n.iter().any(|&force| force != 0.0);
        let floor = if loaded { AT_REST_UNDER_LOAD } else { 0.0 };
        let relaxed = tolerance.max(RELAXED);
        let mut window = Self {
            bodies: 0..system.bodies(),
            asleep_since_s: vec![0.0; system.bodies()],
            margin: stages + 1,
            speed_floor: floor * scales.speed_m_s,
            length_floor: floor * scales.speed_m_s * scales.time_s,
            relaxed_speed: relaxed * scales.speed_m_s,
            relaxed_length: relaxed * scales.speed_m_s * scales.time_s,
            untouched: system.bodies(),
            sleeps_again: !whole_chain
                && system.beads() >= LONG_CHAIN
                && system.flies_free()
                && !system.has_states,
            until_look: LOOK_EVERY,
        };
        let starts_moving = system.motion.is_some() || system.slope_m_s2 != 0.0;
        if !whole_chain && !system.periodic {
            let last = (0..system.bodies()).rev().find(|&i| window.moves(state, i));
            let last = last.unwrap_or(0).max(usize::from(starts_moving));
            window.bodies.end = (last + window.margin + GROUP).min(system.bodies());
            window.untouched = window.bodies.end;
        }
        window
    }

    fn moves(&self, state: &WaveState, body: usize) -> bool {
        state.x[body].abs() > self.length_floor || state.v[body].abs() > self.speed_floor
    }

    /// Whether bodies may sleep where the wave has been: in long chains on which
    /// nothing but contacts acts.
    pub(super) fn sleeps_again(&self) -> bool {
        self.sleeps_again
    }

    pub(super) fn untouched(&self) -> usize {
        self.untouched
    }

    /// Within a long step: wakes what short steps may have reached, on the sides
    /// (of the striker, of the wall) where they go to the window's edge.
    pub(super) fn keep_up(&mut self, system: &System, state: &mut WaveState, sides: [bool; 2]) {
        if sides[0] {
            self.wake_before(system, state);
        }
        if sides[1] {
            self.wake_untouched(state);
            self.wake_beyond(system, state);
        }
    }

    /// Wakes what the last step may have reached, and lets sleep what relaxed.
    pub(super) fn follow(&mut self, system: &System, state: &mut WaveState) {
        self.wake_untouched(state);
        if !self.sleeps_again {
            return;
        }
        self.wake_before(system, state);
        self.wake_beyond(system, state);
        self.until_look -= 1;
        if self.until_look == 0 {
            self.until_look = LOOK_EVERY;
            self.sleep_before(system, state);
            self.sleep_beyond(system, state);
        }
    }

    /// A step moves at most `stages` more bodies: that many must be at rest
    /// at the window's edge.
    fn wake_untouched(&mut self, state: &WaveState) {
        let all = state.x.len();
        while self.bodies.end == self.untouched
            && self.bodies.end < all
            && (self.bodies.end - self.margin..self.bodies.end).any(|i| self.moves(state, i))
        {
            self.bodies.end = (self.bodies.end + GROUP).min(all);
            self.untouched = self.bodies.end;
        }
    }

    fn is_quiet(&self, system: &System, state: &WaveState, contact: usize) -> bool {
        if !system.has_contact(contact) {
            return true;
        }
        let overlap = state.overlap(system, contact);
        let rate = state.v[contact] - state.v[contact + 1];
        let open = overlap < -self.relaxed_length;
        let relaxed = overlap <= self.relaxed_length && rate.abs() <= self.relaxed_speed;
        (open && rate <= self.relaxed_speed) || relaxed
    }

    /// Brings the positions of bodies up to date.
    fn wake(&mut self, state: &mut WaveState, bodies: Range<usize>) {
        for i in bodies {
            state.x[i] += state.v[i] * (state.time_s - self.asleep_since_s[i]);
            self.asleep_since_s[i] = state.time_s;
        }
    }

    /// Wakes bodies on the striker's side that something is about to reach.
    fn wake_before(&mut self, system: &System, state: &mut WaveState) {
        let first = self.bodies.start;
        let edge = first..(first + self.margin).min(self.bodies.end - 1);
        if first > 0 && edge.into_iter().any(|c| !self.is_quiet(system, state, c)) {
            let to = first.saturating_sub(GROUP);
            self.wake(state, to..first);
            self.bodies.start = to;
        }
    }

    /// The same on the wall's side, where the wave has been.
    fn wake_beyond(&mut self, system: &System, state: &mut WaveState) {
        let end = self.bodies.end;
        let edge = (end - 1).saturating_sub(self.margin).max(self.bodies.start)..end - 1;
        if end < self.untouched && edge.into_iter().any(|c| !self.is_quiet(system, state, c)) {
            let to = (end + GROUP).min(self.untouched);
            self.wake(state, end..to);
            self.bodies.end = to;
        }
    }

    fn sleep_before(&mut self, system: &System, state: &WaveState) {
        let first = self.bodies.start;
        let quiet_until = (first..self.bodies.end - 1)
            .find(|&c| !self.is_quiet(system, state, c))
            .unwrap_or(first);
        let to = quiet_until.saturating_sub(self.margin + GROUP);
        if to > first + GROUP {
            self.asleep_since_s[first..to].fill(state.time_s);
            self.bodies.start = to;
        }
    }

    fn sleep_beyond(&mut self, system: &System, state: &WaveState) {
        let end = self.bodies.end;
        // Ahead of a wave that still runs on, everything is quiet for good.
        if self.bodies.end == self.untouched && end < system.bodies() {
            return;
        }
        let quiet_from = (self.bodies.start..end - 1)
            .rev()
            .find(|&c| !self.is_quiet(system, state, c))
            .map_or(end, |c| c + 2);
        let to = quiet_from + self.margin + GROUP;
        if to + GROUP < end {
            self.asleep_since_s[to..end].fill(state.time_s);
            self.bodies.end = to;
        }
    }

    pub(super) fn wake_all(&mut self, state: &mut WaveState) {
        let (first, end) = (self.bodies.start, self.bodies.end);
        self.wake(state, 0..first);
        self.wake(state, end..state.x.len());
    }
}
