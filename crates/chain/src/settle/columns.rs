//! A chain between shots as columns, and the sweeps over them.

use super::{SlowPhase, State};
use crate::chain::Tension;
use crate::instruction_set::InstructionSet;
use crate::system::{FLUSH, System, TouchColumns};
use fearless_simd::{dispatch, prelude::*};

#[derive(Clone, Debug)]
pub(super) struct Columns {
    pub touch: TouchColumns,
    /// Rest overlap of every contact in m, −∞ where no contact is.
    pub offset: Vec<f64>,
    /// Total force of contact c at c + 1; 0 at both ends.
    pub force: Vec<f64>,
    pub inverse_mass: Vec<f64>,
    /// Deceleration by friction, 0 for what does not move.
    friction: Vec<f64>,
    /// Acceleration that balances the contacts at static equilibrium.
    balance: Vec<f64>,
    /// That and all else which is not a contact.
    pushed: Vec<f64>,
    /// Velocities half a step before the positions.
    pub v: Vec<f64>,
    /// Velocities as laws see them, at the positions' time.
    pub seen: Vec<f64>,
    striker_gone: bool,
    pub set: InstructionSet,
}

impl Columns {
    pub(super) fn new(system: &System, slow: &SlowPhase, state: &State) -> Self {
        let friction = slow.friction_coefficient * system.normal_m_s2.abs();
        let rubs = system.inverse_mass.iter().map(|&w| if w > 0.0 { friction } else { 0.0 });
        let balance = balance(system);
        let mut touch = TouchColumns::new(system.contacts());
        for (contact, largest) in touch.largest.iter_mut().enumerate() {
            *largest = state.overlap_m(system, contact).max(0.0);
        }
        let mut columns = Self {
            touch,
            offset: system.offset_m.to_vec(),
            force: vec![0.0; system.contacts() + 2],
            inverse_mass: system.inverse_mass.to_vec(),
            friction: rubs.collect(),
            pushed: balance.clone(),
            balance,
            v: state.velocity_m_s.clone(),
            seen: state.velocity_m_s.clone(),
            striker_gone: false,
            set: InstructionSet::default(),
        };
        columns.hold_what_does_not_move();
        columns
    }

    fn hold_what_does_not_move(&mut self) {
        for (i, &w) in self.inverse_mass.iter().enumerate() {
            if w == 0.0 {
                (self.v[i], self.seen[i]) = (0.0, 0.0);
            }
        }
    }

    pub(super) fn withdraw(&mut self) {
        self.striker_gone = true;
        self.offset[0] = f64::NEG_INFINITY;
        self.inverse_mass[0] = 0.0;
        (self.friction[0], self.balance[0], self.pushed[0]) = (0.0, 0.0, 0.0);
        self.hold_what_does_not_move();
    }

    pub(super) fn has_striker(&self, system: &System) -> bool {
        system.has_striker && !self.striker_gone
    }

    /// Forces of all contacts at the bodies' places.
    pub(super) fn feel(&mut self, system: &System, state: &mut State) {
        let x = &state.displacement_m;
        let Self { touch, offset, seen, set, .. } = self;
        dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || meet(touch, offset, x, seen)
        ));
        if system.has_memory {
            remember(&mut self.touch);
        }
        let contacts = system.contacts();
        let force = &mut self.force[1..=contacts];
        add_laws(system, self.set, &self.touch, force);
        if !system.bridged.is_empty() {
            add_bridges(system, &self.offset, x, &mut state.bridged, force);
        }
        if self.striker_gone {
            // A law that acts across gaps must not feel it either.
            force[0] = 0.0;
        }
        self.push(system, x);
    }

    /// What acts on bodies beside contacts and friction.
    fn push(&mut self, system: &System, x: &[f64]) {
        let bodies = if system.pendulum_per_s2 > 0.0 { x.len() } else { 2 };
        let pushed = self.pushed.iter_mut().zip(&self.balance).zip(x);
        let gone = usize::from(self.striker_gone);
        for (i, ((pushed, balance), &x)) in pushed.enumerate().take(bodies).skip(gone) {
            *pushed = balance + system.pushed(i, x);
        }
    }

    /// Velocities a step of `kick_s` later; leaves their means, those at the
    /// positions' time, in `mean`.
    pub(super) fn kick(&mut self, kick_s: f64, mean: &mut [f64]) {
        let set = self.set;
        dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || kick(self, kick_s, mean)
        ));
    }

    pub(super) fn drift(&self, step_s: f64, x: &mut [f64]) {
        dispatch!(self.set.level(), simd => simd.vectorize(
            #[inline(always)]
            || drift(x, &self.v, step_s)
        ));
    }

    /// Forces of all laws on contacts as `touch` has them.
    pub(super) fn laws(&self, system: &System, touch: &TouchColumns, force: &mut [f64]) {
        add_laws(system, self.set, touch, force);
    }
}

