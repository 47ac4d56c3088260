//! Openings and closings of contacts within a step.

use super::dense::Piece;
use super::forces::Pass;
use super::state::{ContactMode, WaveState};
use crate::chain::Tension;
use crate::laws::Closed;
use crate::system::System;
use std::ops::Range;

/// What a contact is about to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Change {
    /// To another mode, as its overlap passes 0.
    Overlap(ContactMode),
    /// To another mode, as its force passes 0.
    Force(ContactMode),
    /// From loading to unloading, where a law remembers the largest overlap.
    Turn,
    /// Of a state's behaviour.
    State,
    /// Of a liquid bridge that ruptures.
    Rupture,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Event {
    pub contact: usize,
    /// Where in the step, 0 to 1.
    pub theta: f64,
    /// The step cannot be shortened to end at the change.
    pub at_start: bool,
    change: Change,
}

/// Looks for changes of mode at the end of a step.
#[derive(Clone, Debug)]
pub(super) struct ChangeDetector {
    tolerance: f64,
    time_s: f64,
    /// Velocity change in m/s that is within a step's error.
    slight_speed: f64,
    /// Overlap in m that counts as 0 when a step was made to end there.
    landing: f64,
    speed: f64,
    /// How many times its estimate the error of the next step may be: a shot begins with a contact that closes.
    pub onset: f64,
    /// Modes change with overlaps alone: no cut, no memory, no states.
    overlap_alone: bool,
    /// Time of the last change of each contact's mode and how many fell on it.
    last: Vec<(f64, u8)>,
}

/// A located change must be this far, in steps, from the step's start to be
/// worth a step of its own, and this far from its end to be worth another try.
const AT_START: f64 = 1e-9;
const AT_END: f64 = 1e-12;

/// Where before an opening, in parts of the step to it, a force that pulls is looked for.
const BEFORE_OPENING: f64 = 1e-3;

/// Error of a step over its estimate, where it begins with a force as √t: that of damping laws with √δ in a contact
/// that closes (11 for t^(3/2), 52 for t^(1/4)).
const ONSET: f64 = 37.0;

/// Shortest step in contact times that is made for the sake of a change.
const LEAST_STEP: f64 = 1e-12;

/// A state's behaviour has changed where its measure is this far below 0.
const LEAST_CHANGE: f64 = 1e-6;

/// Overlaps are differences of positions that are this uncertain.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

impl ChangeDetector {
    pub(super) fn new(system: &System, tolerance: f64) -> Self {
        let scales = system.scales();
        Self {
            tolerance,
            time_s: scales.time_s,
            slight_speed: 0.0,
            landing: 0.0,
            speed: scales.speed_m_s,
            onset: ONSET,
            overlap_alone: system.tension == Tension::Allowed
                && !system.has_memory
                && !system.has_states
                && system.bridged.is_empty(),
            last: vec![(-1.0, 0); system.contacts()],
        }
    }

    /// Measures changes against the speed at which contacts move now.
    pub(super) fn rescale(&mut self, speed_m_s: f64) {
        self.slight_speed = 0.01 * self.tolerance * speed_m_s;
        self.landing = 0.1 * self.tolerance * speed_m_s * self.time_s;
    }

    /// The change a contact has made by the end of a step, estimated from the
    /// force pass there.
    fn change(&self, system: &System, state: &WaveState, pass: &Pass, c: usize) -> Option<Change> {
        let overlap = pass.signed_overlap[c];
        let clipped = system.tension == Tension::Clipped;
        match state.mode[c] {
            ContactMode::Open if overlap > 0.0 => Some(Change::Overlap(ContactMode::Closed)),
            ContactMode::Open => {
                let torn = state.is_bridged(c) && system.is_beyond_bridge(c, overlap);
                torn.then_some(Change::Rupture)
            }
            _ if overlap < 0.0 => Some(Change::Overlap(ContactMode::Open)),
            ContactMode::Closed if clipped && pass.uncut(c) < 0.0 => {
                Some(Change::Force(ContactMode::Cut))
            }
            ContactMode::Cut if pass.uncut(c) > 0.0 => Some(Change::Force(ContactMode::Closed)),
            ContactMode::Closed if system.has_memory => {
                let loading = state.v[c] - state.v[c + 1] > 1e-9 * self.speed;
                (loading && pass.rate[c] < -1e-9 * self.speed).then_some(Change::Turn)
            }
            _ => None,
        }
    }

