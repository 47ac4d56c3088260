//! The equations of motion as a careful user writes them for a general
//! integrator: no allocation, no branch that stops vectorisation, blocks of
//! contacts at rest or open skipped, nothing denormal.

use crate::case::{CONTACTS, Shot};

/// Where velocities start in the state: overlaps first, one cell of padding.
pub const VELOCITY: usize = CONTACTS + 1;
/// Overlaps, padding, velocities of striker and beads, and the wall's velocity 0.
pub const STATE: usize = 2 * VELOCITY;
/// A state: overlap and velocity of everything.
pub type State = [f64; STATE];

/// Overlaps below this are none: far below what is printed, far above denormal.
pub const FLUSH: f64 = 1e-60;

/// Contacts looked at together; a block without a closed contact is skipped.
const BLOCK: usize = 8;

/// The striker moves at speed 1 and touches.
pub fn start() -> State {
    let mut state = [0.0; STATE];
    state[VELOCITY] = 1.0;
    state
}

/// Force of one contact; the gate is closed at overlap 0 while approaching.
#[inline(always)]
pub fn force<const TERMS: u8>((k, a, b): (f64, f64, f64), overlap: f64, rate: f64) -> f64 {
    let pressed = overlap > FLUSH;
    let pressing = if pressed { overlap } else { 0.0 };
    let root = pressing.sqrt();
    match TERMS {
        1 => k * pressing * root,
        2 => root * (k * pressing + a * rate),
        _ => {
            let touching = pressed | ((overlap >= 0.0) & (rate > FLUSH));
            let gated = if touching { rate } else { 0.0 };
            root * (k * pressing + a * rate) + b * gated * gated * gated
        }
    }
}

/// dy/dt of a state. `TERMS` is 1 for Hertz, 2 with the viscoelastic, 3 with
/// the cubic term.
#[inline]
pub fn derivative<const TERMS: u8>(shot: &Shot, y: &State, dydt: &mut State) {
    let mut forces = [0.0; CONTACTS + 1];
    for c in 0..CONTACTS {
        dydt[c] = y[VELOCITY + c] - y[VELOCITY + c + 1];
    }
    for first in (0..WHOLE).step_by(BLOCK) {
        block::<TERMS>(shot, y, dydt, &mut forces, first);
    }
    for c in WHOLE..CONTACTS {
        forces[c + 1] = force::<TERMS>(shot.law(c), y[c], dydt[c]);
    }
    for c in 0..CONTACTS {
        dydt[VELOCITY + c] = forces[c] - forces[c + 1];
    }
    dydt[CONTACTS] = 0.0;
    dydt[STATE - 1] = 0.0;
}

/// Contacts in whole blocks.
const WHOLE: usize = CONTACTS - CONTACTS % BLOCK;

/// Forces of one block, all at once, unless nothing touches there.
#[inline(always)]
fn block<const TERMS: u8>(
    shot: &Shot,
    y: &State,
    rates: &State,
    forces: &mut [f64; CONTACTS + 1],
    first: usize,
) {
    let (mut overlap, mut rate) = ([0.0; BLOCK], [0.0; BLOCK]);
    overlap.copy_from_slice(&y[first..first + BLOCK]);
    rate.copy_from_slice(&rates[first..first + BLOCK]);
    let mut touching = 0_u8;
    for j in 0..BLOCK {
        touching |= u8::from((overlap[j] > FLUSH) | ((overlap[j] >= 0.0) & (rate[j] > FLUSH)));
    }
    if touching != 0 {
        for j in 0..BLOCK {
            forces[first + j + 1] = force::<TERMS>(shot.law(first + j), overlap[j], rate[j]);
        }
    }
}

/// Signal of a sensor and its rate: contacts `last - count + 1 ..= last`, their mean.
#[inline]
pub fn signal(shot: &Shot, y: &State, sensor: Sensor) -> (f64, f64) {
    let (first, last) = sensor.contacts();
    let (mut value, mut rate) = (0.0, 0.0);
    for c in first..=last {
        let (f, slope) = force_and_rate(shot, y, c);
        value += f;
        rate += slope;
    }
    let count = (last - first + 1) as f64;
    (value / count, rate / count)
}

/// What is watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensor {
    /// The sensor bead: mean of the forces on its two sides.
    Bead,
    /// The wall contact.
    Wall,
}

impl Sensor {
    /// First and last contact.
    pub fn contacts(self) -> (usize, usize) {
        match self {
            Self::Bead => (crate::case::SENSOR - 1, crate::case::SENSOR),
            Self::Wall => (CONTACTS - 1, CONTACTS - 1),
        }
    }

    /// Whether it feels anything at all.
    #[inline]
    pub fn feels(self, y: &State) -> bool {
        let (first, last) = self.contacts();
        (first..=last).any(|c| y[c] > FLUSH)
    }
}

fn contact_force(shot: &Shot, y: &State, c: usize) -> f64 {
    force::<3>(shot.law(c), y[c], y[VELOCITY + c] - y[VELOCITY + c + 1])
}

fn acceleration(shot: &Shot, y: &State, body: usize) -> f64 {
    let ahead = if body < CONTACTS {
        contact_force(shot, y, body)
    } else {
        return 0.0;
    };
    let behind = if body > 0 {
        contact_force(shot, y, body - 1)
    } else {
        0.0
    };
    behind - ahead
}

/// Force of a contact and its rate by the chain rule.
fn force_and_rate(shot: &Shot, y: &State, c: usize) -> (f64, f64) {
    let (overlap, rate) = (y[c], y[VELOCITY + c] - y[VELOCITY + c + 1]);
    if overlap <= FLUSH {
        return (force::<3>(shot.law(c), overlap, rate), 0.0);
    }
    let rate_dot = acceleration(shot, y, c) - acceleration(shot, y, c + 1);
    let root = overlap.sqrt();
    let (k, a, b) = shot.law(c);
    let slope = 1.5 * k * root * rate
        + a * (0.5 * rate * rate / root + root * rate_dot)
        + 3.0 * b * rate * rate * rate_dot;
    (
        root * (k * overlap + a * rate) + b * rate * rate * rate,
        slope,
    )
}