/// Acceleration of each body by what holds it against its contacts at static
/// equilibrium: push, weight, the stop's support.
fn balance(system: &System) -> Vec<f64> {
    let rest = |body: usize| {
        let left = body.checked_sub(1).map_or(0.0, |c| system.static_force_n[c]);
        let right = system.static_force_n.get(body).copied().unwrap_or(0.0);
        (left - right) * system.inverse_mass[body]
    };
    (0..system.bodies()).map(|body| -rest(body)).collect()
}

fn remember(touch: &mut TouchColumns) {
    for (largest, &overlap) in touch.largest.iter_mut().zip(&touch.overlap) {
        *largest = largest.max(overlap);
    }
}

fn add_laws(system: &System, set: InstructionSet, touch: &TouchColumns, force: &mut [f64]) {
    force.fill(0.0);
    for section in system.sections.iter() {
        let part = section.contacts.clone();
        let terms = [&section.gated[..], &section.ungated[..]];
        touch.add_forces(set, terms, (part.clone(), 0), &mut force[part]);
    }
    if system.tension == Tension::Clipped {
        for force in force {
            *force = force.max(0.0);
        }
    }
}

/// Pulls of liquid bridges, which form where bodies touch.
fn add_bridges(
    system: &System,
    offset: &[f64],
    x: &[f64],
    bridged: &mut [bool],
    force: &mut [f64],
) {
    for (contact, (force, bridged)) in force.iter_mut().zip(bridged).enumerate() {
        let overlap = offset[contact] - (x[contact + 1] - x[contact]);
        *bridged = overlap >= 0.0 || (*bridged && !system.is_beyond_bridge(contact, overlap));
        if *bridged {
            *force += system.pull_n(contact, overlap);
        }
    }
}

/// Overlaps, their roots and rates. Closed ⇔ δ > 0, or δ = 0 and approaching.
#[inline(always)]
fn meet(touch: &mut TouchColumns, offset: &[f64], x: &[f64], v: &[f64]) {
    let n = offset.len();
    let (left, right) = (&x[..n], &x[1..=n]);
    let (before, after) = (&v[..n], &v[1..=n]);
    let (overlap, root) = (&mut touch.overlap[..n], &mut touch.root[..n]);
    let (rate, across) = (&mut touch.rate[..n], &mut touch.across[..n]);
    for c in 0..n {
        let depth = offset[c] - (right[c] - left[c]);
        let closing = before[c] - after[c];
        let deep = depth > FLUSH;
        overlap[c] = if deep { depth } else { 0.0 };
        root[c] = overlap[c].sqrt();
        let closed = deep | ((depth >= 0.0) & (closing > 0.0));
        rate[c] = if closed { closing } else { 0.0 };
        across[c] = closing;
    }
}

/// Newton's second law with friction as a clamped impulse: it takes up to its
/// share of the speed that all other forces would give, and never more. The
/// velocity for the next force pass is extrapolated by half a step, but a body
/// that has just been stopped stays at 0.
#[inline(always)]
fn kick(columns: &mut Columns, kick_s: f64, mean: &mut [f64]) {
    let n = columns.v.len();
    let (left, right) = (&columns.force[..n], &columns.force[1..=n]);
    let (w, pushed) = (&columns.inverse_mass[..n], &columns.pushed[..n]);
    let friction = &columns.friction[..n];
    let (v, seen, mean) = (&mut columns.v[..n], &mut columns.seen[..n], &mut mean[..n]);
    for i in 0..n {
        let free = v[i] + kick_s * ((left[i] - right[i]) * w[i] + pushed[i]);
        let rest = free.abs() - kick_s * friction[i];
        let slides = rest > 0.0;
        let new = if slides { rest.copysign(free) } else { 0.0 };
        let ahead = new + 0.5 * (new - v[i]);
        mean[i] = 0.5 * (new + v[i]);
        seen[i] = if slides { ahead } else { 0.0 };
        v[i] = new;
    }
}

#[inline(always)]
fn drift(x: &mut [f64], v: &[f64], step_s: f64) {
    for (x, v) in x.iter_mut().zip(v) {
        *x += step_s * v;
    }
}