    /// Whether a change left unlocated could alter a velocity by more than
    /// the step's own error.
    fn matters(&self, system: &System, pass: &Pass, c: usize, step_s: f64, change: Change) -> bool {
        if system.has_states || !system.bridged.is_empty() {
            return true;
        }
        let depth = match change {
            Change::Overlap(_) => pass.signed_overlap[c].abs(),
            Change::Force(_) | Change::Turn | Change::State | Change::Rupture => {
                pass.signed_overlap[c].max(0.0)
            }
        };
        let closed =
            Closed { largest: pass.largest[c].max(depth), ..Closed::new(depth, pass.rate[c]) };
        let force = match change {
            Change::Force(_) => pass.uncut(c),
            _ => system.unclipped_force(c, closed),
        };
        let inverse_mass = system.inverse_mass[c].max(system.inverse_mass[c + 1]);
        force.abs() * step_s * inverse_mass > self.slight_speed
    }

    /// The first change in a step that must end the step, if any.
    pub(super) fn first(
        &self,
        piece: &Piece<'_>,
        pass: &Pass,
        contacts: Range<usize>,
    ) -> Option<Event> {
        if self.overlap_alone && !pass.disagrees(contacts.clone()) {
            return None;
        }
        let events = contacts.filter_map(|contact| self.event(piece, pass, contact));
        events.min_by(|a, b| a.theta.total_cmp(&b.theta))
    }

    /// The change of one contact in a step, unless it may stay where it is.
    fn event(&self, piece: &Piece<'_>, pass: &Pass, contact: usize) -> Option<Event> {
        let (system, state) = (piece.system, piece.state);
        let change = self.change(system, state, pass, contact);
        let change = change.or_else(|| self.change_of_state(piece, pass, contact))?;
        if let Some(cut) = self.cut_before(piece, contact, change) {
            return Some(cut);
        }
        let matters = self.matters(system, pass, contact, piece.step_s, change);
        if !matters || self.has_landed(system, state, pass, contact, change) {
            return None;
        }
        let theta = locate(piece, contact, change);
        let at_start = theta < AT_START.max(LEAST_STEP * self.time_s / piece.step_s);
        let only_located = matches!(change, Change::Turn | Change::State | Change::Rupture);
        let spent = only_located || self.changed_at(contact, state.time_s) >= 2;
        let stays = (at_start && spent) || theta > 1.0 - AT_END;
        (!stays).then_some(Event { contact, theta, at_start, change })
    }

    /// Where laws pull before a contact opens, the cut comes first, though at the end of the step
    /// only the opening is seen.
    fn cut_before(&self, piece: &Piece<'_>, contact: usize, change: Change) -> Option<Event> {
        let (system, mode) = (piece.system, piece.state.mode[contact]);
        let opens = change == Change::Overlap(ContactMode::Open) && mode == ContactMode::Closed;
        if !opens || system.tension != Tension::Clipped {
            return None;
        }
        let opening = (1.0 - BEFORE_OPENING) * locate(piece, contact, change);
        let pull = |theta: f64| -piece.closed_force(contact, theta);
        let theta = match pull(0.0) < 0.0 {
            true => bracketed_root(pull, 0.0, opening, 1e-13),
            false => 0.0,
        };
        let most_n = pull(opening).max(pull(0.5 * (theta + opening)));
        let lasts_s = (opening - theta) * piece.step_s;
        let inverse_mass = system.inverse_mass[contact].max(system.inverse_mass[contact + 1]);
        let matters = most_n * lasts_s * inverse_mass > self.slight_speed;
        let at_start = theta < AT_START.max(LEAST_STEP * self.time_s / piece.step_s);
        let change = Change::Force(ContactMode::Cut);
        matters.then_some(Event { contact, theta, at_start, change })
    }

    /// A change of a state's behaviour, unless the contact is almost at rest.
    fn change_of_state(&self, piece: &Piece<'_>, pass: &Pass, contact: usize) -> Option<Change> {
        let closed = match piece.state.mode[contact] {
            ContactMode::Closed => true,
            ContactMode::Open => piece.state.states.acts_across(contact),
            ContactMode::Cut => false,
        };
        let moves = piece.system.has_states && pass.rate[contact].abs() > 1e-9 * self.speed;
        let until = (closed && moves).then(|| piece.until_change(contact, 1.0))??;
        (until < -LEAST_CHANGE).then_some(Change::State)
    }

