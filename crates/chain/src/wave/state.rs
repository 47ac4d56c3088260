//! Where a shot stands: positions, velocities, gates.

use super::contact_states::ContactStates;
use crate::system::System;

/// What a contact does while a step lasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ContactMode {
    /// The bodies do not touch.
    Open,
    /// They touch and the laws act.
    Closed,
    /// They touch, but the laws would pull and the cut forbids it.
    Cut,
}

#[derive(Clone, Debug)]
pub(crate) struct WaveState {
    pub time_s: f64,
    pub x: Vec<f64>,
    pub v: Vec<f64>,
    pub mode: Vec<ContactMode>,
    /// 1 where the laws' force acts, 0 elsewhere.
    pub passing: Vec<f64>,
    /// 1 where the bodies touch, 0 elsewhere.
    pub touching: Vec<f64>,
    /// Largest overlap so far; followed only if a law remembers it.
    pub largest: Vec<f64>,
    pub states: ContactStates,
    /// As in [`System`].
    pub bridged: Vec<bool>,
}

impl WaveState {
    /// The start of a shot. Contacts without a gap count as closed: their
    /// force is 0 until they are pressed.
    pub(super) fn start(system: &System, stages: usize) -> Self {
        let contacts = system.contacts();
        let mut state = Self {
            time_s: 0.0,
            x: system.displacement_m.clone(),
            v: system.velocity_m_s.clone(),
            mode: vec![ContactMode::Open; contacts],
            passing: vec![0.0; contacts],
            touching: vec![0.0; contacts],
            largest: vec![0.0; contacts],
            states: ContactStates::default(),
            bridged: system.bridged.clone(),
        };
        state.states = ContactStates::new(system, stages, |c| {
            (state.overlap(system, c), state.v[c] - state.v[c + 1])
        });
        for contact in 0..contacts {
            let overlap = state.overlap(system, contact);
            state.largest[contact] = overlap.max(system.offset_m[contact]).max(0.0);
            let leaving = overlap == 0.0 && state.v[contact] < state.v[contact + 1];
            if overlap >= 0.0 && !leaving {
                state.set(contact, ContactMode::Closed);
            }
        }
        state
    }

    /// Overlap δ of a contact in m, negative across a gap.
    pub(super) fn overlap(&self, system: &System, contact: usize) -> f64 {
        system.offset_m[contact] - (self.x[contact + 1] - self.x[contact])
    }

    pub(super) fn is_bridged(&self, contact: usize) -> bool {
        self.bridged.get(contact).is_some_and(|&bridged| bridged)
    }

    /// Whether a contact has parted farther than its bridge bears.
    pub(super) fn is_torn(&self, system: &System, contact: usize) -> bool {
        self.is_bridged(contact) && system.is_beyond_bridge(contact, self.overlap(system, contact))
    }

    /// Closes a contact where it overlaps, else opens it.
    pub(super) fn follow(&mut self, system: &System, contact: usize) {
        let mode = match self.overlap(system, contact) >= 0.0 {
            true => ContactMode::Closed,
            false => ContactMode::Open,
        };
        if self.mode[contact] != mode {
            self.set(contact, mode);
        }
        if self.is_torn(system, contact) {
            self.bridged[contact] = false;
        }
    }

    pub(super) fn set(&mut self, contact: usize, mode: ContactMode) {
        self.mode[contact] = mode;
        self.passing[contact] = f64::from(u8::from(mode == ContactMode::Closed));
        self.touching[contact] = f64::from(u8::from(mode != ContactMode::Open));
        if mode == ContactMode::Open {
            self.states.open(contact);
        } else if let Some(bridged) = self.bridged.get_mut(contact) {
            *bridged = true;
        }
    }
}
