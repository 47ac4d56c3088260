//! How long the next steps are.

use super::columns::{Columns, Touch};
use crate::system::System;
use std::f64::consts::{SQRT_2, TAU};

/// Steps between two looks at the contacts.
pub(super) const LOOK_EVERY: u64 = 8;

/// A step grows only if it may grow by this much: steps that change all the
/// time would cost a leapfrog its long-time accuracy.
const WORTHWHILE: f64 = 1.25;

/// Relative change of an overlap for the slope of the elastic force there.
const SOFTER: f64 = 0.01;

/// Rates in m/s below this do not show how much a law damps.
const SLOW_RATE: f64 = 1e-6;

/// Laws up to the third power of the rate have slopes up to this times
/// their force over the rate.
const STEEPEST: f64 = 3.0;

/// Chooses steps from the stiffness of the contacts.
#[derive(Clone, Debug)]
pub(super) struct Pace {
    /// Fraction of the shortest period.
    fraction: f64,
    longest_s: f64,
    /// Rate in rad/s² that springs and threads add.
    held_per_s2: f64,
    ahead: Touch,
    stiff: Vec<f64>,
    soft: Vec<f64>,
    damped: Vec<f64>,
}

impl Pace {
    pub fn new(system: &System, fraction: f64, longest_s: f64) -> Self {
        let contacts = || vec![0.0; system.contacts()];
        let spring = system.spring.map_or(0.0, |spring| spring.stiffness_n_m);
        Self {
            fraction,
            longest_s,
            held_per_s2: system.pendulum_per_s2 + spring * system.inverse_mass[1],
            ahead: Touch::new(system.contacts()),
            stiff: contacts(),
            soft: contacts(),
            damped: contacts(),
        }
    }

    /// The next step after one of `step_s`, 0 at the start.
    pub fn step(&mut self, system: &System, columns: &Columns, x: &[f64], step_s: f64) -> f64 {
        let most = if step_s > 0.0 {
            (2.0 * step_s).min(self.longest_s)
        } else {
            self.first(system)
        };
        self.look_ahead(columns, x, LOOK_EVERY as f64 * most);
        columns.laws(system, &self.ahead, &mut self.damped);
        self.ahead.rate.fill(0.0);
        self.ahead.across.fill(0.0);
        columns.laws(system, &self.ahead, &mut self.stiff);
        self.soften();
        columns.laws(system, &self.ahead, &mut self.soft);
        let wanted = (self.fraction * TAU / self.quickest(columns)).min(most);
        if wanted < step_s || wanted > WORTHWHILE * step_s {
            wanted
        } else {
            step_s
        }
    }

    /// The first step: nothing is known but the scales of the shot.
    fn first(&self, system: &System) -> f64 {
        self.longest_s.min(self.fraction * system.scales().time_s)
    }

    /// Overlaps as they will be when contacts go on closing for a time.
    fn look_ahead(&mut self, columns: &Columns, x: &[f64], time_s: f64) {
        let n = columns.offset.len();
        let (left, right) = (&x[..n], &x[1..=n]);
        let ahead = &mut self.ahead;
        for c in 0..n {
            let rate = columns.touch.across[c];
            let depth = columns.offset[c] - (right[c] - left[c]) + rate.max(0.0) * time_s;
            ahead.overlap[c] = depth.max(0.0);
            ahead.root[c] = ahead.overlap[c].sqrt();
            ahead.largest[c] = columns.touch.largest[c].max(ahead.overlap[c]);
            ahead.rate[c] = if depth > 0.0 { rate } else { 0.0 };
            ahead.across[c] = rate;
        }
    }

    fn soften(&mut self) {
        for (overlap, root) in self.ahead.overlap.iter_mut().zip(&mut self.ahead.root) {
            *overlap *= 1.0 - SOFTER;
            *root = overlap.sqrt();
        }
    }

    /// The quickest rate of the chain in rad/s: √2 times that of the stiffest
    /// contact alone, as in a row of equal ones; or how fast damping acts.
    fn quickest(&self, columns: &Columns) -> f64 {
        let (mut ringing, mut decay) = (0.5 * self.held_per_s2, 0.0_f64);
        for c in 0..self.stiff.len() {
            let lightness = columns.inverse_mass[c] + columns.inverse_mass[c + 1];
            // `soften` has left the overlap at 1 − SOFTER.
            let change = self.ahead.overlap[c] * (SOFTER / (1.0 - SOFTER));
            let slope = (self.stiff[c] - self.soft[c]) / change.max(f64::MIN_POSITIVE);
            let rate = columns.touch.across[c].abs().max(SLOW_RATE);
            let damping = (self.damped[c] - self.stiff[c]).abs() / rate;
            ringing = ringing.max(slope * lightness);
            decay = decay.max(STEEPEST * damping * lightness);
        }
        (SQRT_2 * ringing.sqrt()).max(decay)
    }
}
