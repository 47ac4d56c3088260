//! A finished step as a continuous function of time.

use super::energy::Budget;
use super::gate::bracketed_root;
use super::meter::Meter;
use super::state::{ContactMode, WaveState};
use super::step::MOST_STAGES;
use super::table::{DEGREE, Table};
use super::zones::LongStep;
use crate::chain::Tension;
use crate::laws::{Closed, ContactState};
use crate::sensor::Sensor;
use crate::system::{FLUSH, System};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;

/// One step of a shot. `θ` runs from 0 to 1 within it; forces are those of
/// the contacts' modes during the step, so that at a change of mode the end
/// of one piece and the start of the next are the two one-sided limits.
#[derive(Clone, Debug)]
pub struct Piece<'a> {
    pub(super) system: &'a System,
    pub(super) table: &'a Table,
    pub(super) state: &'a WaveState,
    pub(super) step_s: f64,
    /// Positions and velocities at the end of the step.
    pub(super) end: (&'a [f64], &'a [f64]),
    pub(super) accelerations: &'a [Vec<f64>],
    pub(super) window: Range<usize>,
    /// Since when bodies outside the window fly or rest.
    pub(super) asleep_since_s: &'a [f64],
    pub(super) frozen: bool,
    /// Tolerance of a step, 0 where steps are fixed.
    pub(super) tolerance: f64,
    /// The long step of slow bodies, if one is under way.
    pub(super) slow: Option<&'a LongStep>,
    pub(super) meter: Option<&'a Meter>,
    /// The `θ` that was asked for last, and each stage's weights there.
    pub(super) weights: RefCell<(f64, StageWeights)>,
    /// Bends of bodies that were asked for within the step; `None` where the dense output has none.
    pub(super) bends: Option<RefCell<BTreeMap<usize, [f64; 2]>>>,
}

/// Weights of the stages' accelerations for velocity and position.
pub(super) type StageWeights = [[f64; 2]; MOST_STAGES];

/// A contact touches or parts within this share of a step if its overlap is less than
/// this share of what its rate makes in a step.
const NEAR_TOUCH: f64 = 0.05;

/// In steps shorter than this many contact times, rounding decides on a difference quotient along the
/// motion: it moved a peak by 7e-8 contact times.
const SHORT: f64 = 3e-2;

/// Where around the middle of a step forces are looked at for its dense output, in steps.
const BEND: f64 = 0.125;