    fn changed_at(&self, contact: usize, time_s: f64) -> u8 {
        let (time, count) = self.last[contact];
        if time == time_s { count } else { 0 }
    }

    /// Whether the end of the step is at the change, as near as can be asked:
    /// to the landing distance or to the rounding of positions. How near a
    /// force or a rate can be brought to 0 is the step's error, which
    /// `matters` knows.
    fn has_landed(
        &self,
        system: &System,
        state: &WaveState,
        pass: &Pass,
        c: usize,
        change: Change,
    ) -> bool {
        let size = state.x[c].abs() + state.x[c + 1].abs() + system.offset_m[c].abs();
        let landing = self.landing.max(ROUNDING * size);
        matches!(change, Change::Overlap(_)) && pass.signed_overlap[c].abs() <= landing
    }

    /// Sets the modes at the end of an accepted step; `aimed` is the change
    /// that the step was made to end at. Returns whether any mode changed.
    pub(super) fn settle(
        &mut self,
        system: &System,
        state: &mut WaveState,
        pass: &Pass,
        contacts: Range<usize>,
        aimed: Option<Event>,
    ) -> bool {
        let mut changed = false;
        self.onset = 1.0;
        if self.overlap_alone && aimed.is_none() && !pass.disagrees(contacts.clone()) {
            return false;
        }
        for contact in contacts {
            let found = self.change(system, state, pass, contact);
            let aimed = aimed.filter(|event| event.contact == contact && found.is_none());
            let landed = aimed.map(|event| event.change).filter(|&change| match change {
                Change::Overlap(_) => self.has_landed(system, state, pass, contact, change),
                Change::Force(_) | Change::Rupture => true,
                Change::Turn | Change::State => false,
            });
            match found.or(landed) {
                Some(Change::Overlap(mode) | Change::Force(mode)) => {
                    self.set(state, contact, mode);
                    changed = true;
                }
                Some(Change::Rupture) => {
                    state.bridged[contact] = false;
                    changed = true;
                }
                Some(Change::Turn | Change::State) | None => {}
            }
        }
        changed
    }

    /// Makes a change that falls on the start of a step.
    pub(super) fn apply(&mut self, state: &mut WaveState, event: Event) {
        if let Change::Overlap(mode) | Change::Force(mode) = event.change {
            self.set(state, event.contact, mode);
        }
    }

    fn set(&mut self, state: &mut WaveState, contact: usize, mode: ContactMode) {
        let count = self.changed_at(contact, state.time_s) + 1;
        self.last[contact] = (state.time_s, count);
        if state.mode[contact] == ContactMode::Open {
            self.onset = ONSET;
        }
        state.set(contact, mode);
    }
}

/// Where in a step a change happens: bisection with secant steps on the
/// dense output, to the resolution at which the redone step decides anyway.
fn locate(piece: &Piece<'_>, contact: usize, change: Change) -> f64 {
    // Negative before the change, positive after it.
    let signed = |theta: f64| {
        let (overlap, rate) = piece.overlap(contact, theta);
        match change {
            Change::Overlap(ContactMode::Closed) => overlap,
            Change::Overlap(_) => -overlap,
            Change::Force(ContactMode::Closed) => piece.closed_force(contact, theta),
            Change::Force(_) => -piece.closed_force(contact, theta),
            Change::Turn => -rate,
            Change::Rupture => -overlap - piece.system.rupture_m(contact),
            Change::State => -piece.until_change(contact, theta).unwrap_or(0.0),
        }
    };
    if signed(0.0) >= 0.0 {
        return 0.0;
    }
    bracketed_root(signed, 0.0, 1.0, 1e-13)
}

/// A root of a function that is negative at `low` and not at `high`
/// (false position that halves the value at the end that stays, so that the other end moves, too).
pub(crate) fn bracketed_root(
    f: impl Fn(f64) -> f64,
    mut low: f64,
    mut high: f64,
    width: f64,
) -> f64 {
    let (mut f_low, mut f_high) = (f(low), f(high));
    for _ in 0..200 {
        if high - low <= width || f_high <= 0.0 {
            break;
        }
        let guess = (low * f_high - high * f_low) / (f_high - f_low);
        let inside = guess > low && guess < high;
        let middle = if inside { guess } else { 0.5 * (low + high) };
        let value = f(middle);
        if value < 0.0 {
            (low, f_low) = (middle, value);
            f_high *= 0.5;
        } else {
            (high, f_high) = (middle, value);
            f_low *= 0.5;
        }
    }
    high
}
