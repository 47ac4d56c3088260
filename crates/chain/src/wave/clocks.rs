//! The loop's part in two clocks: which bodies a step moves, and long steps.

use super::Control;
use super::forces::Gates;
use super::run::Wave;
use super::step::worse_than;
use super::zones::LongStep;
use std::ops::Range;

impl Wave<'_> {
    /// Bodies that the present step moves, and those at its seams.
    pub(super) fn moving(&self) -> Range<usize> {
        match self.slow.active {
            true => self.slow.quick_with_seams(&self.window.bodies),
            false => self.window.bodies.clone(),
        }
    }

    pub(super) fn owned(&self) -> Range<usize> {
        let moving = self.moving();
        let start = moving.start + usize::from(self.slow.holds(moving.start));
        let end = moving.end - usize::from(self.slow.holds(moving.end - 1));
        start..end
    }

    /// Puts bodies at the seams where the long step has them.
    pub(super) fn hold_seams(&mut self, time_s: f64) {
        if self.slow.active {
            let moving = self.moving();
            for body in [moving.start, moving.end - 1] {
                if self.slow.holds(body) {
                    (self.x[body], self.v[body]) =
                        self.slow.at(self.table, &self.state, body, time_s);
                }
            }
        }
    }

    pub(super) fn usual_gates(&self) -> Gates {
        match self.control {
            Control::Adaptive { .. } => Gates::Frozen,
            Control::Fixed { .. } => Gates::Instant,
        }
    }

    /// Ends a long step that short ones have caught up with.
    pub(super) fn finish_slow(&mut self) -> bool {
        let left = self.slow.end_s() - self.state.time_s;
        if !self.slow.active || left > 1e-12 * self.slow.step_s {
            return false;
        }
        self.slow.finish(self.system, &mut self.state);
        if let Some(meter) = &mut self.meter {
            meter.finish_slow(self.slow.step_s, self.table.end().0);
        }
        true
    }

    /// Tries a long step for all but the bodies that need short ones. With a
    /// meter the seams must be known before, so a second try may be needed.
    pub(super) fn begin_slow(&mut self) -> bool {
        let window = self.window.bodies.clone();
        let reaches = (self.system.bodies(), self.window.untouched());
        for _ in 0..6 {
            let step_s = self.slow.proposed_s(self.proposed_s).min(self.longest());
            self.compute_slow(step_s);
            let Some(quick) = self.needs_short_steps(step_s) else {
                if self.slow.lengthen() {
                    continue;
                }
                break;
            };
            if self.slow.suits(&quick, &window) {
                self.slow.begin((self.state.time_s, step_s), window);
                return true;
            }
            match LongStep::around(quick, &window, reaches) {
                Some(quick) => self.slow.quick = quick,
                None if self.slow.shorten() => {}
                None => break,
            }
        }
        self.slow.give_up();
        self.first_accelerations();
        false
    }

    pub(super) fn needs_short_steps(&self, step_s: f64) -> Option<Range<usize>> {
        let (Some(weights), Control::Adaptive { tolerance }) = (&self.table.error, self.control)
        else {
            return None;
        };
        let speed = self.speed_scale();
        let scales = (speed, speed * self.system.scales().time_s);
        let limit = self.limits.slow_tolerance.unwrap_or(0.0).max(tolerance);
        let bodies = self.window.bodies.clone();
        worse_than(limit, bodies, step_s, weights, &self.slow.a[..self.table.stages()], scales)
    }

    /// Computes a long step of all bodies into the columns of `slow`.
    pub(super) fn compute_slow(&mut self, step_s: f64) {
        self.swap_slow(Gates::Instant);
        self.first_accelerations();
        self.stages(step_s);
        self.swap_slow(self.usual_gates());
    }

    pub(super) fn swap_slow(&mut self, gates: Gates) {
        self.gates = gates;
        std::mem::swap(&mut self.a, &mut self.slow.a);
        std::mem::swap(&mut self.x, &mut self.slow.x);
        std::mem::swap(&mut self.v, &mut self.slow.v);
        if let Some(meter) = &mut self.meter {
            meter.swap_slow();
        }
    }
}