impl Piece<'_> {
    /// Time at which the step starts, in s.
    pub fn start_s(&self) -> f64 {
        self.state.time_s
    }

    /// Length of the step in s.
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// Time at `theta`, in s.
    pub fn time_s(&self, theta: f64) -> f64 {
        self.state.time_s + theta * self.step_s
    }

    /// The chain.
    pub fn system(&self) -> &System {
        self.system
    }

    /// Energy terms at the start of the step, when a budget is kept.
    pub(crate) fn budget(&self) -> Option<Budget> {
        let meter = self.meter?;
        let asleep = |i: &usize| !self.is_awake(*i) && self.state.v[*i] != 0.0;
        if self.slow.is_none() && !(0..self.state.x.len()).any(|i| asleep(&i)) {
            return Some(meter.budget(self.system, self.state, None));
        }
        let (mut state, time_s) = (self.state.clone(), self.state.time_s);
        for i in (0..state.x.len()).filter(asleep) {
            state.x[i] = self.body(i, 0.0).0;
        }
        let pending = self.slow.map(|slow| {
            slow.bring_to(self.system, self.table, &mut state, time_s);
            (slow.step_s, slow.weights(self.table, time_s))
        });
        Some(meter.budget(self.system, &state, pending.as_ref()))
    }

    /// Whether a body is in the part of the chain that moves.
    pub(crate) fn is_awake(&self, body: usize) -> bool {
        self.window.contains(&body)
    }

    /// Whether a contact is open during the step (with fixed steps: at its start).
    pub(crate) fn is_open(&self, contact: usize) -> bool {
        match self.is_slow(contact) {
            true => self.overlap(contact, 0.0).0 < 0.0,
            false => self.state.mode[contact] == ContactMode::Open,
        }
    }

    /// Whether the step is of a given length, and does not end where contacts change.
    pub(crate) fn has_given_length(&self) -> bool {
        self.tolerance == 0.0
    }

    /// Tolerance of a step where forces are cut, 0 elsewhere.
    pub(crate) fn cut_tolerance(&self) -> f64 {
        match self.system.tension {
            Tension::Clipped => self.tolerance,
            Tension::Allowed => 0.0,
        }
    }

    /// Whether a contact that a sensor sees has just closed, or is about to open, at `theta`:
    /// the slopes of some laws are infinite there.
    pub(crate) fn is_near_touch(&self, sensor: Sensor, theta: f64) -> bool {
        self.closed_contacts(sensor).into_iter().flatten().any(|contact| {
            let (overlap, rate) = self.overlap(contact, theta);
            overlap.abs() < NEAR_TOUCH * rate.abs() * self.step_s
        })
    }

    /// Closed contacts whose forces a sensor shows.
    fn closed_contacts(&self, sensor: Sensor) -> [Option<usize>; 3] {
        let wall = self.system.contacts() - 1;
        let contacts = match sensor {
            Sensor::Bead(n) => [Some(self.before(n)), Some(n), None],
            Sensor::Contact(c) => [Some(c), None, None],
            Sensor::BeadPlusWall(n) => [Some(self.before(n)), Some(n), Some(wall)],
            Sensor::Position(_) | Sensor::Velocity(_) => [None; 3],
        };
        contacts.map(|contact| contact.filter(|&contact| !self.is_open(contact)))
    }

    /// Where in the step each contact that a sensor shows begins to be pressed, at its touch or
    /// again: some laws' forces rise there with an infinite slope, in overlap or in rate.
    pub(crate) fn sharp_rises(
        &self,
        sensor: Sensor,
        reversals: [Option<(f64, bool)>; 3],
    ) -> [Option<f64>; 3] {
        let contacts = self.closed_contacts(sensor);
        std::array::from_fn(|i| {
            let (overlap, rate) = self.overlap(contacts[i]?, 0.0);
            match rate > 0.0 && overlap < NEAR_TOUCH * rate * self.step_s {
                true => Some(0.0),
                false => reversals[i].filter(|(_, released)| !released).map(|(at, _)| at),
            }
        })
    }

    /// Whether a contact that a sensor shows opens at the end of the step, where forces that pulled
    /// rise to 0 with an infinite slope.
    pub(crate) fn parts_at_end(&self, sensor: Sensor) -> bool {
        self.closed_contacts(sensor).into_iter().flatten().any(|contact| {
            let (overlap, rate) = self.overlap(contact, 1.0);
            rate < 0.0 && overlap < -NEAR_TOUCH * rate * self.step_s
        })
    }

    /// Where in the step the rate of each contact that a sensor shows changes sign, and whether it is
    /// released from then on.
    pub(crate) fn reversals(&self, sensor: Sensor) -> [Option<(f64, bool)>; 3] {
        self.closed_contacts(sensor).map(|contact| {
            let contact = contact?;
            let rate = |theta: f64| self.overlap(contact, theta).1;
            let released = rate(0.0) > 0.0;
            let turns = released != (rate(1.0) > 0.0);
            let rising = |theta: f64| if released { -rate(theta) } else { rate(theta) };
            turns.then(|| (bracketed_root(rising, 0.0, 1.0, 1e-13), released))
        })
    }

    /// Whether a contact is on the long step.
    fn is_slow(&self, contact: usize) -> bool {
        self.slow.is_some_and(|slow| slow.holds_contact(contact))
    }

    /// Displacement in m and velocity in m/s of a body.
    pub fn body(&self, body: usize, theta: f64) -> (f64, f64) {
        let time = self.time_s(theta);
        if body == 0
            && let Some(motion) = &self.system.motion
        {
            return motion.at(time);
        }
        if let Some(slow) = self.slow.filter(|slow| slow.holds(body)) {
            return slow.at(self.table, self.state, body, time);
        }
        let (x, v) = (self.state.x[body], self.state.v[body]);
        if !self.is_awake(body) {
            return (x + v * (time - self.asleep_since_s[body]), v);
        }
        if theta == 0.0 {
            return (x, v);
        }
        if theta == 1.0 {
            return (self.end.0[body], self.end.1[body]);
        }
        self.interpolated(body, theta)
    }

    /// Displacement and velocity of an awake body within the step.
    fn interpolated(&self, body: usize, theta: f64) -> (f64, f64) {
        let (x, v) = (self.state.x[body], self.state.v[body]);
        let h = self.step_s;
        let [mut sped, mut moved] = self.bent(body, theta);
        let mut weights = self.weights.borrow_mut();
        let (at, weights) = &mut *weights;
        if *at != theta {
            let rows = self.table.dense_velocity.iter().zip(&self.table.dense_position);
            for (weights, (velocity, position)) in weights.iter_mut().zip(rows) {
                *weights = [polynomial(velocity, theta), polynomial(position, theta)];
            }
            *at = theta;
        }
        for (a, [faster, further]) in self.accelerations.iter().zip(weights) {
            sped += *faster * a[body];
            moved += *further * a[body];
        }
        (x + h * theta * v + h * h * moved, v + h * sped)
    }

    /// What the forces within the step add to the quintic between its ends: h² q(θ) (α + β u) with
    /// u = θ − ½, q = (¼ − u²)³, which leaves position, velocity and acceleration of both ends as they are,
    /// so that accelerations at u = ±[`BEND`] are those of the forces there. Its velocity over h, and its
    /// position over h².
    fn bent(&self, body: usize, theta: f64) -> [f64; 2] {
        let Some(bends) = &self.bends else {
            return [0.0; 2];
        };
        let known = bends.borrow().get(&body).copied();
        let [even, odd] = known.unwrap_or_else(|| {
            let found = self.bend(body);
            bends.borrow_mut().insert(body, found);
            found
        });
        let u = theta - 0.5;
        let w = 0.25 - u * u;
        let by_even = even + odd * u;
        [odd * w.powi(3) - 6.0 * by_even * u * w * w, by_even * w.powi(3)]
    }

    /// α and β of a body.
    fn bend(&self, body: usize) -> [f64; 2] {
        let quintic = Piece {
            window: self.window.clone(),
            weights: RefCell::new((f64::NAN, StageWeights::default())),
            bends: None,
            ..*self
        };
        let missing = |theta: f64| {
            let slopes = self.table.dense_velocity.iter().map(|row| slope(row, theta));
            let of_quintic: f64 =
                slopes.zip(self.accelerations).map(|(slope, a)| slope * a[body]).sum();
            quintic.acceleration(body, theta) - of_quintic
        };
        let (before, after) = (missing(0.5 - BEND), missing(0.5 + BEND));
        let w = 0.25 - BEND * BEND;
        let even = 24.0 * BEND * BEND * w - 6.0 * w * w;
        let odd = BEND * (24.0 * BEND * BEND * w - 18.0 * w * w);
        [0.5 * (before + after) / even, 0.5 * (after - before) / odd]
    }

    /// Overlap in m (negative across a gap) and overlap rate in m/s of a contact.
    pub fn overlap(&self, contact: usize, theta: f64) -> (f64, f64) {
        let (left, before) = self.body(contact, theta);
        let (right, after) = self.body(contact + 1, theta);
        (self.system.offset_m[contact] - (right - left), before - after)
    }

    /// Dynamic force of a contact in N: its force less the static one.
    pub(crate) fn force(&self, contact: usize, theta: f64) -> f64 {
        self.force_at(contact, theta, self.overlap(contact, theta))
            - self.system.static_force_n[contact]
    }

    /// Force before any cut of a contact taken as closed, in N.
    pub(super) fn closed_force(&self, contact: usize, theta: f64) -> f64 {
        self.uncut_force(contact, theta, self.overlap(contact, theta))
    }

    fn uncut_force(&self, contact: usize, theta: f64, at: (f64, f64)) -> f64 {
        let of_laws = self.system.unclipped_force(contact, self.closed(contact, at));
        if self.state.states.is_empty() {
            return of_laws;
        }
        of_laws + self.state_force(contact, theta, at)
    }

    /// Force in N of a contact's state, if it has one, at an overlap in m and a rate in m/s.
    fn state_force(&self, contact: usize, theta: f64, at: (f64, f64)) -> f64 {
        let force = |state: &dyn ContactState, own, closed| state.force_and_rates(own, closed).0;
        self.of_state(contact, theta, at, force).unwrap_or(0.0)
    }

    /// What `of` says of a contact's state and its numbers.
    fn of_state(
        &self,
        contact: usize,
        theta: f64,
        at: (f64, f64),
        of: impl Fn(&dyn ContactState, [f64; 4], Closed) -> f64,
    ) -> Option<f64> {
        let weights = self.table.dense_velocity.iter().map(|row| polynomial(row, theta));
        self.state.states.seen(contact, (self.step_s, weights), at, of)
    }

    /// Below 0 where the state of a contact has changed its behaviour since the step's start.
    pub(super) fn until_change(&self, contact: usize, theta: f64) -> Option<f64> {
        let until =
            |state: &dyn ContactState, own: [f64; 4], closed| state.until_change(own, closed);
        self.of_state(contact, theta, self.overlap(contact, theta), until)
    }

    fn closed(&self, contact: usize, (overlap, rate): (f64, f64)) -> Closed {
        let overlap = if overlap > FLUSH { overlap } else { 0.0 };
        let largest = self.state.largest[contact].max(overlap);
        Closed { overlap, root: overlap.sqrt(), rate, largest }
    }

    /// Total force in N at an overlap and a rate under this step's mode.
    fn force_at(&self, contact: usize, theta: f64, (overlap, rate): (f64, f64)) -> f64 {
        let closed = self.closed(contact, (overlap, rate));
        let frozen = self.frozen && !self.is_slow(contact);
        let mode = match frozen {
            true => self.state.mode[contact],
            false if overlap > FLUSH || (overlap >= 0.0 && rate > 0.0) => ContactMode::Closed,
            false => ContactMode::Open,
        };
        let force = match mode {
            ContactMode::Closed => self.uncut_force(contact, theta, (overlap, rate)),
            ContactMode::Open if self.state.states.acts_across(contact) => {
                let of_laws = self.system.ungated_force(contact, closed);
                of_laws + self.state_force(contact, theta, (overlap, rate))
            }
            ContactMode::Open => self.system.ungated_force(contact, closed),
            ContactMode::Cut => 0.0,
        };
        let smooth = frozen && mode == ContactMode::Closed;
        let force = match self.system.tension {
            Tension::Clipped if !smooth => force.max(0.0),
            _ => force,
        };
        match self.state.is_bridged(contact) {
            true => force + self.system.pull_n(contact, overlap),
            false => force,
        }
    }

    /// Acceleration of a body in m/s², from the forces at that time rather
    /// than from a slope of the dense output, which would lose an order.
    fn acceleration(&self, body: usize, theta: f64) -> f64 {
        let (system, last) = (self.system, self.system.bodies() - 1);
        if body == 0
            && let Some(motion) = &system.motion
        {
            return motion.acceleration_m_s2(self.time_s(theta), self.time_s(0.5));
        }
        if system.periodic && body == last {
            return self.acceleration(1, theta);
        }
        let side = |contact: Option<usize>| {
            contact.filter(|&c| c < last).map_or(0.0, |c| self.force(c, theta))
        };
        let before =
            if system.periodic && body == 1 { Some(last - 1) } else { body.checked_sub(1) };
        let a = (side(before) - side(Some(body))) * system.inverse_mass[body];
        a + system.pushed(body, self.body(body, theta).0)
    }

    /// Whether a contact's force is the sum of its laws on either side of an overlap.
    fn is_smooth(&self, contact: usize, overlap: f64) -> bool {
        let closed = self.state.mode[contact] == ContactMode::Closed && overlap > FLUSH;
        let remembers = self.system.has_memory || self.system.has_states;
        closed && self.frozen && !self.is_slow(contact) && !remembers
    }

    /// Rate of change of a contact's force in N/s, by a central difference
    /// along the motion whose step balances rounding and curvature, unless the step is short.
    pub(crate) fn force_rate(&self, contact: usize, theta: f64) -> f64 {
        let (overlap, rate) = self.overlap(contact, theta);
        let change = self.acceleration(contact, theta) - self.acceleration(contact + 1, theta);
        if self.step_s < SHORT * self.system.scales().time_s && self.is_smooth(contact, overlap) {
            return self.system.force_rate(contact, (overlap, rate), change);
        }
        // Steps of states are short: rounding would decide.
        let part = if self.state.states.is_empty() { 1e-4 } else { 1e-2 };
        let step = part * self.step_s;
        let after = (overlap + rate * step, rate + change * step);
        let before = (overlap - rate * step, rate - change * step);
        let rise = self.force_at(contact, theta + part, after)
            - self.force_at(contact, theta - part, before);
        rise / (2.0 * step)
    }

    /// Dynamic force of a contact in N, cut where it may not pull: a step that ends where a contact
    /// opens passes, shortly before, where its force is cut.
    fn seen_force(&self, contact: usize, theta: f64) -> f64 {
        let force = self.force(contact, theta);
        match self.system.tension {
            Tension::Clipped => force.max(self.least_force(contact, theta)),
            Tension::Allowed => force,
        }
    }

    /// Dynamic force in N of a contact whose laws are cut.
    fn least_force(&self, contact: usize, theta: f64) -> f64 {
        let pull = match self.state.is_bridged(contact) {
            true => self.system.pull_n(contact, self.overlap(contact, theta).0),
            false => 0.0,
        };
        pull - self.system.static_force_n[contact]
    }

    fn seen_force_rate(&self, contact: usize, theta: f64) -> f64 {
        let least = || self.least_force(contact, theta);
        match self.system.tension {
            Tension::Clipped if self.force(contact, theta) < least() => 0.0,
            _ => self.force_rate(contact, theta),
        }
    }

    /// A sensor's signal.
    pub fn signal(&self, sensor: Sensor, theta: f64) -> f64 {
        match sensor {
            Sensor::Bead(n) => {
                0.5 * (self.seen_force(self.before(n), theta) + self.seen_force(n, theta))
            }
            Sensor::Contact(c) => self.seen_force(c, theta),
            Sensor::Position(i) => self.body(i, theta).0,
            Sensor::Velocity(i) => self.body(i, theta).1,
            Sensor::BeadPlusWall(n) => {
                self.signal(Sensor::Bead(n), theta)
                    + self.seen_force(self.system.contacts() - 1, theta)
            }
        }
    }

    /// Rate of change of a sensor's signal, per s.
    pub(crate) fn signal_rate(&self, sensor: Sensor, theta: f64) -> f64 {
        match sensor {
            Sensor::Bead(n) => {
                0.5 * (self.seen_force_rate(self.before(n), theta) + self.seen_force_rate(n, theta))
            }
            Sensor::Contact(c) => self.seen_force_rate(c, theta),
            Sensor::Position(i) => self.body(i, theta).1,
            Sensor::Velocity(i) => self.acceleration(i, theta),
            Sensor::BeadPlusWall(n) => {
                self.signal_rate(Sensor::Bead(n), theta)
                    + self.seen_force_rate(self.system.contacts() - 1, theta)
            }
        }
    }

    /// The contact on the striker's side of a bead.
    fn before(&self, bead: usize) -> usize {
        if bead == 1 && self.system.periodic {
            self.system.contacts() - 1
        } else {
            bead.saturating_sub(1)
        }
    }

    /// Whether anything a sensor sees is in the part of the chain that moves;
    /// no, if the chain has no such place.
    pub(crate) fn sees(&self, sensor: Sensor) -> bool {
        let system = self.system;
        let bead = |n: usize| {
            (1..=system.beads()).contains(&n)
                && [self.before(n), n, n + 1].into_iter().any(|i| self.is_awake(i))
        };
        match sensor {
            Sensor::Bead(n) => bead(n),
            Sensor::Contact(c) => {
                system.has_contact(c) && (self.is_awake(c) || self.is_awake(c + 1))
            }
            Sensor::Position(i) | Sensor::Velocity(i) => i < system.bodies(),
            Sensor::BeadPlusWall(n) => bead(n) || self.is_awake(system.bodies() - 1),
        }
    }
}

/// Slope of a [`polynomial`].
fn slope(coefficients: &[f64; DEGREE], theta: f64) -> f64 {
    let powers = (1..DEGREE + 1).zip(coefficients).rev();
    powers.fold(0.0, |sum, (power, c)| theta * sum + power as f64 * c)
}

pub(super) fn polynomial(coefficients: &[f64; DEGREE], theta: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| theta * (sum + c))
}
