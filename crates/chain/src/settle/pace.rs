//! How long the next steps are.

use super::columns::Columns;
use crate::system::{FLUSH, System, TouchColumns};
use fearless_simd::{dispatch, prelude::*};
use std::f64::consts::{SQRT_2, TAU};

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
    fraction: f64,
    longest_s: f64,
    /// Squared rate in rad²/s² that springs and threads add.
    held_per_s2: f64,
    /// Contacts as they may be before the next look.
    ahead: TouchColumns,
    /// Forces with damping, without it, and at a slightly smaller overlap.
    damped: Vec<f64>,
    stiff: Vec<f64>,
    soft: Vec<f64>,
}

impl Pace {
    pub(super) fn new(system: &System, fraction: f64, longest_s: f64) -> Self {
        let contacts = || vec![0.0; system.contacts()];
        let spring = system.spring.map_or(0.0, |spring| spring.stiffness_n_m);
        Self {
            fraction,
            longest_s,
            held_per_s2: system.pendulum_per_s2 + spring * system.inverse_mass[1],
            ahead: TouchColumns::new(system.contacts()),
            damped: contacts(),
            stiff: contacts(),
            soft: contacts(),
        }
    }

    /// The next step after one of `step_s`, 0 at the start.
    pub(super) fn step(
        &mut self,
        system: &System,
        columns: &Columns,
        x: &[f64],
        step_s: f64,
    ) -> f64 {
        let most = match step_s > 0.0 {
            true => (2.0 * step_s).min(self.longest_s),
            // Nothing is known yet but the scales of the shot.
            false => self.longest_s.min(self.fraction * system.scales().time_s),
        };
        self.look_ahead(system, columns, x, most);
        let wanted = (self.fraction * TAU / self.quickest(columns)).min(most);
        match wanted < step_s || wanted > WORTHWHILE * step_s {
            true => wanted,
            false => step_s,
        }
    }

    /// Forces of all contacts if they go on closing until the next look, and
    /// faster by what a step of `step_s` adds.
    fn look_ahead(&mut self, system: &System, columns: &Columns, x: &[f64], step_s: f64) {
        let level = columns.set.level();
        let ahead = &mut self.ahead;
        dispatch!(level, simd => simd.vectorize(
            #[inline(always)]
            || close(ahead, columns, x, LOOK_EVERY as f64 * step_s)
        ));
        columns.laws(system, ahead, &mut self.stiff);
        dispatch!(level, simd => simd.vectorize(
            #[inline(always)]
            || soften(ahead)
        ));
        columns.laws(system, ahead, &mut self.soft);
        dispatch!(level, simd => simd.vectorize(
            #[inline(always)]
            || hasten(ahead, columns, &self.stiff, step_s)
        ));
        columns.laws(system, ahead, &mut self.damped);
    }

    /// The quickest rate of the chain in rad/s: √2 times that of the stiffest
    /// contact alone, as in a row of equal ones; or how fast damping acts.
    fn quickest(&mut self, columns: &Columns) -> f64 {
        let set = columns.set;
        dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || rates(self, columns)
        ));
        let largest = |rates: &[f64]| rates.iter().copied().fold(0.0, f64::max);
        let ringing = largest(&self.stiff).max(0.5 * self.held_per_s2);
        (SQRT_2 * ringing.sqrt()).max(largest(&self.damped))
    }
}

/// Overlaps when contacts go on closing for a time.
#[inline(always)]
fn close(ahead: &mut TouchColumns, columns: &Columns, x: &[f64], time_s: f64) {
    let n = columns.offset.len();
    let (offset, left, right) = (&columns.offset[..n], &x[..n], &x[1..=n]);
    let (now, before) = (&columns.touch.across[..n], &columns.touch.largest[..n]);
    let (overlap, root) = (&mut ahead.overlap[..n], &mut ahead.root[..n]);
    let largest = &mut ahead.largest[..n];
    for c in 0..n {
        let closing = if now[c] > 0.0 { now[c] * time_s } else { 0.0 };
        let depth = offset[c] - (right[c] - left[c]) + closing;
        overlap[c] = if depth > FLUSH { depth } else { 0.0 };
        root[c] = overlap[c].sqrt();
        largest[c] = before[c].max(overlap[c]);
    }
    ahead.rate.fill(0.0);
    ahead.across.fill(0.0);
}

#[inline(always)]
fn soften(ahead: &mut TouchColumns) {
    for (overlap, root) in ahead.overlap.iter_mut().zip(&mut ahead.root) {
        *overlap *= 1.0 - SOFTER;
        *root = overlap.sqrt();
    }
}

/// Rates as they are now and faster by what a step adds: damping that acts on
/// them may outgrow the contacts' stiffness within it.
#[inline(always)]
fn hasten(ahead: &mut TouchColumns, columns: &Columns, stiff: &[f64], step_s: f64) {
    let n = stiff.len();
    let (left, right) = (&columns.inverse_mass[..n], &columns.inverse_mass[1..=n]);
    let (now, overlap) = (&columns.touch.across[..n], &ahead.overlap[..n]);
    let (rate, across) = (&mut ahead.rate[..n], &mut ahead.across[..n]);
    for c in 0..n {
        let faster = step_s * stiff[c].abs() * (left[c] + right[c]);
        across[c] = (now[c].abs() + faster).max(SLOW_RATE);
        rate[c] = if overlap[c] > 0.0 { across[c] } else { 0.0 };
    }
}

/// Turns forces into squared rates of ringing, left in `stiff`, and rates of
/// damping, left in `damped`.
#[inline(always)]
fn rates(pace: &mut Pace, columns: &Columns) {
    let n = pace.stiff.len();
    let (left, right) = (&columns.inverse_mass[..n], &columns.inverse_mass[1..=n]);
    let (rate, softened) = (&pace.ahead.across[..n], &pace.ahead.overlap[..n]);
    let (soft, stiff) = (&pace.soft[..n], &mut pace.stiff[..n]);
    let damped = &mut pace.damped[..n];
    for c in 0..n {
        let lightness = left[c] + right[c];
        let change = softened[c] * (SOFTER / (1.0 - SOFTER));
        let slope = (stiff[c] - soft[c]) / change.max(f64::MIN_POSITIVE);
        let damping = (damped[c] - soft[c]).abs() / rate[c];
        stiff[c] = slope * lightness;
        damped[c] = STEEPEST * damping * lightness;
    }
}
