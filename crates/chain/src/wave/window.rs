//! The part of the chain that moves.
//!
//! Bodies ahead of the wave have not moved at all, so leaving them out changes
//! no bit. Behind it, in a chain without loads, bodies whose contacts are open
//! or relaxed fly on straight lines and are left out too, in long chains only.

use super::state::State;
use crate::system::System;
use std::ops::Range;

/// Bodies are woken and put to sleep in groups of this size.
const GROUP: usize = 4;

/// Chains shorter than this gain nothing from sleep behind the wave.
const LONG_CHAIN: usize = 512;

/// Steps between looks behind the wave.
const LOOK_EVERY: usize = 64;

/// Relative velocities and overlaps below the tolerance of a step, or below
/// this fraction of the shot's scales where steps are fixed, are what errors
/// and rounding leave behind a wave, not motion.
const RELAXED: f64 = 1e-13;

/// Under load, deviations from rest below this fraction of the shot's scales
/// do not wake a body: round-off of the static forces themselves.
const AT_REST_UNDER_LOAD: f64 = 1e-17;

#[derive(Clone, Debug)]
pub(crate) struct Window {
    pub bodies: Range<usize>,
    /// Since when each body outside the window flies or rests, in s.
    pub asleep_since_s: Vec<f64>,
    margin: usize,
    speed_floor: f64,
    length_floor: f64,
    relaxed_speed: f64,
    relaxed_length: f64,
    sleeps_behind: bool,
    until_look: usize,
}

impl Window {
    pub fn new(
        system: &System,
        state: &State,
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
            sleeps_behind: !whole_chain && system.beads() >= LONG_CHAIN && system.flies_free(),
            until_look: LOOK_EVERY,
        };
        let starts_moving = system.motion.is_some() || system.slope_m_s2 != 0.0;
        if !whole_chain && !system.periodic {
            let last = (0..system.bodies()).rev().find(|&i| window.moves(state, i));
            let last = last.unwrap_or(0).max(usize::from(starts_moving));
            window.bodies.end = (last + window.margin + GROUP).min(system.bodies());
        }
        window
    }

    fn moves(&self, state: &State, body: usize) -> bool {
        state.x[body].abs() > self.length_floor || state.v[body].abs() > self.speed_floor
    }

    /// Wakes what the last step may have reached, and lets sleep what relaxed.
    pub fn follow(&mut self, system: &System, state: &mut State) {
        self.wake_ahead(system, state);
        if self.sleeps_behind {
            self.wake_behind(system, state);
            self.until_look -= 1;
            if self.until_look == 0 {
                self.until_look = LOOK_EVERY;
                self.sleep_behind(system, state);
            }
        }
    }

    /// A step moves at most `stages` more bodies: that many must be at rest
    /// at the window's edge.
    fn wake_ahead(&mut self, system: &System, state: &State) {
        let all = system.bodies();
        while self.bodies.end < all
            && (self.bodies.end - self.margin..self.bodies.end).any(|i| self.moves(state, i))
        {
            self.bodies.end = (self.bodies.end + GROUP).min(all);
        }
    }

    /// Neither pressed nor closing, but for rounding.
    fn is_quiet(&self, system: &System, state: &State, contact: usize) -> bool {
        let overlap = state.overlap(system, contact);
        let rate = state.v[contact] - state.v[contact + 1];
        let open = overlap < -self.relaxed_length;
        let relaxed = overlap <= self.relaxed_length && rate.abs() <= self.relaxed_speed;
        (open && rate <= self.relaxed_speed) || relaxed
    }

    fn wake_behind(&mut self, system: &System, state: &mut State) {
        let first = self.bodies.start;
        if first == 0 {
            return;
        }
        let disturbed = (first..first + self.margin).any(|c| !self.is_quiet(system, state, c));
        if disturbed {
            let to = first.saturating_sub(GROUP);
            for i in to..first {
                state.x[i] += state.v[i] * (state.time_s - self.asleep_since_s[i]);
            }
            self.bodies.start = to;
        }
    }

    fn sleep_behind(&mut self, system: &System, state: &State) {
        let first = self.bodies.start;
        let quiet_until = (first..self.bodies.end - 1)
            .find(|&c| !self.is_quiet(system, state, c))
            .unwrap_or(self.bodies.end - 1);
        let to = quiet_until.saturating_sub(self.margin + GROUP);
        if to <= first + GROUP {
            return;
        }
        self.asleep_since_s[first..to].fill(state.time_s);
        self.bodies.start = to;
    }

    /// Brings the positions of sleeping bodies up to date.
    pub fn wake_all(&mut self, state: &mut State) {
        for i in 0..self.bodies.start {
            state.x[i] += state.v[i] * (state.time_s - self.asleep_since_s[i]);
            self.asleep_since_s[i] = state.time_s;
        }
    }
}
